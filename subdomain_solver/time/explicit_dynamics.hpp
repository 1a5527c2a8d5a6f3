#pragma once

#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Central differences on any model with lumped mass, in the form that has positions, velocities
/// and accelerations at the same times (velocity Verlet) [M.48]. Conserves momentum exactly and,
/// below the stable step, an energy that differs from 1/2 v M v + stored by terms of second order
/// in dt.
class ExplicitDynamics final : public Integrator {
 public:
  explicit ExplicitDynamics(const Problem& problem);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  double kinetic(const Motion& motion) const override;

 private:
  void accelerate(double time, const ModelResponse& response, Motion& motion) const;

  const Problem& problem_;
  Vector mass_;
  ModelResponse response_;
};

}  // namespace abut
