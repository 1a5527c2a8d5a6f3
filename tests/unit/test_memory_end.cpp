// Goal: a program whose memory is used up where no exception may leave says so; any other end of
// this kind is what it was, an abort.
#include "base/memory_end.hpp"

#include <csignal>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

namespace {

template <class Error>
void raise() {
  throw Error();
}

template <class Error>
void throw_where_none_may_leave() noexcept {
  raise<Error>();
}

struct Other : std::runtime_error {
  Other() : std::runtime_error("other") {}
};

TEST(MemoryEnd, EndsInWordsWithTheCodeOfTheWorld) {
  EXPECT_EXIT(
      {
        abut::end_in_words_without_memory("name");
        throw_where_none_may_leave<std::bad_alloc>();
      },
      testing::ExitedWithCode(3), "^name: the memory is used up\n");
}

TEST(MemoryEnd, LetsOtherErrorsAbort) {
  EXPECT_EXIT(
      {
        abut::end_in_words_without_memory("name");
        throw_where_none_may_leave<Other>();
      },
      testing::KilledBySignal(SIGABRT), "");
}

}  // namespace
