#pragma once

#include "subdomain_solver/rigid/rigid_model.hpp"
#include "subdomain_solver/time/inertia.hpp"
#include "subdomain_solver/time/integrator.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

/// Kick - free motion - kick [M.61]: second order under loads, exact without them, symmetric in
/// time. Loads are those at both ends of the step, so that the impulse that a body takes over a
/// window is that of the forces imposed in it.
class RigidMotion final : public Integrator, private Inertia {
 public:
  /// The problem's model is `body`.
  RigidMotion(const Problem& problem, const RigidModel& body)
      : Integrator({.inertia = this}), problem_(problem), body_(body) {}
  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  void acceleration(const Motion& motion, double, double, const Vector&,
                    Vector& out) const override {
    out = view(motion.a);
  }
  double kinetic(const Motion& motion) const override { return body_.kinetic(motion.q, motion.v); }

 private:
  std::optional<Failed> jump(Motion&, double, const Vector&) override { return std::nullopt; }
  void strike(Motion& motion, const Vector& impulse) override {
    view(motion.v) += impulse.cwiseQuotient(body_.lumped_mass());
  }
  void load(Motion& motion, double time) const;
  void kick(Motion& motion, double time);

  const Problem& problem_;
  const RigidModel& body_;
  Motion next_;
  Vector force_;  // [N]
};

}  // namespace abut
