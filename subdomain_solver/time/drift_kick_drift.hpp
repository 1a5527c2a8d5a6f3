#pragma once

#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Central differences on any model with lumped mass, seen at the times of their velocities: half a
/// drift, the force there, half a drift [M.105], [M.106]. Positions obey  q' = q + dt (v + v') / 2,
/// so that a force that is constant in the step, as joined bodies pass it, does exactly the work by
/// which the scheme's own energy changes,  1/2 v (M - dt^2/4 K) v + 1/2 q K q  of linear models.
/// Keeps no accelerations: forces that set in or end find nothing to correct. Every coordinate must
/// have mass. Allocates nothing once buffers have grown.
class DriftKickDrift final : public Integrator {
 public:
  /// `step` [s]: the usual one, which the energy of the begin is told for.
  DriftKickDrift(const Problem& problem, double step);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  /// Means of the last step, as the balance in its middle has them.
  void acceleration(const Motion& motion, double time, double step, Vector& out) const override;
  double kinetic(const Motion& motion) const override;

 private:
  void find_loads(double time, std::span<const double> q);

  const Problem& problem_;
  double step_;
  Vector inverse_mass_;         // [1/kg] (dofs) zero where the motion is prescribed
  std::vector<double> middle_;  // [m] (dofs) q in the middle of the step
  std::vector<double> given_;   // [m] (supports) at its end
  Vector loads_;                // [N] (dofs) in its middle
  ModelResponse response_;
};

}  // namespace abut
