// Goal: what is written comes back exactly, and a stale archive says which field changed.
// Oracle: identity of values; the field's name in the message.
#include <gtest/gtest.h>
#include <xxhash.h>
#ifdef __x86_64__
#include <cpuid.h>
#endif

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/error.hpp"

namespace abut::test_archive {
namespace {

struct State {
  double time = 0.0;
  std::int64_t window = 0;
  bool closed = false;
  std::vector<double> q;
  void state(Archive& archive) {
    archive.field("time", time);
    archive.field("window", window);
    archive.field("closed", closed);
    archive.field("q", q);
  }
};

struct Renamed : State {
  void state(Archive& archive) {
    archive.field("time", time);
    archive.field("step", window);
  }
};

struct Retyped : State {
  void state(Archive& archive) { archive.field("time", window); }
};

State sample() {
  return {-0.0,
          -(std::int64_t{1} << 62),
          true,
          {1.0 / 3.0, std::numeric_limits<double>::denorm_min(), -1.0e300}};
}

template <class T>
std::vector<std::byte> written(T state, Archive::Form form) {
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, form);
  state.state(archive);
  return bytes;
}

template <class T>
T read_back(const std::vector<std::byte>& bytes, Archive::Form form) {
  T state;
  Archive archive = Archive::reader(bytes, form);
  state.state(archive);
  archive.finish();
  return state;
}

template <class T>
std::string refusal(const std::vector<std::byte>& bytes, Archive::Form form) {
  try {
    read_back<T>(bytes, form);
  } catch (const RunError& error) {
    return error.what_is_wrong;
  }
  return "accepted";
}

class ArchiveForms : public testing::TestWithParam<Archive::Form> {};

TEST_P(ArchiveForms, RoundTripIsExact) {
  const State before = sample();
  const State after = read_back<State>(written(before, GetParam()), GetParam());
  EXPECT_TRUE(std::signbit(after.time));
  EXPECT_EQ(after.window, before.window);
  EXPECT_EQ(after.closed, before.closed);
  EXPECT_EQ(after.q, before.q);
}

TEST_P(ArchiveForms, EveryCutIsRefused) {
  const std::vector<std::byte> whole = written(sample(), GetParam());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<long>(size));
    EXPECT_NE(refusal<State>(cut, GetParam()), "accepted") << size << " bytes";
  }
}

TEST_P(ArchiveForms, BytesAfterTheLastFieldAreRefused) {
  std::vector<std::byte> bytes = written(sample(), GetParam());
  bytes.push_back(std::byte{0});
  EXPECT_EQ(refusal<State>(bytes, GetParam()), "has 1 bytes after the last field");
}

INSTANTIATE_TEST_SUITE_P(Both, ArchiveForms,
                         testing::Values(Archive::Form::bare, Archive::Form::named));

TEST(Archive, NamedFormSaysWhichFieldWasRenamed) {
  EXPECT_EQ(refusal<Renamed>(written(sample(), Archive::Form::named), Archive::Form::named),
            "step is expected, but the archive holds window");
}

TEST(Archive, NamedFormSaysWhichFieldChangedItsType) {
  EXPECT_EQ(refusal<Retyped>(written(sample(), Archive::Form::named), Archive::Form::named),
            "time is expected to be of type integer, but the archive holds number");
}

TEST(Archive, BareFormHoldsTheNumbersAndTheLengthsOfLists) {
  EXPECT_EQ(written(sample(), Archive::Form::bare).size(), 8u + 8u + 1u + 8u + 3u * 8u);
}

TEST(Archive, HashTellsStatesApartByOneBit) {
  State a = sample(), b = sample();
  EXPECT_EQ(hash_state(a), hash_state(b));
  b.time = 0.0;
  EXPECT_NE(hash_state(a), hash_state(b)) << "-0.0 and 0.0 are different states";
}

TEST(Archive, HashOfNothingIsThePublishedOne) {
  // XXH3, 64 bits, no input, seed 0: a constant of the published algorithm.
  EXPECT_EQ(hash_bytes({}), 0x2d06800538d394c2ull);
}

TEST(Archive, HashIsThePublishedOneForAnyLength) {
  // Identity: archives use the machine's vector registers, the library's own call does not.
  std::vector<std::byte> bytes;
  for (int i = 0; i < 5000; ++i) bytes.push_back(static_cast<std::byte>(i * 37 + i / 256));
  for (std::size_t size = 0; size <= bytes.size(); size += size < 300 ? 1 : 97) {
    EXPECT_EQ(hash_bytes({bytes.data(), size}), XXH3_64bits(bytes.data(), size)) << size;
  }
}

#ifdef __x86_64__
/// Whether upper halves of vector registers are in use, told by the processor; absent where it
/// does not tell (Intel's manual, XGETBV with ECX = 1: bit 2 of XINUSE).
std::optional<bool> upper_halves_in_use() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (!__get_cpuid_count(0xd, 1, &a, &b, &c, &d) || (a & 4u) == 0) return std::nullopt;
  asm volatile("xgetbv" : "=a"(a), "=d"(d) : "c"(1));
  return (a & 4u) != 0;
}

TEST(Archive, HashLeavesNoUpperHalvesInUse) {
  // They would slow down all that follows, libm threefold: a matter of speed that no bit shows.
  if (!upper_halves_in_use()) GTEST_SKIP() << "this processor does not tell";
  const std::vector<std::byte> bytes(5000, std::byte{1});
  for (const std::size_t size : {8, 300, 5000}) {
    EXPECT_NE(hash_bytes({bytes.data(), size}), 0u);
    EXPECT_FALSE(*upper_halves_in_use()) << size;
  }
}
#endif

TEST(Archive, CombinedHashDependsOnTheOrder) {
  EXPECT_NE(hash_combine(hash_combine(0, 1), 2), hash_combine(hash_combine(0, 2), 1));
}

}  // namespace
}  // namespace abut::test_archive
