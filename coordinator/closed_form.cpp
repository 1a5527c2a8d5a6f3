#include "coordinator/closed_form.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"

namespace abut {
namespace {

// Transits and impedances that agree to this are equal: both come from a few operations on given
// numbers.
constexpr double rounding = 1e-12;

[[noreturn]] void refuse(const std::string& why) {
  throw InputError(
      fmt::format("the closed form bar_impact does not describe this impact: {}", why),
      "meta.closed_form",
      "Leave out meta.closed_form (and expectations that need it), or change the bodies.");
}

/// An interval along the bar [m], clipped to it.
struct Stretch {
  double from = 0.0, to = 0.0;

  double length() const { return std::max(0.0, to - from); }
};

Stretch clipped(double from, double to, double length) {
  return {std::clamp(from, 0.0, length), std::clamp(to, 0.0, length)};
}

double overlap(const Stretch& a, const Stretch& b) {
  return std::max(0.0, std::min(a.to, b.to) - std::max(a.from, b.from));
}

}  // namespace

BarImpact::Bar BarImpact::make_bar(const BarData& data) {
  Bar bar;
  bar.wall = data.wall;
  bar.normal = data.normal;
  if (data.wall) return bar;
  if (!data.free) refuse(fmt::format("{} has a fixed end", data.name));
  if (data.body_force != 0.0) refuse(fmt::format("a body force acts on {}", data.name));
  const bool positive =
      data.youngs_modulus > 0.0 && data.density > 0.0 && data.area > 0.0 && data.length > 0.0;
  if (!positive) refuse(fmt::format("{} has a property that is not positive", data.name));
  bar.velocity = data.velocity;
  bar.density = data.density;
  bar.area = data.area;
  bar.length = data.length;
  bar.speed = std::sqrt(data.youngs_modulus / data.density);
  bar.impedance = std::sqrt(data.youngs_modulus * data.density) * data.area;
  bar.transit = 2.0 * data.length / bar.speed;
  return bar;
}

BarImpact::BarImpact(const std::array<BarData, 2>& sides, double gap, double begin)
    : run_begin_(begin) {
  if (sides[0].wall && sides[1].wall) refuse("both sides are walls");
  if (sides[0].normal * sides[1].normal != -1.0) refuse("the ports do not face each other");
  if (!(gap >= 0.0)) refuse(fmt::format("the bodies overlap at the begin (gap {} m)", gap));
  bars_ = {make_bar(sides[0]), make_bar(sides[1])};
  closing_speed_ = bars_[0].normal * bars_[0].velocity + bars_[1].normal * bars_[1].velocity;
  if (!(closing_speed_ > 0.0))
    refuse(fmt::format("{} and {} do not approach each other", sides[0].name, sides[1].name));
  begin_ = begin + gap / closing_speed_;
  if (bars_[0].wall || bars_[1].wall) {
    const Bar& bar = bars_[bars_[0].wall ? 1 : 0];
    force_ = closing_speed_ * bar.impedance;
    duration_ = bar.transit;
    return;
  }
  const double z0 = bars_[0].impedance;
  const double z1 = bars_[1].impedance;
  // As velocity jump times impedance, not z0 * z1 / (z0 + z1): the product may leave the range of
  // doubles.
  force_ = closing_speed_ * z0 / (1.0 + z0 / z1);
  duration_ = std::min(bars_[0].transit, bars_[1].transit);
  require_single_interval(sides);
}

/// When the first echo is back in the bar with the shorter transit, the force becomes
/// F (Z_short - Z_long) / (Z_short + Z_long): contact goes on, as a staircase, when that is
/// compressive.
void BarImpact::require_single_interval(const std::array<BarData, 2>& sides) const {
  const int brief = bars_[0].transit <= bars_[1].transit ? 0 : 1;
  const Bar& shorter = bars_[brief];
  const Bar& longer = bars_[1 - brief];
  // With equal transits both echoes come back at once and the force would be tensile.
  if (longer.transit - shorter.transit <= rounding * longer.transit) return;
  if (shorter.impedance - longer.impedance <= rounding * longer.impedance) return;
  refuse(
      fmt::format("the first echo returns in {} ({:.6g} s), whose impedance {:.6g} kg/s is above "
                  "the {:.6g} kg/s of "
                  "{}: the contact force then falls by steps instead of ending",
                  sides[brief].name, shorter.transit, shorter.impedance, longer.impedance,
                  sides[1 - brief].name));
}

double BarImpact::impulse_until(double since) const {
  return force_ * std::clamp(since, 0.0, duration_);
}

double BarImpact::echoed(const Bar& bar, double since) const {
  double sum = impulse_until(since);
  if (since <= bar.transit) return sum;
  // All echoes but the newest are complete; the newest may still be under way.
  const double newest = std::floor(since / bar.transit);
  sum += 2.0 * (newest - 1.0) * force_ * duration_;
  return sum + 2.0 * impulse_until(since - newest * bar.transit);
}

double BarImpact::displacement(int side, double time) const {
  const Bar& bar = bars_[side];
  if (bar.wall) return 0.0;
  const double rigid = bar.velocity * (time - run_begin_);
  return rigid - bar.normal * echoed(bar, time - begin_) / bar.impedance;
}

double BarImpact::velocity(int side, double time) const {
  const Bar& bar = bars_[side];
  const double since = time - begin_;
  if (bar.wall || since < 0.0) return bar.velocity;
  const double jump = bar.normal * velocity_jump(side);
  if (closed(time)) return bar.velocity - jump;
  // In the bar that ends the contact, echo follows echo without a break.
  if (bar.transit - duration_ <= rounding * bar.transit) return bar.velocity - 2.0 * jump;
  // The pulse is as long as the shorter transit, so that at most one echo is at the contact point.
  const double newest = std::floor(since / bar.transit);
  const bool echo = newest >= 1.0 && since - newest * bar.transit < duration_;
  return echo ? bar.velocity - 2.0 * jump : bar.velocity;
}

double BarImpact::velocity_jump(int side) const {
  return bars_[side].wall ? 0.0 : force_ / bars_[side].impedance;
}

double BarImpact::port_force(int side, double time) const {
  return -bars_[side].normal * force_at(time);
}

double BarImpact::gap(double time) const {
  if (time < begin_) return closing_speed_ * (begin_ - time);
  if (closed(time)) return 0.0;
  double gap = 0.0;
  const double since = time - begin_;
  const double rigid = closing_speed_ * since;
  for (const Bar& bar : bars_)
    if (!bar.wall) gap += echoed(bar, since) / bar.impedance;
  return std::max(0.0, gap - rigid);
}

double BarImpact::momentum(int side, double time) const {
  const Bar& bar = bars_[side];
  if (bar.wall) return 0.0;
  return bar.mass() * bar.velocity - bar.normal * impulse_until(time - begin_);
}

double BarImpact::mean_velocity(int side, double time) const {
  const Bar& bar = bars_[side];
  return bar.wall ? 0.0 : momentum(side, time) / bar.mass();
}

BarImpact::Cover BarImpact::cover(const Bar& bar, double since) const {
  Cover cover;
  if (since <= 0.0) return cover;
  const double c = bar.speed;
  const double trip = std::floor(since / bar.transit);   // round trips of the pulse's head
  const double head = c * (since - trip * bar.transit);  // 0 .. 2 L: beyond L it comes back
  const double round = c * bar.transit;
  const double pulse = c * std::min(since, duration_);
  // The pulse as an interval of travelled path, now and one round trip behind.
  for (const double shift : {0.0, round}) {
    if (shift > 0.0 && trip < 1.0) break;
    const Stretch out = clipped(head + shift - pulse, head + shift, bar.length);
    cover.outgoing += out.length();
    for (const double other : {0.0, round}) {
      if (other > 0.0 && trip < 1.0) break;
      const Stretch in = clipped(round - head - other, round - head - other + pulse, bar.length);
      if (shift == 0.0) cover.incoming += in.length();
      cover.both += overlap(out, in);
    }
  }
  return cover;
}

double BarImpact::kinetic(int side, double time) const {
  const Bar& bar = bars_[side];
  if (bar.wall) return 0.0;
  const Cover on = cover(bar, time - begin_);
  const double jump = bar.normal * force_ / bar.impedance;  // v = v0 - jump * (number of waves)
  const double before = bar.velocity;
  const double single = on.outgoing + on.incoming - 2.0 * on.both;
  const double none = bar.length - single - on.both;
  const double squares = none * before * before + single * (before - jump) * (before - jump) +
                         on.both * (before - 2.0 * jump) * (before - 2.0 * jump);
  return 0.5 * bar.density * bar.area * squares;
}

double BarImpact::stored(int side, double time) const {
  const Bar& bar = bars_[side];
  if (bar.wall) return 0.0;
  const Cover on = cover(bar, time - begin_);
  // Outgoing and incoming wave cancel in force where both are.
  const double single = on.outgoing + on.incoming - 2.0 * on.both;
  const double jump = force_ / bar.impedance;
  return 0.5 * bar.density * bar.area * single * jump * jump;
}

double BarImpact::total(int side, double time) const {
  return kinetic(side, time) + stored(side, time);
}

}  // namespace abut
