#include "coordinator/exact/bar_row.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

// Times, lengths and velocities that agree to this part of their scale are equal: they come from a
// few operations on given numbers, along different paths.
constexpr double rounding = 1e-12;
constexpr double never = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const std::string& why) {
  throw InputError(fmt::format("there is no exact solution for these bars in a row: {}", why),
                   "meta.closed_form",
                   "Leave out meta.closed_form (and expectations that need it), or change the "
                   "bodies.");
}

}  // namespace

// ---- RowContact ----------------------------------------

int RowContact::count() const {
  int count = 0;
  for (std::size_t s = 0; s < stretches.size(); ++s)
    if (s == 0 || stretches[s].begin > stretches[s - 1].end) ++count;
  return count;
}

double RowContact::force_peak() const {
  double peak = 0.0;
  for (const Stretch& stretch : stretches) peak = std::max(peak, stretch.force);
  return peak;
}

double RowContact::impulse() const {
  double sum = 0.0;
  for (const Stretch& stretch : stretches) sum += stretch.force * (stretch.end - stretch.begin);
  return sum;
}

double RowContact::force_mean() const {
  double time = 0.0;
  for (const Stretch& stretch : stretches) time += stretch.end - stretch.begin;
  return impulse() / time;
}

double RowContact::force_at(double time) const {
  const std::vector<Stretch>::const_iterator s =
      std::upper_bound(stretches.begin(), stretches.end(), time,
                       [](double t, const Stretch& stretch) { return t < stretch.end; });
  return s != stretches.end() && time >= s->begin ? s->force : 0.0;
}

// ---- From event to event ----------------------------------------

class BarRow::Events {
 public:
  explicit Events(BarRow& row);
  void run();

 private:
  struct Arrival {
    double time, value;
  };
  struct End {
    std::deque<Arrival> coming;  // jumps under way to this end
    double incoming = 0.0;       // [m/s] the invariant that arrives now
    bool joined = false;         // has an interface
  };
  struct Joint {
    double gap = 0.0, rate = 0.0;  // [m] [m/s] since the last event
    bool pressed = false;
  };

  End& end(const BarEnd& e) { return ends_[2 * e.bar + e.side]; }
  double free_velocity(const BarEnd& e);  // [m/s] of an end without force
  double next_event(double time) const;
  void arrive(double time);
  void move_gaps(double span);
  void meet(std::size_t i, double time);
  void record(std::size_t i, double time, double force, double velocity);
  void leave(const BarEnd& e, double time, double velocity);

  BarRow& row_;
  std::vector<End> ends_;      // two per bar
  std::vector<Joint> joints_;  // as the row's interfaces
  std::vector<double> scale_;  // [m/s] (bars) largest invariant so far
  double speed_ = 0.0;         // [m/s] velocities below `rounding` of it are none
  double slack_ = 0.0;         // [s] events as near as this are one
};

BarRow::Events::Events(BarRow& row) : row_(row), ends_(2 * row.bars_.size()) {
  double shortest = never;
  for (std::size_t b = 0; b < row.bars_.size(); ++b) {
    const Bar& bar = row.bars_[b];
    for (std::size_t side : {0u, 1u}) ends_[2 * b + side].incoming = 0.5 * bar.data.velocity;
    scale_.push_back(0.5 * std::abs(bar.data.velocity));
    if (bar.data.wall) continue;
    speed_ = std::max(speed_, std::abs(bar.data.velocity));
    shortest = std::min(shortest, bar.transit);
  }
  const double latest = std::max(std::abs(row.begin_), std::abs(row.end_));
  slack_ = rounding * shortest + 16.0 * std::numeric_limits<double>::epsilon() * latest;
  for (const RowContact& contact : row.contacts_) {
    joints_.push_back({contact.initial_gap, 0.0, false});
    for (const BarEnd& e : contact.ends) end(e).joined = true;
  }
}

double BarRow::Events::free_velocity(const BarEnd& e) {
  return row_.at(e.bar).data.wall ? 0.0 : 2.0 * end(e).incoming;
}

double BarRow::Events::next_event(double time) const {
  double next = never;
  for (const End& end : ends_)
    if (!end.coming.empty()) next = std::min(next, end.coming.front().time);
  for (const Joint& joint : joints_)
    if (joint.rate < 0.0) next = std::min(next, time - joint.gap / joint.rate);
  return next;
}

void BarRow::Events::arrive(double time) {
  for (End& end : ends_) {
    for (; !end.coming.empty() && end.coming.front().time <= time + slack_; end.coming.pop_front())
      end.incoming = end.coming.front().value;
  }
}

void BarRow::Events::move_gaps(double span) {
  for (Joint& joint : joints_) {
    joint.gap += joint.rate * span;
    if (joint.gap <= speed_ * slack_) joint.gap = 0.0;
  }
}

/// The end moves at `velocity` from now on: what it sends out follows from [M.17].
void BarRow::Events::leave(const BarEnd& e, double time, double velocity) {
  Bar& bar = row_.at(e.bar);
  if (bar.data.wall) return;
  const std::size_t side = index(e.side);
  const double value = velocity - end(e).incoming;
  double& scale = scale_[e.bar];
  scale = std::max(scale, std::abs(value));
  if (velocity != bar.velocity[side].last()) bar.velocity[side].jump(time, velocity);
  // Jumps of round-off size would multiply at every reflection.
  if (std::abs(value - bar.outgoing[side].last()) <= rounding * 0.1 * scale) return;
  bar.outgoing[side].jump(time, value);
  end({e.bar, 1 - e.side}).coming.push_back({time + bar.transit, value});
}

/// What two ends do to each other [M.18]: pressed, touching without force, or apart.
void BarRow::Events::meet(std::size_t i, double time) {
  const RowContact& contact = row_.contacts_[i];
  Joint& joint = joints_[i];
  const bool first_is_left = contact.ends[0].side == 1;
  const BarEnd& left = contact.ends[first_is_left ? 0 : 1];  // the body on the left
  const BarEnd& right = contact.ends[first_is_left ? 1 : 0];
  const double from = free_velocity(left), to = free_velocity(right);
  const double closing = from - to;
  const bool still = std::abs(closing) <= rounding * speed_;
  if (joint.gap == 0.0 && closing > 0.0 && !still) {
    const double give_left = row_.mobility(left), give_right = row_.mobility(right);
    const double force = closing / (give_left + give_right);
    // From the stiffer end, so that a wall stays and nothing cancels.
    const double velocity =
        give_left <= give_right ? from - give_left * force : to + give_right * force;
    joint.rate = 0.0;
    record(i, time, force, velocity);
    leave(left, time, velocity);
    leave(right, time, velocity);
    return;
  }
  joint.rate = still ? 0.0 : -closing;
  record(i, time, 0.0, 0.0);
  leave(left, time, from);
  leave(right, time, to);
}

void BarRow::Events::record(std::size_t i, double time, double force, double velocity) {
  std::vector<RowContact::Stretch>& stretches = row_.contacts_[i].stretches;
  Joint& joint = joints_[i];
  if (joint.pressed) {
    RowContact::Stretch& last = stretches.back();
    const bool same = std::abs(force - last.force) <= rounding * last.force &&
                      std::abs(velocity - last.velocity) <= rounding * speed_;
    if (same) return;
    last.end = time;
  }
  joint.pressed = force > 0.0;
  if (joint.pressed) stretches.push_back({time, never, force, velocity});
}

void BarRow::Events::run() {
  double time = row_.begin_;
  for (int event = 0;; ++event) {
    if (event == max_events)
      refuse(fmt::format("it has more than {} wave arrivals until {:.6g} s of {:.6g} s", max_events,
                         time, row_.end_));
    arrive(time);
    for (std::size_t i = 0; i < joints_.size(); ++i) meet(i, time);
    for (int b = 0; b < row_.bars(); ++b) {
      for (const int side : {0, 1}) {
        if (end({b, side}).joined) continue;
        const bool fixed = row_.at(b).data.fixed[side];
        leave({b, side}, time, fixed ? 0.0 : free_velocity({b, side}));
      }
    }
    const double next = next_event(time);
    if (next > row_.end_) break;
    move_gaps(next - time);
    time = next;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!joints_[i].pressed) continue;
    row_.contacts_[i].stretches.back().end = row_.end_;
    row_.contacts_[i].pressed_at_end = true;
  }
}

// ---- BarRow ----------------------------------------

BarRow::Bar BarRow::make_bar(RowBar data, double begin) {
  Bar bar;
  if (data.wall) data.velocity = 0.0;
  if (!data.wall) {
    const bool positive =
        data.youngs_modulus > 0.0 && data.density > 0.0 && data.area > 0.0 && data.length > 0.0;
    if (!positive) refuse(fmt::format("{} has a property that is not positive", data.name));
    if (data.body_force != 0.0) refuse(fmt::format("a body force acts on {}", data.name));
    bar.speed = std::sqrt(data.youngs_modulus / data.density);
    bar.impedance = std::sqrt(data.youngs_modulus * data.density) * data.area;
    bar.transit = data.length / bar.speed;
    if (!std::isfinite(bar.transit) || !std::isfinite(bar.impedance) || !(bar.transit > 0.0))
      refuse(fmt::format("waves take {:g} s through {}, beyond the range of numbers", bar.transit,
                         data.name));
  }
  bar.outgoing.assign(2, StepFunction(begin, 0.5 * data.velocity));
  bar.velocity.assign(2, StepFunction(begin, data.velocity));
  bar.data = std::move(data);
  return bar;
}

BarRow::BarRow(std::vector<RowBar> bars, const std::vector<std::array<BarEnd, 2>>& interfaces,
               double begin, double end)
    : begin_(begin), end_(end) {
  for (RowBar& data : bars) bars_.push_back(make_bar(std::move(data), begin));
  for (const std::array<BarEnd, 2>& ends : interfaces) add_interface(ends);
  Events(*this).run();
}

void BarRow::add_interface(const std::array<BarEnd, 2>& ends) {
  const RowBar& first = bar(ends[0].bar);
  const RowBar& second = bar(ends[1].bar);
  if (first.wall && second.wall)
    refuse(fmt::format("both sides are walls ({} and {})", first.name, second.name));
  if (ends[0].side == ends[1].side)
    refuse(fmt::format("the ports of {} and {} do not face each other", first.name, second.name));
  double gap = 0.0, scale = 0.0;
  for (const BarEnd& e : ends) {
    const RowBar& data = bar(e.bar);
    if (!data.wall && data.fixed[e.side])
      refuse(fmt::format("the end of {} that meets another body is fixed", data.name));
    gap -= e.normal() * (data.position + (e.side == 1 && !data.wall ? data.length : 0.0));
    scale = std::max({scale, std::abs(data.position), data.length});
  }
  if (!(gap >= -rounding * scale))
    refuse(
        fmt::format("{} and {} overlap at the begin (gap {:g} m)", first.name, second.name, gap));
  contacts_.push_back({ends, gap > rounding * scale ? gap : 0.0, {}, false});
}

double BarRow::velocity_spread() const {
  double least = never, most = -never;
  for (const Bar& bar : bars_) {
    least = std::min(least, bar.data.velocity);
    most = std::max(most, bar.data.velocity);
  }
  return most - least;
}

double BarRow::mass(int bar) const {
  const RowBar& data = at(bar).data;
  return data.wall ? never : data.density * data.area * data.length;
}

double BarRow::impedance(int bar) const { return at(bar).data.wall ? never : at(bar).impedance; }

double BarRow::mobility(const BarEnd& end) const { return 1.0 / impedance(end.bar); }

/// The bar at one time, left to right: what each end has sent out within one transit [M.17].
std::vector<BarRow::Piece> BarRow::pieces(const Bar& bar, double time) const {
  const double length = bar.data.length, c = bar.speed;
  std::vector<double> cuts;
  bar.outgoing[0].jumps_between(time - bar.transit, time, cuts);
  const std::size_t rightward = cuts.size();
  bar.outgoing[1].jumps_between(time - bar.transit, time, cuts);
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const double path = std::clamp(c * (time - cuts[i]), 0.0, length);
    cuts[i] = i < rightward ? path : length - path;
  }
  cuts.insert(cuts.end(), {0.0, length});
  std::sort(cuts.begin(), cuts.end());
  std::vector<Piece> pieces;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double middle = 0.5 * (cuts[i - 1] + cuts[i]);
    pieces.push_back({cuts[i] - cuts[i - 1], bar.outgoing[0].at(time - middle / c),
                      bar.outgoing[1].at(time - (length - middle) / c)});
  }
  return pieces;
}

BarRow::State BarRow::state(int bar, double time) const {
  const Bar& b = at(bar);
  if (b.data.wall) return {};
  double momentum = 0.0, kinetic = 0.0, stored = 0.0;
  for (const Piece& p : pieces(b, time)) {
    const double sum = p.rightward + p.leftward, difference = p.rightward - p.leftward;
    momentum += p.length * sum;
    kinetic += p.length * sum * sum;
    stored += p.length * difference * difference;
  }
  const double line = b.data.density * b.data.area;  // [kg/m]
  return {line * momentum, 0.5 * line * kinetic, 0.5 * line * stored};
}

double BarRow::mean_velocity(int bar, double time) const {
  return state(bar, time).momentum / mass(bar);
}

/// Energy enters and leaves through interfaces only, at the constant power F v of a stretch: it is
/// summed from change to change. A bar may hold as many waves as there are stretches, and to count
/// them at each would take the square of their number.
double BarRow::total_peak(int bar) const {
  std::vector<std::pair<double, double>> changes;  // [s] and by how much the power changes there
  for (const RowContact& contact : contacts_) {
    for (const BarEnd& e : contact.ends) {
      if (e.bar != bar) continue;
      for (const RowContact::Stretch& s : contact.stretches) {
        const double power = -e.normal() * s.force * s.velocity;
        changes.emplace_back(s.begin, power);
        changes.emplace_back(s.end, -power);
      }
    }
  }
  std::sort(changes.begin(), changes.end());
  double energy = total(bar, begin_), peak = std::max(energy, total(bar, end_));
  double power = 0.0, last = begin_;
  for (const auto& [time, change] : changes) {
    energy += power * (time - last);
    peak = std::max(peak, energy);
    power += change;
    last = time;
  }
  return peak;
}

double BarRow::displacement(const BarEnd& end, double time) const {
  return at(end.bar).velocity[end.side].integral(time);
}

double BarRow::velocity(const BarEnd& end, double time) const {
  return at(end.bar).velocity[end.side].at(time);
}

double BarRow::force(const BarEnd& end, double time) const {
  for (const RowContact& contact : contacts_) {
    for (const BarEnd& e : contact.ends)
      if (e.bar == end.bar && e.side == end.side) return -e.normal() * contact.force_at(time);
  }
  return 0.0;
}

double BarRow::gap(int interface, double time) const {
  const RowContact& contact = contacts_[interface];
  if (contact.closed(time)) return 0.0;
  double gap = contact.initial_gap;
  for (const BarEnd& e : contact.ends) gap -= e.normal() * displacement(e, time);
  return std::max(0.0, gap);
}

}  // namespace abut
