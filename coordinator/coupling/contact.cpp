#include "coordinator/coupling/contact.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace abut {

namespace {

double displacement_at(const Waveform& trace, double time) {
  double u = 0.0;
  trace.interpolate(trace.u, time, {&u, 1});
  return u;
}

double gap_at(const Joint& joint, const Bodies& bodies, double time) {
  return joint.gap(displacement_at(trace_of(bodies, joint.sides[0]), time),
                   displacement_at(trace_of(bodies, joint.sides[1]), time));
}

}  // namespace

std::optional<Touch> first_overlap(const Joint& joint, const Bodies& bodies, double negligible) {
  const Waveform& t0 = trace_of(bodies, joint.sides[0]);
  const Waveform& t1 = trace_of(bodies, joint.sides[1]);
  const Waveform& finer = t0.size() >= t1.size() ? t0 : t1;
  double before = joint.gap(t0.u.front(), t1.u.front());
  for (std::size_t i = 1; i < finer.size(); ++i) {
    const double time = finer.time[i];
    const double gap = gap_at(joint, bodies, time);
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

void ContactHistory::read(const Joint& joint, double opened_at, Bodies& bodies) {
  const Side& here = joint.kinematic_side();
  const Side& there = joint.neumann_side();
  const Waveform& own = trace_of(bodies, here);
  const bool coarser = bodies.describe(there.body).step > bodies.describe(here.body).step;
  const std::vector<double>& t = coarser ? trace_of(bodies, there).time : own.time;
  const double inward = -joint.normal_of(joint.role.kinematic);
  kicks_ = own.support == ForceSupport::step;
  finer_.clear();
  for (std::size_t i = 0; coarser && i < own.size(); ++i)
    finer_.push_back({own.time[i], inward * own.f[i], gap_at(joint, bodies, own.time[i])});
  levels_.resize(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    double force = own.f[i > 0 && coarser ? 0 : i];
    if (i > 0 && coarser) {
      const double from = kicks_ ? t[i - 1] : 0.5 * (t[i - 1] + t[i]);
      const double to = kicks_ || i + 1 == t.size() ? t[i] : 0.5 * (t[i] + t[i + 1]);
      own.impulse(from, to, {&force, 1});
      force /= to - from;
    }
    levels_[i] = {t[i], inward * force, gap_at(joint, bodies, t[i])};
  }
  // the coordinator has seen the release at this instant already
  if (opened_at == t.front()) levels_.front().force = 0.0;
  compliance_ = 0.0;
  for (const Side& side : joint.sides)
    compliance_ += bodies.kernel(side.body, side.port, 1).displacement.front();
  constexpr double units = 2.0 * std::numeric_limits<double>::epsilon();
  const double moved = std::max(std::abs(own.u.back()), joint.line.reference_gap);
  rounding_ = compliance_ > 0.0 ? units * moved / compliance_ : 0.0;
}

double ContactHistory::peak() const {
  double peak = 0.0;
  for (const ContactLevel& level : levels_) peak = std::max(peak, level.force);
  return peak;
}

Touch ContactHistory::touch(std::size_t i) const {
  // The first push of the finer side that the mean over the coarser one holds.
  for (std::size_t k = 1; k < finer_.size(); ++k) {
    if (finer_[k].time > levels_[i - 1].time && finer_[k].force > 0.0)
      return touch_between(finer_[k - 1], finer_[k]);
  }
  return touch_between(levels_[i - 1], levels_[i]);
}

Touch ContactHistory::touch_between(const ContactLevel& before, const ContactLevel& after) const {
  const double gap = std::max(0.0, before.gap);
  const double overlap = compliance_ * after.force - std::min(0.0, after.gap);
  const double length = after.time - before.time;
  const double moved = gap + overlap;
  const double share = moved > 0.0 ? gap / moved : 0.0;
  return {before.time + share * length, moved / length, after.time};
}

double ContactHistory::release(std::size_t i) const {
  for (std::size_t k = finer_.size(); k-- > 1;) {
    if (finer_[k].time <= levels_[i].time && finer_[k - 1].force > 0.0)
      return release_between(finer_[k - 1], finer_[k]);
  }
  return release_between(levels_[i - 1], levels_[i]);
}

double ContactHistory::release_between(const ContactLevel& before,
                                       const ContactLevel& after) const {
  const double pull = after.gap > 0.0 && compliance_ > 0.0 ? after.gap / compliance_ : -after.force;
  const double length = after.time - before.time;
  const double end = after.time - (kicks_ ? length : 0.0);  // a kick acts at its begin
  if (before.force + pull <= 0.0) return end;
  return end - length + length * std::min(1.0, before.force / (before.force + pull));
}

double ContactHistory::crossing(std::size_t i, double bound) const {
  const ContactLevel& a = levels_[i - 1];
  const ContactLevel& b = levels_[i];
  if (a.force == b.force) return b.time;
  return a.time + (b.time - a.time) * std::clamp((bound - a.force) / (b.force - a.force), 0.0, 1.0);
}

double contact_work(const Joint& joint, const Bodies& bodies) {
  return port_of(bodies, joint.sides[0]).work + port_of(bodies, joint.sides[1]).work;
}

double resultant(const Waveform& force, std::size_t i, int dim) {
  const std::size_t width = index(force.width);
  double sum[3] = {0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < width; ++k) sum[k % index(dim)] += force.f[i * width + k];
  return std::hypot(sum[0], sum[1], sum[2]);
}

double push_of_all(int body, const Bodies& bodies, double length) {
  const Description& about = bodies.describe(body);
  if (std::isinf(about.mass) || about.quasi_static) return 0.0;
  std::array<double, 3> sum{};
  const auto add = [&sum](const Waveform& force, double sign, std::size_t dim) {
    if (force.empty()) return;
    const std::size_t last = force.f.size() - index(force.width);
    for (std::size_t k = 0; k < index(force.width); ++k) sum[k % dim] += sign * force.f[last + k];
  };
  for (std::size_t p = 0; p < about.ports.size(); ++p) {
    const std::size_t dim = index(about.ports[p].geometry.dim);
    for (const Reaction& r : bodies.response(body).ports[p].reactions) add(r.force, -1.0, dim);
    for (const Waveform& force : bodies.request(body).boundary[p].forces) add(force, 1.0, dim);
  }
  return std::hypot(sum[0], sum[1], sum[2]) * length / about.mass;
}

double largest_force(const Joint& joint, const Bodies& bodies) {
  double peak = 0.0;
  for (double f : trace_of(bodies, joint.kinematic_side()).f) peak = std::max(peak, std::abs(f));
  return peak;
}

namespace {

/// Of both sides: how fast they approach each other, and what an impulse between them changes.
std::optional<Recoil> joint_recoil(const Joint& joint, const Bodies& bodies) {
  Recoil sum;
  for (const Side& side : joint.sides) {
    const std::optional<Recoil>& recoil = port_of(bodies, side).recoil;
    if (!recoil) return std::nullopt;
    sum.velocity += recoil->velocity;
    sum.mobility += recoil->mobility;
  }
  return sum.mobility > 0.0 ? std::optional<Recoil>(sum) : std::nullopt;
}

}  // namespace

double closing_impulse(const Joint& joint, const Bodies& bodies) {
  const std::optional<Recoil> recoil = joint_recoil(joint, bodies);
  return recoil ? recoil->velocity / recoil->mobility : 0.0;
}

double opening_kick(const Joint& joint, const Bodies& bodies) {
  const std::optional<Recoil> recoil = joint_recoil(joint, bodies);
  double step = 0.0, closing = 0.0;
  for (const int s : {0, 1}) {
    const Side& side = joint.sides[s];
    const Waveform& trace = trace_of(bodies, side);
    if (trace.support == ForceSupport::step) step = bodies.describe(side.body).step;
    if (!trace.a.empty()) closing += joint.normal_of(s) * trace.a.back();
  }
  return recoil ? -0.5 * step * closing / recoil->mobility : 0.0;
}

double release_impulse(const Joint& joint, double debt, const Bodies& bodies) {
  const std::optional<Recoil> recoil = joint_recoil(joint, bodies);
  if (!recoil || debt <= 0.0) return 0.0;
  const double w = recoil->velocity;
  return (w + std::sqrt(w * w + 2.0 * recoil->mobility * debt)) / recoil->mobility;
}

double paying_impulse(const Joint& joint, double debt, const Bodies& bodies) {
  // Of the energy of approach: a larger debt waits, its impulse would stir up more than it finds.
  constexpr double most = 3.0;
  const std::optional<Recoil> recoil = joint_recoil(joint, bodies);
  if (!recoil) return 0.0;
  const double w = recoil->velocity;
  const double owed = 2.0 * recoil->mobility * debt;
  if (w == 0.0 || owed > most * w * w) return 0.0;
  if (owed < -w * w) return w / recoil->mobility;  // all that can be taken back this way
  return -2.0 * debt / (w + std::copysign(std::sqrt(w * w + owed), w));
}

double work_of_impulse(const Joint& joint, double impulse, const Bodies& bodies) {
  const std::optional<Recoil> recoil = joint_recoil(joint, bodies);
  return recoil ? (0.5 * recoil->mobility * impulse - recoil->velocity) * impulse : 0.0;
}

}  // namespace abut
