#include "coordinator/record/channel_class_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/archive_lists.hpp"

namespace abut {

ChannelClassFilter::ChannelClassFilter(int channel_class) : step_(1.0e-3 / channel_class) {
  const double wd = 2.0 * std::numbers::pi * channel_class * 2.0775;  // [rad/s]
  const double wa = std::tan(0.5 * wd * step_);
  const double scale = 1.0 / (1.0 + std::numbers::sqrt2 * wa + wa * wa);
  a0_ = a2_ = wa * wa * scale;
  a1_ = 2.0 * a0_;
  b1_ = -2.0 * (wa * wa - 1.0) * scale;
  b2_ = (-1.0 + std::numbers::sqrt2 * wa - wa * wa) * scale;
}

void ChannelClassFilter::add(double from, double to, double force_from, double force_to) {
  if (!(to > from)) return;
  if (running_ && from > now_) fill(from, 0.0, 0.0);
  if (!running_) {
    if (force_from == 0.0 && force_to == 0.0) return;
    running_ = true;
    origin_ = now_ = from;
    samples_ = 0;
    silent_ = 0;
  }
  fill(to, force_from, force_to);
}

/// From now on to a time, unless the filter comes to rest before it.
void ChannelClassFilter::fill(double to, double force_from, double force_to) {
  const double slope = (force_to - force_from) / (to - now_);
  double force = force_from;
  while (now_ < to && running_) {
    const double sample_end = origin_ + static_cast<double>(samples_ + 1) * step_;
    const double until = std::clamp(sample_end, now_, to);
    const double later = force + slope * (until - now_);
    impulse_ += 0.5 * (force + later) * (until - now_);
    force = later;
    now_ = until;
    if (now_ < sample_end) continue;
    sample(impulse_ / step_);
    impulse_ = 0.0;
  }
}

void ChannelClassFilter::sample(double force) {
  ++samples_;
  silent_ = force == 0.0 ? silent_ + 1 : 0;
  const double y = a0_ * force + a1_ * x1_ + a2_ * x2_ + b1_ * y1_ + b2_ * y2_;
  x2_ = x1_;
  x1_ = force;
  y2_ = y1_;
  y1_ = y;
  forward_.push_back(y);
  if (silent_ >= memory) {
    run_backward(forward_.size());
    x1_ = x2_ = y1_ = y2_ = 0.0;
    running_ = false;
  } else if (forward_.size() >= 3 * memory) {
    run_backward(2 * memory);
  }
}

/// The first samples of those held, from what comes after them; then they are dropped.
void ChannelClassFilter::run_backward(std::size_t wanted) {
  double x1 = 0.0, x2 = 0.0, z1 = 0.0, z2 = 0.0;
  for (std::size_t i = forward_.size(); i-- > 0;) {
    const double z = a0_ * forward_[i] + a1_ * x1 + a2_ * x2 + b1_ * z1 + b2_ * z2;
    x2 = x1;
    x1 = forward_[i];
    z2 = z1;
    z1 = z;
    if (i < wanted) peak_ = std::max(peak_, z);
  }
  forward_.erase(forward_.begin(), forward_.begin() + static_cast<std::ptrdiff_t>(wanted));
}

double ChannelClassFilter::peak() {
  if (running_) sample(impulse_ / step_);  // the one that has begun
  impulse_ = 0.0;
  while (running_) sample(0.0);
  return peak_;
}

void ChannelClassFilter::state(Archive& archive) {
  archive.field("running", running_);
  archive.field("samples", samples_);
  whole(archive, "silent", silent_);
  for (double* value : {&origin_, &now_, &impulse_, &x1_, &x2_, &y1_, &y2_, &peak_})
    archive.field("value", *value);
  archive.field("forward", forward_);
}

}  // namespace abut
