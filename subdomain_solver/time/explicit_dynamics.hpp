#pragma once

#include "subdomain_solver/time/inertia.hpp"
#include "subdomain_solver/time/integrator.hpp"
#include "subdomain_solver/time/massless_layer.hpp"

namespace abut {

/// Central differences on any model with lumped mass, in the form that has positions, velocities
/// and accelerations at the same times (velocity Verlet) [M.48]. Conserves momentum exactly and,
/// below the stable step, the energy of [M.4], exactly where the model is linear: its kinetic part
/// is 1/2 v(-) M v(+) of the velocities half a step before and after. Coordinates without mass lie
/// where their forces balance at the end of every step, and take contact there [M.85], [M.86]. A
/// step is two passes over the motion around the model's force, and allocates nothing.
class ExplicitDynamics final : public Integrator, private Inertia {
 public:
  /// `step` [s]: nominal; the energy at the begin is that of steps of this length.
  explicit ExplicitDynamics(const Problem& problem, double step = 0.0);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  void acceleration(const Motion& motion, double time, double step, const Vector& external,
                    Vector& out) const override;
  double kinetic(const Motion& motion) const override;

 private:
  std::optional<Failed> jump(Motion& motion, double time, const Vector& change) override;
  void strike(Motion& motion, const Vector& impulse) override;

  struct Range {  // of coordinates that one thread updates
    std::size_t begin, end;
  };
  /// Over all coordinates, in ranges of fixed length: their sums do not depend on threads.
  template <class Update>
  void update_all(std::size_t count, const Update& update);
  void find_loads(double time, std::span<const double> q);
  void predict(const Motion& motion, double dt, Range range);
  double correct(Motion& motion, double dt, Range range) const;
  double correct_supports(Motion& motion, double dt) const;
  double correct_layer(Motion& motion, double dt) const;

  const Problem& problem_;
  double nominal_step_;
  MasslessLayer layer_;
  Vector inverse_mass_;       // [1/kg] (dofs) zero where the motion is prescribed, or no mass
  std::vector<double> next_;  // (dofs) q at the step's end
  Vector answer_;             // [N] (dofs) to a jump
  Vector loads_;              // [N] (dofs) at the step's end; empty without loads
  std::vector<double> work_;  // [J] (ranges) external
  ModelResponse response_;
};

}  // namespace abut
