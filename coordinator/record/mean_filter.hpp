#pragma once

#include <cstddef>
#include <deque>

#include "coordinator/record/force_filter.hpp"

namespace abut {

/// Largest mean of a force over a fixed time: the integral over the time before each instant,
/// exact between the instants as well. Stretches shorter than a 65536th of that time are gathered
/// into one of their mean force, so that memory is bounded.
class MeanFilter : public ForceFilter {
 public:
  /// `time` [s], above 0.
  explicit MeanFilter(double time) : time_(time) {}

  void add(double from, double to, double force_from, double force_to) override;
  double peak() override;
  void state(Archive& archive) override;
  /// Stretches held now.
  std::size_t held() const { return held_.size(); }

 private:
  static constexpr double most_stretches = 65536.0;

  struct Stretch {
    double from = 0.0, to = 0.0;              // [s]
    double force_from = 0.0, force_to = 0.0;  // [N]

    double slope() const { return to > from ? (force_to - force_from) / (to - from) : 0.0; }
    double at(double time) const { return force_from + slope() * (time - from); }
    double impulse(double begin, double end) const {
      return 0.5 * (at(begin) + at(end)) * (end - begin);
    }
  };

  struct Gathered {
    double from = 0.0, to = 0.0;  // [s]
    double impulse = 0.0;         // [N s]
  };

  void gather(const Stretch& stretch);
  void flush();
  void follow(const Stretch& stretch);
  void sum_anew(double now);

  double time_;
  std::deque<Stretch> held_;  // of the last `time_`, without gaps
  Gathered gathered_;         // after them, until it is long enough
  double impulse_ = 0.0;      // [N s] over the last `time_`
  std::size_t since_sum_ = 0;
  double largest_ = 0.0;  // [N s]
};

}  // namespace abut
