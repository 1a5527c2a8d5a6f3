#include "subdomain_solver/passive/rigid_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/index.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

constexpr int most_iterations = 100;
/// Of the largest moment, to which the moment of the impulses is found; and at which it may stay
/// where rounding lets it come no nearer.
constexpr double tolerance = 1.0e-15, step_rounding = 1.0e-12;
/// [rad] in one step. A turn that is not small beside one is no straight way at all.
constexpr double most_turn = 1.0;
/// [rad] below which chords are arcs to 1e-11 of a turn, and the difference is lost in rounding.
constexpr double straight = 1.0e-5;

/// (R - 1) r without the difference.
Eigen::Vector3d turned(const Eigen::Quaterniond& by, const Eigen::Vector3d& arm) {
  const Eigen::Vector3d vector = by.vec(), half = vector.cross(arm);
  return 2.0 * (by.w() * half + vector.cross(half));
}

}  // namespace

RigidStep::RigidStep(const RigidModel& body, std::vector<Eigen::Vector3d> arms,
                     std::vector<const Load*> loads)
    : body_(body), arms_(std::move(arms)), loads_(std::move(loads)) {}

Eigen::Vector3d RigidStep::at(std::span<const double> values, std::size_t point) const {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  const std::size_t dim = index(body_.dim());
  for (std::size_t i = 0; i < dim; ++i) out(static_cast<Eigen::Index>(i)) = values[point * dim + i];
  return out;
}

/// The energy of rotation changes by the moment times the mean of the velocities of both halves,
/// each that of half of its half.
RigidStep::Turn RigidStep::turn(const Motion& motion, const Eigen::Vector3d& impulse,
                                const Eigen::Vector3d& moment) const {
  Vector change = Vector::Zero(body_.dofs());
  change.head(body_.dim()) = impulse.head(body_.dim());
  if (body_.dim() == 2) {
    change(2) = moment(2);
  } else {
    change.tail<3>() = moment;
  }
  change = change.cwiseQuotient(body_.lumped_mass()).eval();
  Turn out{motion.q, motion.v, {}, {}};
  view(out.v) += 0.5 * change;
  out.most = body_.fastest_turn(motion.q, out.v) * length_;
  out.begin = body_.pose(motion.q).attitude;
  if (!(out.most <= most_turn)) return out;
  body_.drift(out.q, out.v, length_);
  view(out.v) += 0.5 * change;
  out.end = body_.pose(out.q).attitude;
  const Eigen::Vector3d before = body_.angular_momentum(motion.v);
  const Eigen::Vector3d after = body_.angular_momentum(out.v);
  out.mean = 0.5 * (body_.angular_velocity(out.begin, before + 0.25 * moment) +
                    body_.angular_velocity(out.end, after - 0.25 * moment));
  return out;
}

/// With which the impulses work on the mean velocity as they do on the ways of their points.
Eigen::Vector3d RigidStep::moment_of(const Turn& turn, std::span<const double> impulses,
                                     double& size) const {
  const Eigen::Quaterniond between = turn.end * turn.begin.conjugate();
  const double square = turn.mean.squaredNorm();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  size = 0.0;
  for (std::size_t p = 0; p < arms_.size(); ++p) {
    const Eigen::Vector3d impulse = at(impulses, p);
    if (impulse.isZero(0.0)) continue;
    const Eigen::Vector3d arm = turn.begin * arms_[p], way = turned(between, arm);
    const Eigen::Vector3d mean = arm + 0.5 * way;
    sum += mean.cross(impulse);
    size += mean.norm() * impulse.norm();
    if (turn.most < straight) continue;
    const Eigen::Vector3d rest = way / length_ - turn.mean.cross(mean);
    sum += rest.dot(impulse) / square * turn.mean;
  }
  return sum;
}

std::optional<Failed> RigidStep::step(Motion& motion, double begin, double end,
                                      std::span<const double> impulses) {
  length_ = end - begin;
  Vector load = Vector::Zero(body_.dofs());
  std::vector<double> middle = motion.q;
  if (body_.fastest_turn(motion.q, motion.v) * length_ <= most_turn)
    body_.drift(middle, motion.v, 0.5 * length_);
  for (const Load* own : loads_) own->add(begin + 0.5 * length_, middle, load);
  const int dim = body_.dim();
  Eigen::Vector3d given = Eigen::Vector3d::Zero(), turning = given;
  given.head(dim) = length_ * load.head(dim);
  if (dim == 2) turning(2) = length_ * load(2);
  if (dim == 3) turning = length_ * load.tail<3>();
  const Eigen::Vector3d loaded = given, loading = turning;
  for (std::size_t p = 0; p < arms_.size(); ++p) given += at(impulses, p);
  Eigen::Vector3d moment = turning;
  Turn now;
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0;; ++k) {
    now = turn(motion, given, moment);
    if (!std::isfinite(now.most) || !given.allFinite()) return not_finite(end);
    if (now.most > most_turn || k == most_iterations) {
      return Failed{Failed::Cause::no_convergence, end,
                    "the body turns too far in a step: take a smaller step"};
    }
    double size = 0.0;
    const Eigen::Vector3d next = loading + moment_of(now, impulses, size);
    const double change = (next - moment).norm();
    moment = next;
    const double scale = size + loading.norm();
    if (change <= tolerance * scale || (change >= last && change <= step_rounding * scale)) break;
    last = change;
  }
  now = turn(motion, given, moment);
  const Eigen::Vector3d travel = length_ * (at(motion.v, 0) + 0.5 / body_.total_mass() * given);
  motion.external_work += loaded.dot(travel) / length_ + loading.dot(now.mean);
  see(now, travel);
  motion.q = now.q;
  motion.v = now.v;
  return std::nullopt;
}

/// Where the points went: h^2/8 of their largest acceleration bounds what their ways are beside
/// the chord. Changes of the angular velocity of what nothing turns are part of it in space.
void RigidStep::see(const Turn& turn, const Eigen::Vector3d& travel) {
  const Eigen::Quaterniond between = turn.end * turn.begin.conjugate();
  const std::size_t dim = index(body_.dim());
  moved_.clear();
  mean_arms_.clear();
  double farthest = 0.0;
  for (const Eigen::Vector3d& own : arms_) {
    const Eigen::Vector3d arm = turn.begin * own, way = turned(between, arm), whole = travel + way;
    moved_.insert(moved_.end(), whole.data(), whole.data() + dim);
    mean_arms_.push_back(arm + 0.5 * way);
    farthest = std::max(farthest, own.norm());
  }
  const double precession = dim == 3 ? 1.0 + 1.0 / std::sqrt(3.0) : 1.0;
  bulge_ = 0.125 * precession * turn.most * turn.most * farthest;
  const Eigen::Quaterniond middle = turn.begin.slerp(0.5, turn.end);
  for (int k = dim == 2 ? 2 : 0; k < 3; ++k)
    mobility_.col(k) = body_.angular_velocity(middle, Eigen::Vector3d::Unit(k));
}

void RigidStep::compliance(const std::vector<std::size_t>& values, std::vector<double>& out) const {
  const std::size_t dim = index(body_.dim()), count = values.size();
  out.assign(count * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index along = static_cast<Eigen::Index>(values[i] % dim);
    const Eigen::Vector3d turning =
        mobility_ * mean_arms_[values[i] / dim].cross(Eigen::Vector3d::Unit(along));
    for (std::size_t j = 0; j <= i; ++j) {
      const Eigen::Index other = static_cast<Eigen::Index>(values[j] % dim);
      const double moved = turning.cross(mean_arms_[values[j] / dim])(other);
      const double own = along == other ? 1.0 / body_.total_mass() : 0.0;
      out[i * count + j] = out[j * count + i] = 0.5 * (own + moved);
    }
  }
}

}  // namespace abut
