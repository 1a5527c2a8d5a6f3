#include "coordinator/coupling/line_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {

Approach LineWatch::approach(const Joint& joint, const Bodies& bodies) {
  const PortResponse& p0 = port_of(bodies, joint.sides[0]);
  const PortResponse& p1 = port_of(bodies, joint.sides[1]);
  return {joint.gap(p0.trace.u.back(), p1.trace.u.back()), p0.speed_bound + p1.speed_bound};
}

bool LineWatch::stayed_apart(const Joint& joint, const Bodies& bodies, double) const {
  const PortResponse& p0 = port_of(bodies, joint.sides[0]);
  const PortResponse& p1 = port_of(bodies, joint.sides[1]);
  const bool right = joint.normal_of(0) > 0.0;  // side 0 looks to the right
  const std::vector<double>& left_side = right ? p0.upper : p1.upper;
  const std::vector<double>& right_side = right ? p1.lower : p0.lower;
  for (std::size_t part = 0; part < std::min(left_side.size(), right_side.size()); ++part) {
    if (right_side[part] <= left_side[part]) return false;
  }
  return true;
}

double LineWatch::peak_force(const Joint& joint, const Bodies& bodies) const {
  return largest_force(joint, bodies);
}

/// By more than a cell of the finer mesh: less is an overlap.
bool LineWatch::passed(const Joint& joint, const Bodies& bodies) const {
  const double gap = joint.gap(trace_of(bodies, joint.sides[0]).u.back(),
                               trace_of(bodies, joint.sides[1]).u.back());
  double spacing = std::numeric_limits<double>::infinity();
  for (const Side& side : joint.sides) {
    const double own = bodies.port(side).geometry.spacing;
    if (own > 0.0) spacing = std::min(spacing, own);
  }
  return gap < -spacing;
}

// ---- contact ------------------------------------------------------------------------------------

std::optional<Engagement> PointWatch::touch(const Joint& joint, const TimeWindow&,
                                            const Bodies& bodies, double negligible) const {
  const std::optional<Touch> touch = first_overlap(joint, bodies, negligible);
  if (!touch) return std::nullopt;
  return Engagement{.speed = touch->speed, .end = touch->state};
}

Shown PointWatch::show(const Joint& joint, const Bodies& bodies) const {
  return {joint.closed() && peak_force(joint, bodies) > 0.0};
}

void PointWatch::settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
                        Bodies& bodies, ContactChanges& changes) {
  if (joint.closed()) account_->settle(joint, window, energy, run, bodies, changes);
}

// ---- published form -----------------------------------------------------------------------------

std::optional<Engagement> PublishedWatch::begin(Joint& joint, const TimeWindow& window,
                                                const Bodies& bodies, ContactChanges& changes) {
  const Waveform& t0 = trace_of(bodies, joint.sides[0]);
  const Waveform& t1 = trace_of(bodies, joint.sides[1]);
  if (!joint.closed()) {
    if (joint.gap(t0.u.back(), t1.u.back()) >= 0.0) return std::nullopt;
    const double speed = std::abs(t0.v.back() - t1.v.back());
    const double impulse = projection_ ? std::max(0.0, closing_impulse(joint, bodies)) : 0.0;
    return Engagement{.speed = speed, .end = window.end, .presses = true, .impulse = impulse};
  }
  // Persistence: a closed joint stays closed while the force handed over compresses.
  const int side = roles_swap_ ? 1 - joint.role.kinematic : joint.role.kinematic;
  const Waveform& trace = side == 0 ? t0 : t1;
  if (-joint.normal_of(side) * trace.f.back() > 0.0) return std::nullopt;
  joint.disengage();
  changes.push_back({false, window.begin, 0.0});
  return std::nullopt;
}

void PublishedWatch::settle(Joint& joint, const TimeWindow&, double, ContactRun&, Bodies& bodies,
                            ContactChanges&) {
  if (!joint.closed()) return;
  joint.contact.force_scale = std::max(joint.contact.force_scale, peak_force(joint, bodies));
  if (roles_swap_) joint.role.kinematic = 1 - joint.role.kinematic;
}

// ---- tied, and inside ---------------------------------------------------------------------------

void SharedNodeWatch::settle(Joint& joint, const TimeWindow&, double, ContactRun&, Bodies& bodies,
                             ContactChanges&) {
  joint.contact.force_scale = std::max(joint.contact.force_scale, peak_force(joint, bodies));
  if (roles_swap_) joint.role.kinematic = 1 - joint.role.kinematic;
}

namespace {

/// Contact inside a body, as the traces of both sides show it.
struct InsideTraces {
  const Waveform& t0;
  const Waveform& t1;
  const Joint& joint;

  double force(std::size_t i) const { return -joint.normal_of(0) * t0.f[i]; }
  double gap(std::size_t i) const { return joint.gap(t0.u[i], t1.u[i]); }
  double speed(std::size_t i) const { return joint.normal_of(0) * (t0.v[i] - t1.v[i]); }

  /// The force is there at i and was not before. The motion before it is not yet braked and tells
  /// when the gap closes.
  ContactChange closing(std::size_t i) const {
    if (i == 0) return {true, t0.time[0], speed(0)};
    const double before = speed(i - 1);
    const double latest = t0.time[i] + (t0.time[i] - t0.time[i - 1]);
    const double crossing = before > 0.0 ? t0.time[i - 1] + gap(i - 1) / before : t0.time[i];
    return {true, std::clamp(crossing, t0.time[i - 1], latest), before};
  }
  /// The force is gone at i.
  ContactChange opening(std::size_t i) const {
    double crossing = t0.time[i - 1];
    if (i >= 2 && force(i - 2) > force(i - 1)) {
      const double slope = (force(i - 2) - force(i - 1)) / (t0.time[i - 1] - t0.time[i - 2]);
      crossing = std::min(t0.time[i], crossing + force(i - 1) / slope);
    }
    return {false, crossing, 0.0};
  }
};

InsideTraces traces_of(const Joint& joint, const Bodies& bodies) {
  return {trace_of(bodies, joint.sides[0]), trace_of(bodies, joint.sides[1]), joint};
}

}  // namespace

Shown InsideWatch::show(const Joint& joint, const Bodies& bodies) const {
  const InsideTraces traces = traces_of(joint, bodies);
  bool pressed = false;
  for (std::size_t i = 0; i < traces.t0.size(); ++i) pressed = pressed || traces.force(i) > 0.0;
  return {pressed};
}

void InsideWatch::settle(Joint& joint, const TimeWindow&, double, ContactRun&, Bodies& bodies,
                         ContactChanges& changes) {
  const InsideTraces traces = traces_of(joint, bodies);
  for (std::size_t i = 0; i < traces.t0.size(); ++i) {
    const bool presses = traces.force(i) > 0.0;
    if (presses == joint.pressing()) continue;
    changes.push_back(presses ? traces.closing(i) : traces.opening(i));
    presses ? joint.press() : joint.disengage();
  }
}

}  // namespace abut
