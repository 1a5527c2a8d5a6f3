#include "coordinator/record/pushes.hpp"

#include <algorithm>

#include "base/archive_lists.hpp"

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
  // A force that sets in, or ends, does so somewhere within the part.
  const double middle = 0.5 * (from + to), begin = before > floor ? from : middle;
  if (pushes_.empty() || begin > pushes_.back().end) pushes_.push_back({begin, begin, 0.0});
  pushes_.back().impulse += 0.5 * (std::max(0.0, before) + std::max(0.0, now)) * (to - from);
  pushes_.back().end = now > floor ? to : middle;
}

std::vector<Pushes::Push> Pushes::contacts(double negligible) const {
  std::vector<Push> all;
  double force = 0.0;  // [N] of the push before
  for (const Push& push : pushes_) {
    const double apart = all.empty() ? 0.0 : push.begin - all.back().end;
    const double missing = apart * std::min(force, push.force());
    force = push.force();
    if (!all.empty() && (apart < together_ || (apart < 2.0 * together_ && missing < negligible))) {
      all.back().end = push.end;
      all.back().impulse += push.impulse;
    } else {
      all.push_back(push);
    }
  }
  return all;
}

int Pushes::count() const {
  const auto least_of = [](const std::vector<Push>& pushes) {
    double most = 0.0;
    for (const Push& push : pushes) most = std::max(most, push.impulse);
    return impulse_share * most;
  };
  const std::vector<Push> all = contacts(least_of(contacts(0.0)));
  const double least = least_of(all);
  return static_cast<int>(
      std::count_if(all.begin(), all.end(), [least](const Push& c) { return c.impulse >= least; }));
}

void Pushes::state(Archive& archive) {
  archive.field("peak", peak_);
  list(archive, "pushes", pushes_, [](Archive& a, Push& push) {
    a.field("begin", push.begin);
    a.field("end", push.end);
    a.field("impulse", push.impulse);
  });
}

}  // namespace abut
