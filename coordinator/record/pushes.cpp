#include "coordinator/record/pushes.hpp"

#include <algorithm>

namespace abut {

namespace {
/// Of the largest force so far: less is what iterations leave open.
constexpr double force_share = 1.0e-6;
/// Of the largest impulse. Bars in rows that come to rest beside each other touch with up to 7e-3
/// of it, by vibration of their ends.
constexpr double impulse_share = 1.0e-2;
}  // namespace

void Pushes::add(double from, double to, double before, double now) {
  peak_ = std::max({peak_, before, now});
  const double floor = force_share * peak_;
  if (before <= floor && now <= floor) return;
  if (impulses_.empty() || from - last_ > together_) impulses_.push_back(0.0);
  impulses_.back() += 0.5 * (std::max(0.0, before) + std::max(0.0, now)) * (to - from);
  last_ = to;
}

int Pushes::count() const {
  if (impulses_.empty()) return 0;
  const double least = impulse_share * *std::max_element(impulses_.begin(), impulses_.end());
  return static_cast<int>(std::count_if(impulses_.begin(), impulses_.end(),
                                        [least](double each) { return each >= least; }));
}

}  // namespace abut
