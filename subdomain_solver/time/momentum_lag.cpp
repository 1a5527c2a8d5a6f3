#include "subdomain_solver/time/momentum_lag.hpp"

#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

/// Of the sum of all rows of a step: coordinates without mass are in balance at both ends. What
/// holds them there beside the external forces is constant in steps and passes whole to partners,
/// but here by the trapezoid, as accelerations learn of it from the internal forces.
void MomentumLag::find(const Motion& motion, double step, const Vector& external,
                       Vector& out) const {
  inertia_.noalias() = mass_ * view(motion.a);
  const double inertia = step * (1.0 - weights_.alpha_m - weights_.gamma);
  const double forces = step * (0.5 - weights_.alpha_f);
  out.setZero(external.size());
  for (const int i : inertial_)
    out(i) = inertia * inertia_(i) - forces * (external(i) - motion.force[i]);
  for (const int i : layer_) out(i) = 0.5 * step * (motion.force[i] - external(i));
}

}  // namespace abut
