#pragma once

#include <array>
#include <vector>

#include "subdomain_solver/time/foreseeing.hpp"
#include "subdomain_solver/time/inertia.hpp"
#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Central differences on any model with lumped mass, seen at the times of their velocities: half a
/// drift, the force there, half a drift [M.105], [M.106]. Positions obey  q' = q + dt (v + v') / 2,
/// so that a force that is constant in the step, as joined bodies pass it, does exactly the work by
/// which the scheme's own energy changes,  1/2 v (M - dt^2/4 K) v + 1/2 q K q  of linear models.
/// Keeps no accelerations: forces that set in or end find nothing to correct. Every coordinate must
/// have mass. The two latest forces of models without history are kept beside the positions that
/// they are of: a window that begins where the trial of the one before began, or is repeated, finds
/// its first force there, and windows of one step cost one force each. Allocates nothing once
/// buffers have grown.
class DriftKickDrift final : public Integrator, private Inertia, private Foreseeing {
 public:
  /// `step` [s]: the usual one, which the energy of the begin is told for.
  DriftKickDrift(const Problem& problem, double step);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  /// Means of the last step, as the balance in its middle has them.
  void acceleration(const Motion& motion, double time, double step, const Vector& external,
                    Vector& out) const override;
  double kinetic(const Motion& motion) const override;

 private:
  std::optional<Failed> jump(Motion&, double, const Vector&) override { return std::nullopt; }
  void strike(Motion& motion, const Vector& impulse) override;
  bool foresee(const Motion& motion, double time, double dt, Foreseen& ahead) override;

  struct Known {
    bool holds = false;
    std::vector<double> at;  // [m] (dofs)
    ModelResponse response;
  };

  /// Coordinates in the middle of a step, and the values given at its end. False: not finite.
  [[nodiscard]] bool find_middle(const Motion& motion, double time, double dt);
  void find_loads(double time, std::span<const double> q);
  /// The model's answer at middle_, which it takes; good until the next one. Null: inadmissible.
  Known* respond(const std::vector<double>& history);

  const Problem& problem_;
  double step_;
  Vector inverse_mass_;         // [1/kg] (dofs) zero where the motion is prescribed
  std::vector<double> middle_;  // [m] (dofs) q in the middle of the step
  std::vector<double> given_;   // [m] (supports) at its end
  Vector loads_;                // [N] (dofs) in its middle
  std::array<Known, 2> known_;  // the latest is the first one
};

}  // namespace abut
