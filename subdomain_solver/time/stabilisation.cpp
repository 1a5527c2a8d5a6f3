#include "subdomain_solver/time/stabilisation.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

namespace {

// A motion's control: first what was told, then m (k).
enum At : std::size_t { force, share, share_most, along, work, first };

/// Of all that presses on a body: forces along one of its motions below this are those of rounding
/// and of faces that meet at an angle.
constexpr double least_along = 1.0e-3;

}  // namespace

void Stabilisation::add_force(const Vector& x, Vector& balance) const {
  balance += spread(hold(place_of(x) - anchor_));
}

void Stabilisation::settle(const Vector& x, const Vector& loads, Motion& motion) const {
  const Vector gone = place_of(x) - anchor_, m = hold(gone);
  tell(m, m.dot(gone), loads, motion);
}

void Stabilisation::tell(const Vector& force, const Vector& gone, const Vector& loads,
                         Motion& motion) const {
  tell(motions_.transpose() * force, force.dot(gone), loads, motion);
}

/// m (k): what held the loose motions; the work [J] that it took.
void Stabilisation::tell(const Vector& m, double done, const Vector& loads, Motion& motion) const {
  const double held = spread(m).lpNorm<1>();
  motion.control.resize(first + static_cast<std::size_t>(m.size()), 0.0);
  // In balance one half of all that acts presses against the other.
  const double all = 0.5 * (loads.lpNorm<1>() + held);
  motion.control[force] = held;
  motion.control[share] = all > 0.0 ? held / all : 0.0;
  motion.control[share_most] = std::max(motion.control[share_most], motion.control[share]);
  motion.control[along] = share_along(m, loads, all);
  motion.control[work] += done;
  std::ranges::copy(m, motion.control.begin() + first);
  motion.external_work += done;  // loads and partners did it on the springs
  motion.dissipated += done;
}

/// What presses on a body from two sides says nothing of the way between them.
double Stabilisation::share_along(const Vector& m, const Vector& loads, double all) const {
  const Vector way = motions_ * m, held = spread(m);
  const double most = way.lpNorm<Eigen::Infinity>();
  if (!(most > 0.0)) return 0.0;
  const double springs = std::abs(way.dot(held)) / most;
  const double there = 0.5 * (way.cwiseProduct(loads).lpNorm<1>() / most + springs);
  return springs / std::max(there, least_along * all);
}

Stabilisation::Told Stabilisation::told(const Motion& motion) {
  if (motion.control.empty()) return {};
  return {motion.control[force], motion.control[share], motion.control[share_most],
          motion.control[along], motion.control[work]};
}

Vector Stabilisation::held(const Motion& motion) const {
  Vector m = Vector::Zero(motions_.cols());
  if (!motion.control.empty())
    std::copy(motion.control.begin() + first, motion.control.end(), m.begin());
  return -spread(m);
}

}  // namespace abut
