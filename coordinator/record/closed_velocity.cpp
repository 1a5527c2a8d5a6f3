#include "coordinator/record/closed_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/archive_lists.hpp"

namespace abut {

void ClosedVelocity::change(bool closes, double time) { changes_.push_back({closes, time}); }

void ClosedVelocity::on_window(const std::array<PortReader, 2>& readers,
                               const std::array<const Waveform*, 2>& traces, int kinematic,
                               bool known, ContactErrors* errors) {
  read(pending_.known ? pending_.kinematic : kinematic, errors);
  pending_.kinematic = kinematic;
  pending_.known = known;
  for (const std::size_t s : {0u, 1u}) {
    const Waveform& trace = *traces[s];
    Window::Side& side = pending_.sides[s];
    side.time.clear();
    side.velocity.clear();
    if (trace.v.empty()) continue;
    side.time = trace.time;
    for (std::size_t i = 0; i < trace.size(); ++i)
      side.velocity.push_back(readers[s].along_x(trace, trace.v, i));
  }
}

void ClosedVelocity::read(int kinematic, ContactErrors* errors) {
  const std::size_t count = pending_.sides[kinematic].time.size();
  for (std::size_t i = 1; i < count; ++i) add(kinematic, i, errors);
}

/// The substep that ends at time i, in the parts that events make of it.
void ClosedVelocity::add(int side, std::size_t i, ContactErrors* errors) {
  const Window::Side& s = pending_.sides[side];
  const double begin = s.time[i - 1], end = s.time[i];
  const double slope = (s.velocity[i] - s.velocity[i - 1]) / (end - begin);
  double from = begin;
  while (from < end) {
    while (!changes_.empty() && changes_.front().time <= from) turn();
    const double to = changes_.empty() ? end : std::min(end, changes_.front().time);
    const double v_from = s.velocity[i - 1] + slope * (from - begin);
    const double v_to = s.velocity[i - 1] + slope * (to - begin);
    if (times_.is_open()) {
      pause_.add(from, to, v_from, v_to);
    } else {
      closed_.add(from, to, v_from, v_to);
      if (errors != nullptr) errors->add_velocity(side, from, to, v_from, v_to);
    }
    from = to;
  }
}

void ClosedVelocity::turn() {
  const Change change = changes_.front();
  changes_.pop_front();
  if (change.closes) {
    if (times_.is_open() && times_.goes_on(change.time)) closed_.take(pause_);
    times_.close(change.time);
  } else {
    times_.open(change.time);
  }
  pause_ = SquareIntegral();
}

double ClosedVelocity::rms() const {
  if (closed_.covered() <= 0.0) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(closed_.sum() / closed_.covered());
}

void ClosedVelocity::state(Archive& archive) {
  times_.state(archive);
  list(archive, "changes", changes_, [](Archive& a, Change& change) {
    a.field("closes", change.closes);
    a.field("time", change.time);
  });
  for (Window::Side& side : pending_.sides) {
    archive.field("time", side.time);
    archive.field("velocity", side.velocity);
  }
  whole(archive, "kinematic", pending_.kinematic);
  archive.field("known", pending_.known);
  closed_.state(archive);
  pause_.state(archive);
}

}  // namespace abut
