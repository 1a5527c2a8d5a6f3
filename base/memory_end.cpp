#include "base/memory_end.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

namespace abut {

namespace {

const char* told_by = "";
std::terminate_handler otherwise = nullptr;

[[noreturn]] void end() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: the memory is used up\n", told_by);
    std::_Exit(3);
  } catch (...) {
  }
  otherwise();
  std::abort();
}

}  // namespace

void end_in_words_without_memory(const char* program) {
  told_by = program;
  otherwise = std::set_terminate(end);
}

}  // namespace abut
