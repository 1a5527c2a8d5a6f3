#include "subdomain_solver/time/stabilisation.hpp"

#include <algorithm>

namespace abut {

namespace {

// A motion's control: first what was told, then m (k).
enum At : std::size_t { force, share, share_most, work, first };

}  // namespace

void Stabilisation::add_force(const Vector& x, Vector& balance) const {
  balance += spread(hold(place_of(x) - anchor_));
}

void Stabilisation::settle(const Vector& x, double loads, Motion& motion) const {
  const Vector gone = place_of(x) - anchor_, m = hold(gone);
  tell(m, m.dot(gone), loads, motion);
}

void Stabilisation::tell(const Vector& force, const Vector& gone, double loads,
                         Motion& motion) const {
  tell(motions_.transpose() * force, force.dot(gone), loads, motion);
}

/// m (k): what held the loose motions; the work [J] that it took.
void Stabilisation::tell(const Vector& m, double done, double loads, Motion& motion) const {
  const double held = spread(m).lpNorm<1>();
  motion.control.resize(first + static_cast<std::size_t>(m.size()), 0.0);
  // In balance one half of all that acts presses against the other.
  const double all = 0.5 * (loads + held);
  motion.control[force] = held;
  motion.control[share] = all > 0.0 ? held / all : 0.0;
  motion.control[share_most] = std::max(motion.control[share_most], motion.control[share]);
  motion.control[work] += done;
  std::ranges::copy(m, motion.control.begin() + first);
  motion.external_work += done;  // loads and partners did it on the springs
  motion.dissipated += done;
}

Stabilisation::Told Stabilisation::told(const Motion& motion) {
  if (motion.control.empty()) return {};
  return {motion.control[force], motion.control[share], motion.control[share_most],
          motion.control[work]};
}

Vector Stabilisation::held(const Motion& motion) const {
  Vector m = Vector::Zero(motions_.cols());
  if (!motion.control.empty())
    std::copy(motion.control.begin() + first, motion.control.end(), m.begin());
  return -spread(m);
}

}  // namespace abut
