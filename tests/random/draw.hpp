#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace abut {

/// Random numbers that are the same with every compiler and standard library: SplitMix64 (Steele,
/// Lea, Flood 2014).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15U + 0x5851f42d4c957f2dU) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  double uniform(double low, double high) {
    constexpr double unit = 1.0 / 9007199254740992.0;  // 2^-53: as many values as doubles in [0, 1)
    return low + (high - low) * static_cast<double>(bits() >> 11U) * unit;
  }
  /// Equally likely in every decade.
  double decades(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int whole(int low, int high) {  // both included
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  template <class T>
  const T& of(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(whole(0, static_cast<int>(all.size()) - 1))];
  }

 private:
  std::uint64_t state_;
};

}  // namespace abut
