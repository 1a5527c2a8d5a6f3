#include "coordinator/coupling/tie.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/assert.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/exchange_parts.hpp"
#include "coordinator/coupling/port_turn.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

void Tie::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  if (start_.empty()) keep_start(window.begin, joint, bodies);
  remember(window);
  straight_ = !looks(joint, bodies);
  for (const int s : {0, 1}) grids_[s] = substeps_of(bodies, joint.sides[s], window);
  see_turns(joint, bodies);
  iterate_ = {grids_[joint.role.kinematic], rows_.width()};
  window_ = window;
  first_speed_ = -1.0;
  scale_.step = std::min(grids_[0].step, grids_[1].step);
  trial_.resize(0);
  std::array<const Waveform*, 2> looks;
  for (const std::size_t s : {0u, 1u}) looks[s] = look_of(bodies, joint.sides[s], grids_[s]);
  if (looks[0] != nullptr && looks[1] != nullptr) part(joint, looks, trial_);
}

/// By how much motions of both sides part, at the ends of the kinematic side's steps.
void Tie::part(const Joint& joint, const std::array<const Waveform*, 2>& motions,
               Eigen::VectorXd& out) const {
  out.resize(iterate_.size());
  std::vector<double> u, seen(index(rows_.width()));
  for (int i = 1; i <= iterate_.steps.count; ++i) {
    for (const std::size_t s : {0u, 1u}) {
      const Waveform& motion = *motions[s];
      u.resize(index(motion.width));
      motion.interpolate(motion.u, iterate_.steps.time(i), u);
      apply(rows_.of[s], rows_.dim, u, seen);
      const bool kinematic = s == index(joint.role.kinematic);
      for (std::size_t k = 0; k < seen.size(); ++k) {
        double& to = out[iterate_.at(i) + static_cast<Eigen::Index>(k)];
        if (s == 0) to = -start_[k] * (joint.role.kinematic == 0 ? 1.0 : -1.0);
        to += kinematic ? seen[k] : -seen[k];
      }
    }
  }
}

void Tie::keep_start(double time, const Joint& joint, const Bodies& bodies) {
  std::vector<double> seen(index(rows_.width()));
  start_.assign(seen.size(), 0.0);
  for (const std::size_t s : {0u, 1u}) {
    const Waveform& trace = trace_of(bodies, joint.sides[s]);
    apply(rows_.of[s], rows_.dim, row(trace, trace.u, index_at_begin(trace, time)), seen);
    for (std::size_t k = 0; k < seen.size(); ++k) start_[k] += s == 0 ? seen[k] : -seen[k];
  }
}

void Tie::see_turns(const Joint& joint, const Bodies& bodies) {
  for (const std::size_t s : {0u, 1u}) {
    const Side& side = joint.sides[s];
    const Description& body = bodies.describe(side.body);
    const Waveform& trace = trace_of(bodies, side);
    turns_[s].resize(0, 0);
    if (body.linear || body.quasi_static || trace.size() == 0 || rows_.dim == 1) continue;
    turns_[s] = turn_of(bodies.port(side).geometry, row(trace, trace.u, trace.size() - 1));
  }
}

/// What ended is past where the next window begins at its end, not where it is tried anew.
void Tie::remember(const TimeWindow& window) {
  if (last_.force.empty() || window.begin < last_.time - 1.0e-9 * window.length()) return;
  if (!past_.empty() && past_.front().time == last_.time) return;
  past_.insert(past_.begin(), last_);
  if (past_.size() > 2) past_.pop_back();
}

/// Loads of statics mostly grow as they grew.
void Tie::go_straight_on(Eigen::Ref<Eigen::VectorXd> x) const {
  if (past_.empty()) return;
  const Past &b = past_.front(), &a = past_.back();
  const auto follow = [&](const Substeps& steps, const std::vector<double>& from,
                          const std::vector<double>& to, Eigen::Index first) {
    for (int i = 1; i <= steps.count; ++i) {
      const double share = a.time < b.time ? (steps.time(i) - b.time) / (b.time - a.time) : 0.0;
      for (std::size_t k = 0; k < to.size(); ++k) x[first++] = to[k] + share * (to[k] - from[k]);
    }
  };
  follow(iterate_.steps, a.force, b.force, 0);
  for (const std::size_t s : {0u, 1u})
    follow(grids_[s], a.place[s], b.place[s], first_place(static_cast<int>(s)));
}

/// As at the end of the window before, or of a longer attempt at this one. Where bodies have told
/// how they would part, TieNet knows better.
void Tie::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  x.setZero();
  if (straight_) return go_straight_on(x);
  if (force_.empty()) return;
  std::vector<double> f(index(iterate_.width));
  for (int i = 1; i <= iterate_.steps.count; ++i) {
    const bool inside = covers(force_, iterate_.steps);
    force_.force_at(inside ? iterate_.steps.time(i) : force_.time.back(), f);
    std::ranges::copy(f, &x[iterate_.at(i)]);
  }
}

void Tie::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                 Bodies& bodies) {
  lay_times(iterate_.steps, iterate_.width, force_);
  force_.support = ForceSupport::step;
  force_.f.assign(index(iterate_.width), 0.0);
  force_.f.insert(force_.f.end(), x.begin(), x.begin() + iterate_.size());
  last_.time = window_.end;
  last_.force.assign(x.begin() + iterate_.size() - iterate_.width, x.begin() + iterate_.size());
  const Side& end = joint.sides[side];
  Waveform& on_body = bodies.force(end);
  const std::size_t width = bodies.port(end).geometry.points.size();
  lay_times(iterate_.steps, static_cast<int>(width), on_body);
  on_body.support = ForceSupport::step;
  on_body.f.assign(on_body.time.size() * width, 0.0);
  const double sign = side == joint.role.kinematic ? 1.0 : -1.0;
  for (std::size_t i = 1; i < on_body.time.size(); ++i)
    rows_.press(side, sign, row(force_, force_.f, i),
                std::span(on_body.f).subspan(i * width, width));
  Advance& request = bodies.request(end.body);
  if (looks(joint, bodies))
    request.ahead = bodies.window() > 0.0 ? bodies.window() : window_.length();
  if (loose_[side] == 0) return;
  const double* places_here = x.data() + first_place(side);
  request.carry.assign(places_here, places_here + places(side));
  last_.place[side].assign(request.carry.end() - loose_[side], request.carry.end());
}

/// Without inertia, a body lets go of at once would be far away, where it is not linear; and where
/// nothing holds it, nowhere.
bool Tie::looks(const Joint& joint, const Bodies& bodies) const {
  return std::ranges::all_of(joint.sides, [&](const Side& side) {
    const Description& body = bodies.describe(side.body);
    return !body.quasi_static || (body.linear && body.loose.empty());
  });
}

void Tie::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  double travelled = 0.0, spacing = 0.0;
  speed_ = 0.0;
  std::array<const Waveform*, 2> motions;
  for (const std::size_t s : {0u, 1u}) {
    motions[s] = &trace_of(bodies, joint.sides[s]);
    speed_ = std::max(speed_, largest(motions[s]->v));
    travelled = std::max(travelled, largest(motions[s]->u));
    spacing = std::max(spacing, bodies.port(joint.sides[s]).geometry.spacing);
  }
  const bool first = first_speed_ < 0.0;
  if (first) first_speed_ = speed_;
  part(joint, motions, jump_);
  open_.resize(0);
  g.head(iterate_.size()) = x.head(iterate_.size()) - jump_ / compliance_;
  unbalanced_ = 0.0;
  for (const int s : {0, 1}) {
    if (loose_[s] == 0) continue;
    const std::vector<double>& left = bodies.response(joint.sides[s].body).unbalanced;
    ABUT_ASSERT(static_cast<Eigen::Index>(left.size()) == places(s));
    const Eigen::Map<const Eigen::VectorXd> sum(left.data(), places(s));
    g.segment(first_place(s), places(s)) = x.segment(first_place(s), places(s)) - compliance_ * sum;
    unbalanced_ = std::max(unbalanced_, sum.lpNorm<Eigen::Infinity>());
  }
  scale_.velocity = std::max(joint.contact.closing_speed, std::min(first_speed_, speed_));
  moved_ = scale_.velocity * scale_.step;
  row_force_ = x.head(iterate_.size()).lpNorm<Eigen::Infinity>();
  // Or what the force moves in a step: bodies at rest have no other measure.
  const double force = joint.contact.force_scale > 0.0 ? joint.contact.force_scale : row_force_;
  scale_.velocity = std::max(scale_.velocity, force * compliance_ / scale_.step);
  // Laws of finite strain know strains to the round-off of 1: ends that no wave has reached yet
  // answer a force with noise.
  scale_.roundoff = roundoff_of(travelled, spacing);
  if (!first) return;
  const double unit = scale_.velocity * scale_.step / compliance_;
  unit_ = unit > 0.0 ? 1.0 / unit : 1.0;
}

double Tie::seen(double distance) const {
  return scaled(distance, scale_.velocity * scale_.step, scale_.roundoff);
}

double Tie::seen_by_motion(double distance) const {
  return scaled(distance, moved_, scale_.roundoff);
}

/// Taken back in a step, what they have parted by would swing for ever.
void Tie::rejoin() {
  start_.clear();
  past_.clear();
  last_ = {};
}

void Tie::begin_passive(double time) {
  force_.time = {time};
  force_.width = rows_.width();
  force_.support = ForceSupport::step;
  force_.f.assign(index(rows_.width()), 0.0);
  jump_.setZero(rows_.width());
}

void Tie::see_passive(double end, std::span<const double> force, std::span<const double> parted) {
  force_.time.push_back(end);
  force_.f.insert(force_.f.end(), force.begin(), force.end());
  for (std::size_t k = 0; k < parted.size(); ++k) {
    double& most = jump_[static_cast<Eigen::Index>(k)];
    most = std::max(most, std::abs(parted[k]));
  }
}

double Tie::largest_force() const {
  double most = 0.0;
  for (std::size_t i = 1; i < force_.size(); ++i)
    most = std::max(most, resultant(force_, i, rows_.dim));
  return most;
}

FieldResiduals Tie::measure(const Eigen::Ref<const Eigen::VectorXd>&,
                            const Eigen::Ref<const Eigen::VectorXd>&) const {
  FieldResiduals r;
  const bool open = open_.size() == jump_.size();
  r.displacement = seen(open ? (jump_ - open_).lpNorm<Eigen::Infinity>() : missed());
  r.force = seen(unbalanced_ * compliance_);
  return r;
}

void Tie::scales(Eigen::Ref<Eigen::VectorXd> s) const {
  s.setConstant(unit_ / compliance_);
  s.head(iterate_.size()).setConstant(unit_);
}

void Tie::Past::state(Archive& archive) {
  archive.field("time", time);
  archive.field("force", force);
  for (std::vector<double>& of : place) archive.field("place", of);
}

void Tie::state(Archive& archive) {
  archive.field("start", start_);
  last_.state(archive);
  list(archive, "past", past_, [](Archive& a, Past& past) { past.state(a); });
  field(archive, "force", force_);
}

}  // namespace abut
