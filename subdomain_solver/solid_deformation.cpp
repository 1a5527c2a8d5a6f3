// What deforms a solid gives energy and takes it, beside the rigid motions that supports leave: its
// momentum and angular momentum stay [M.21], [M.130].

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/solve/matrix_sum.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

double energy_of(const SparseMatrix& mass, const Vector& v) { return 0.5 * v.dot(mass * v); }

/// [m/s] of the values that are not kept, less motions that leave momentum and angular momentum
/// what they are, whatever share of the rest is taken away.
Vector beside(std::span<const int> kept, const SparseMatrix& mass, const Eigen::MatrixXd& rigid,
              Vector rest) {
  Eigen::MatrixXd loose = rigid;
  for (const int dof : kept) {
    rest(dof) = 0.0;
    loose.row(dof).setZero();
  }
  if (rigid.cols() == 0) return rest;
  const Eigen::MatrixXd heavy = mass * rigid;
  const Vector momentum = heavy.transpose() * rest;
  return rest - loose * least_squares(heavy.transpose() * loose, momentum);
}

/// More than this of what deforms is never given to velocities, in units of it: what is left of
/// hardly any is noise.
constexpr double most_given = 1.0;

/// The share of the rest that takes so much energy [J] from velocities, or the one that takes most;
/// at most all of it: of a rest that is rounding alone more would be anything. Negative energy is
/// given.
double share_of(double joules, const SparseMatrix& mass, const Vector& v, const Vector& rest) {
  const Vector heavy = mass * rest;
  const double square = rest.dot(heavy), slope = v.dot(heavy);
  if (!(square > 0.0) || !(slope > 0.0)) return 0.0;
  const double root = slope * slope - 2.0 * square * joules;
  const double share = root > 0.0 ? 2.0 * joules / (slope + std::sqrt(root)) : slope / square;
  return std::clamp(share, -most_given, 1.0);
}

/// The same where the rest is all the velocities that have `most` [J].
double part_of(double joules, double most) {
  return 1.0 - std::min(std::sqrt(std::max(0.0, 1.0 - joules / most)), 1.0 + most_given);
}

}  // namespace

/// What is left of velocities beside the rigid motions that supports leave is scaled: down, or up
/// where the energy is negative, which is given then.
double SolidInterior::take_from_deformation(double joules) {
  Motion& motion = state_.motion;
  const double before = energy().kinetic;
  if (parts_.rigid != nullptr || !(std::abs(joules) > 0.0)) return 0.0;
  if (joins_ && !is_passive()) return take_beside_joints(joules);
  Vector rest = view(motion.v);
  double most = 0.0;  // [J]
  if (parts_.reduced) {
    for (Eigen::Index k = 0; k < rest.size(); ++k)
      if (parts_.frequencies[k] == 0.0) rest(k) = 0.0;
    most = 0.5 * rest.squaredNorm();  // modes have a mass of one
  } else {
    const SparseMatrix& whole = mass_of_form();
    const Eigen::MatrixXd rigid = free_motions(true);
    if (rigid.cols() > 0) {
      const Eigen::MatrixXd heavy = whole * rigid;
      const Vector momentum = heavy.transpose() * rest;
      rest -= rigid * solve_symmetric(rigid.transpose() * heavy, momentum);
    }
    for (const Prescribed& p : parts_.problem->supports) rest(p.dof) = 0.0;
    for (const int dof : is_passive() ? std::vector<int>{} : parts_.model->massless())
      rest(dof) = 0.0;
    most = energy_of(whole, rest);
  }
  if (!(most > 0.0)) return 0.0;
  view(motion.v) -= part_of(joules, most) * rest;
  return before - energy().kinetic;
}

/// Sides of a joint move as one, and go on so: their nodes keep what they have.
double SolidInterior::take_beside_joints(double joules) {
  if (parts_.reduced) return 0.0;
  const double before = energy().kinetic;
  std::vector<int> kept = parts_.model->massless();
  for (const Prescribed& p : parts_.problem->supports) kept.push_back(p.dof);
  for (std::size_t p = 0; p < ports_.size(); ++p)
    for (const std::int32_t node : ports_[p].nodes)
      for (int i = 0; joined_[p] && i < description_.dim; ++i)
        kept.push_back(node * description_.dim + i);
  const Vector v = view(state_.motion.v), rest = beside(kept, mass_, free_motions(true), v);
  view(state_.motion.v) -= share_of(joules, mass_, v, rest) * rest;
  return before - energy().kinetic;
}

double SolidInterior::damp(double joules) {
  return joules > 0.0 ? take_from_deformation(joules) : 0.0;
}

}  // namespace abut
