#include "coordinator/coupling/contact.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

namespace {

double displacement_at(const Waveform& trace, double time) {
  double u = 0.0;
  trace.interpolate(trace.u, time, {&u, 1});
  return u;
}

double gap_at(const Interface& interface, const Bodies& bodies, double time) {
  return interface.gap(displacement_at(trace_of(bodies, interface.sides[0]), time),
                       displacement_at(trace_of(bodies, interface.sides[1]), time));
}

const PortResponse& port_of(const Bodies& bodies, const Side& side) {
  return bodies.response(side.body).ports[static_cast<std::size_t>(side.port)];
}

}  // namespace

std::optional<Touch> first_overlap(const Interface& interface, const Bodies& bodies,
                                   double negligible) {
  const Waveform& t0 = trace_of(bodies, interface.sides[0]);
  const Waveform& t1 = trace_of(bodies, interface.sides[1]);
  const Waveform& finer = t0.size() >= t1.size() ? t0 : t1;
  double before = interface.gap(t0.u.front(), t1.u.front());
  for (std::size_t i = 1; i < finer.size(); ++i) {
    const double time = finer.time[i];
    const double gap = gap_at(interface, bodies, time);
    // a gap that grows is a release, however little it overlaps
    if (gap < -negligible && gap < before) {
      const double length = time - finer.time[i - 1];
      const double share = before <= 0.0 ? 0.0 : before / (before - gap);
      return Touch{finer.time[i - 1] + share * length, (before - gap) / length, time};
    }
    before = gap;
  }
  return std::nullopt;
}

void ContactHistory::read(const Interface& interface, Bodies& bodies) {
  const Side& here = interface.kinematic_side();
  const Side& there = interface.neumann_side();
  const Waveform& own = trace_of(bodies, here);
  const bool coarser = bodies.describe(there.body).step > bodies.describe(here.body).step;
  const std::vector<double>& t = coarser ? trace_of(bodies, there).time : own.time;
  const double inward = -interface.normal_of(interface.kinematic);
  kicks_ = own.support == ForceSupport::step;
  levels_.resize(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    double force = own.f[i > 0 && coarser ? 0 : i];
    if (i > 0 && coarser) {
      const double from = kicks_ ? t[i - 1] : 0.5 * (t[i - 1] + t[i]);
      const double to = kicks_ || i + 1 == t.size() ? t[i] : 0.5 * (t[i] + t[i + 1]);
      own.impulse(from, to, {&force, 1});
      force /= to - from;
    }
    levels_[i] = {t[i], inward * force, gap_at(interface, bodies, t[i])};
  }
  // the coordinator has seen the release at this instant already
  if (interface.opened_at == t.front()) levels_.front().force = 0.0;
  compliance_ = 0.0;
  for (const Side& side : interface.sides)
    compliance_ += bodies.kernel(side.body, side.port, 1).displacement.front();
}

double ContactHistory::peak() const {
  double peak = 0.0;
  for (const ContactLevel& level : levels_) peak = std::max(peak, level.force);
  return peak;
}

Touch ContactHistory::touch(std::size_t i) const {
  const double before = std::max(0.0, levels_[i - 1].gap);
  const double overlap = compliance_ * levels_[i].force - std::min(0.0, levels_[i].gap);
  const double length = levels_[i].time - levels_[i - 1].time;
  const double moved = before + overlap;
  const double share = moved > 0.0 ? before / moved : 0.0;
  return {levels_[i - 1].time + share * length, moved / length, levels_[i].time};
}

double ContactHistory::release(std::size_t i) const {
  const double before = levels_[i - 1].force;
  const double pull = levels_[i].gap > 0.0 && compliance_ > 0.0 ? levels_[i].gap / compliance_
                                                                : -levels_[i].force;
  const double length = levels_[i].time - levels_[i - 1].time;
  const double end = levels_[i].time - (kicks_ ? length : 0.0);  // a kick acts at its begin
  if (before + pull <= 0.0) return end;
  return end - length + length * std::min(1.0, before / (before + pull));
}

double ContactHistory::crossing(std::size_t i, double bound) const {
  const ContactLevel& a = levels_[i - 1];
  const ContactLevel& b = levels_[i];
  if (a.force == b.force) return b.time;
  return a.time + (b.time - a.time) * std::clamp((bound - a.force) / (b.force - a.force), 0.0, 1.0);
}

double contact_work(const Interface& interface, const Bodies& bodies) {
  return port_of(bodies, interface.sides[0]).work + port_of(bodies, interface.sides[1]).work;
}

double peak_force(const Interface& interface, const Bodies& bodies) {
  double peak = 0.0;
  for (double f : trace_of(bodies, interface.kinematic_side()).f)
    peak = std::max(peak, std::abs(f));
  return peak;
}

double closing_impulse(const Interface& interface, const Bodies& bodies) {
  double approach = 0.0;  // sum of w0
  double mobility = 0.0;  // sum of G0
  for (const Side& side : interface.sides) {
    if (std::isinf(bodies.describe(side.body).mass)) continue;
    const PortResponse& port = port_of(bodies, side);
    if (!port.rebound) return 0.0;
    approach += port.rebound->nodal_velocity;
    mobility += port.rebound->node_mobility;
  }
  return mobility > 0.0 ? approach / mobility : 0.0;
}

double release_impulse(const Interface& interface, const Bodies& bodies) {
  double approach = 0.0;  // sum of w0* - w1*
  double mobility = 0.0;  // sum of G0 - G1
  double node_mobility = 0.0;
  double mean_velocity = 0.0;
  const double captured = interface.debt;
  for (const Side& side : interface.sides) {
    if (std::isinf(bodies.describe(side.body).mass)) continue;
    const PortResponse& port = port_of(bodies, side);
    if (!port.rebound) return 0.0;
    const Rebound& r = *port.rebound;
    approach += r.node_velocity - r.inner_velocity;
    mobility += r.node_mobility - r.inner_mobility;
    node_mobility += r.node_mobility;
    mean_velocity += r.nodal_velocity;  // mean of the half-step velocities around it
  }
  if (mobility <= 0.0 || captured <= 0.0) return 0.0;
  const double discriminant = mean_velocity * mean_velocity + 2.0 * node_mobility * captured;
  const double passive = (mean_velocity + std::sqrt(discriminant)) / node_mobility;
  return std::clamp(approach / mobility, 0.0, std::max(0.0, passive));
}

double paying_impulse(const Interface& interface, const Bodies& bodies) {
  // Of the root's two terms: a debt below this share of the energy of approach is paid by the
  // impulse's first order, and stirs up little beside.
  constexpr double payable = 0.5;
  double approach = 0.0, mobility = 0.0;
  for (const Side& side : interface.sides) {
    const std::optional<Recoil>& recoil = port_of(bodies, side).recoil;
    if (!recoil) return 0.0;
    approach += recoil->velocity;
    mobility += recoil->mobility;
  }
  // -J approach + 1/2 J^2 mobility = debt, the smaller root
  const double energy = approach * approach;
  if (2.0 * mobility * std::abs(interface.debt) > payable * energy) return 0.0;
  const double root = std::sqrt(energy + 2.0 * mobility * interface.debt);
  return approach == 0.0 ? 0.0 : -2.0 * interface.debt / (approach + std::copysign(root, approach));
}

}  // namespace abut
