#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace abut {

/// Wall time for which the bodies of a run are waited for. While several compute, they share the
/// time by what each of them takes; all other time is the coupling's. Decides nothing.
class BodyMeter {
 public:
  explicit BodyMeter(std::size_t bodies)
      : waited_(bodies, 0.0), computed_(bodies, 0.0), calls_(bodies, 0) {}

  void start();
  /// `computed` [s]: as the body tells it; no call of start() may be left without this.
  void finish(std::size_t body, double computed);

  /// A request of which nobody tells what it takes.
  void count(std::size_t body) { ++calls_[body]; }

  const std::vector<double>& waited_seconds() const { return waited_; }  // by body
  const std::vector<std::int64_t>& calls() const { return calls_; }      // by body

 private:
  std::size_t under_way_ = 0;
  std::chrono::steady_clock::time_point began_;
  std::vector<double> waited_, computed_;  // [s] by body; the latter of those that are under way
  std::vector<std::int64_t> calls_;
};

}  // namespace abut
