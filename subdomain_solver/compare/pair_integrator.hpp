#pragma once

#include <vector>

#include "base/archive.hpp"
#include "subdomain_solver/compare/bar_pair.hpp"
#include "subdomain_solver/solve/tridiagonal.hpp"

namespace abut {

/// Everything about a pair of bars that changes during a step.
struct PairState {
  std::vector<double> u, v, a;  // [m] [m/s] [m/s^2] by node, of one time
  double force = 0.0;           // [N] contact force at that time, compressive

  void state(Archive& archive);
};

/// Law of the contact between the tips.
struct PairContact {
  double penalty = 0.0;  // [N/m] spring that resists the overlap; 0: a multiplier keeps them apart

  bool multiplier() const { return penalty == 0.0; }
  double compliance() const { return multiplier() ? 0.0 : 1.0 / penalty; }          // [m/N]
  double stored(double force) const { return 0.5 * compliance() * force * force; }  // [J]
};

/// Advances two bars and the contact between them as one system, by whole substeps: the
/// conventional contact methods.
class PairIntegrator {
 public:
  PairIntegrator(BarPair& pair, const PairContact& contact) : pair_(pair), contact_(contact) {}
  virtual ~PairIntegrator() = default;
  PairIntegrator(const PairIntegrator&) = delete;
  PairIntegrator& operator=(const PairIntegrator&) = delete;

  /// False: an element has no length left.
  [[nodiscard]] virtual bool substep(PairState& state, double dt) = 0;
  /// Kinetic energy of a bar in the form that the scheme conserves [J].
  virtual double kinetic(const PairState& state, int member) const = 0;
  double contact_energy(const PairState& state) const { return contact_.stored(state.force); }

 protected:
  BarPair& pair_;
  PairContact contact_;
};

/// Central difference with lumped mass. A penalty force is that of the overlap at the substep's
/// begin; a multiplier at the substep's begin is chosen such that its end shows no overlap (forward
/// increment: Carpenter, Taylor and Katona 1991).
class ExplicitPair final : public PairIntegrator {
 public:
  /// `state` is completed with the contact force and the accelerations at the start.
  ExplicitPair(BarPair& pair, const PairContact& contact, double step, PairState& state);

  bool substep(PairState& state, double dt) override;
  double kinetic(const PairState& state, int member) const override;

 private:
  double contact_force(const PairState& state, double kick, double dt) const;
  void accelerate(PairState& state, double kick, double dt);

  double step_;
  std::vector<double> force_;
};

/// Weights of an implicit step:
///   u(n+1) = u + dt v + dt^2 (past a + beta a(n+1))
///   v(n+1) = v + dt ((1 - gamma) a + gamma a(n+1))
struct StepWeights {
  double past = 0.25, beta = 0.25, gamma = 0.5;

  static StepWeights newmark(double beta, double gamma) { return {0.5 - beta, beta, gamma}; }
  static StepWeights backward_euler() { return {0.0, 1.0, 1.0}; }
};

/// Implicit steps: balance and contact law hold at the substep's end. There is one contact
/// condition, so the active set is found exactly: the force is that which the closed pair needs, or
/// none when that would pull.
class ImplicitPair final : public PairIntegrator {
 public:
  ImplicitPair(BarPair& pair, const PairContact& contact, const StepWeights& weights);

  bool substep(PairState& state, double dt) override;
  double kinetic(const PairState& state, int member) const override;

 private:
  void factor(double dt);

  StepWeights w_;
  double factored_dt_ = 0.0;
  TriDiagonal matrix_;
  // [m/N] motion of the nodes under a unit force that presses on the tips
  std::vector<double> column_;
  // increments of a substep: solving for displacements would lose momentum to round-off
  std::vector<double> predicted_, increment_, work_;
};

}  // namespace abut
