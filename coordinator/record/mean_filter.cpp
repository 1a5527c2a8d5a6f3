#include "coordinator/record/mean_filter.hpp"

#include <algorithm>

#include "base/archive_lists.hpp"

namespace abut {

void MeanFilter::add(double from, double to, double force_from, double force_to) {
  if (!(to > from)) return;
  if (held_.empty()) {
    held_.push_back({from - time_, from, 0.0, 0.0});
    gathered_.from = gathered_.to = from;
  } else if (from > gathered_.to) {
    gather({gathered_.to, from, 0.0, 0.0});
  }
  gather({from, to, force_from, force_to});
}

void MeanFilter::gather(const Stretch& stretch) {
  const double enough = time_ / most_stretches;
  if (stretch.to - stretch.from >= enough) {
    flush();
    follow(stretch);
    gathered_ = {stretch.to, stretch.to, 0.0};
    return;
  }
  gathered_.impulse += stretch.impulse(stretch.from, stretch.to);
  gathered_.to = stretch.to;
  if (gathered_.to - gathered_.from >= enough) flush();
}

void MeanFilter::flush() {
  if (gathered_.to <= gathered_.from) return;
  const double mean = gathered_.impulse / (gathered_.to - gathered_.from);
  follow({gathered_.from, gathered_.to, mean, mean});
  gathered_ = {gathered_.to, gathered_.to, 0.0};
}

/// Moves the instant through a stretch, whose force enters the mean while that of `time_` ago
/// leaves it.
void MeanFilter::follow(const Stretch& stretch) {
  held_.push_back(stretch);
  double now = stretch.from;
  while (now < stretch.to) {
    const Stretch& leaving = held_.front();
    const double next = std::min(stretch.to, leaving.to + time_);
    if (next > now) {
      const double excess = stretch.at(now) - leaving.at(now - time_);
      const double bend = stretch.slope() - leaving.slope();
      if (excess > 0.0 && excess + bend * (next - now) < 0.0)  // largest in between
        largest_ = std::max(largest_, impulse_ - 0.5 * excess * excess / bend);
      impulse_ += (excess + 0.5 * bend * (next - now)) * (next - now);
      largest_ = std::max(largest_, impulse_);
      now = next;
    }
    if (now < leaving.to + time_) continue;
    held_.pop_front();
    if (++since_sum_ > held_.size()) sum_anew(now);
  }
}

/// Sums and differences of many substeps would leave their round-off behind.
void MeanFilter::sum_anew(double now) {
  since_sum_ = 0;
  impulse_ = 0.0;
  for (const Stretch& s : held_)
    impulse_ += s.impulse(std::max(s.from, now - time_), std::min(s.to, now));
}

double MeanFilter::peak() {
  flush();
  return largest_ / time_;
}

void MeanFilter::state(Archive& archive) {
  list(archive, "held", held_, [](Archive& a, Stretch& stretch) {
    a.field("from", stretch.from);
    a.field("to", stretch.to);
    a.field("force_from", stretch.force_from);
    a.field("force_to", stretch.force_to);
  });
  archive.field("from", gathered_.from);
  archive.field("to", gathered_.to);
  archive.field("gathered", gathered_.impulse);
  archive.field("impulse", impulse_);
  whole(archive, "since_sum", since_sum_);
  archive.field("largest", largest_);
}

}  // namespace abut
