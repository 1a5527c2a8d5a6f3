#pragma once

#include "subdomain_solver/mass_form.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/matrix_sum.hpp"
#include "subdomain_solver/solve/newton.hpp"
#include "subdomain_solver/time/alpha_weights.hpp"
#include "subdomain_solver/time/contact_turns.hpp"
#include "subdomain_solver/time/foreseeing.hpp"
#include "subdomain_solver/time/inertia.hpp"
#include "subdomain_solver/time/integrator.hpp"
#include "subdomain_solver/time/massless_layer.hpp"
#include "subdomain_solver/time/momentum_lag.hpp"

namespace abut {

/// The generalised-alpha family on any model [M.46]: one Newton solve per step, one factorisation
/// per step length when the model is linear. Newmark 1/4, 1/2 conserves 1/2 v M v + stored energy
/// of linear models. Unknowns are accelerations, so that small steps lose nothing to round-off.
/// Coordinates without mass take part as they are; contact presses with a force of the step's end
/// [M.87]. A step allocates nothing itself once its buffers have grown.
///
/// Large bodies that are not linear are corrected by factors of an earlier state as long as these
/// lead on quickly. Which state that was is told by the motion (control): a body that is rewound,
/// or resumed, makes the same factors again.
class ImplicitDynamics final : public Integrator, private Inertia, private Foreseeing {
 public:
  /// What the scheme does with accelerations between steps, where forces may jump.
  enum class Accelerations {
    balanced,  // stored, and corrected by the balance of forces when a force jumps
    // Of the trapezoidal rule alone: the unknown of a step is the sum of the accelerations at both
    // ends, and none is stored, so that tie forces may jump from step to step [M.105].
    summed,
    // Stored, and not corrected when tie forces jump, which are constant in a step [M.105]: whoever
    // tells of a jump leaves these out. Of weights with gamma > 1/2 whose tied partners all step
    // alike: unlike pairs would gain energy.
    steady,
  };
  struct Options {
    AlphaWeights weights;
    MassForm mass = MassForm::consistent;
    NewtonOptions newton;
    Accelerations accelerations = Accelerations::balanced;
    // Free coordinates from which on factors serve for many steps, of laws without history. Below,
    // a factorisation is cheap.
    int keeps_from = 1000;
  };

  ImplicitDynamics(const Problem& problem, const Options& options,
                   std::unique_ptr<LinearSolver> solver);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  void acceleration(const Motion& motion, double time, double step, const Vector& external,
                    Vector& out) const override;
  double kinetic(const Motion& motion) const override;

 private:
  class Balance;
  Abilities abilities(const Problem& problem, const Options& options);
  std::optional<Failed> jump(Motion& motion, double time, const Vector& change) override;
  void strike(Motion& motion, const Vector& impulse) override;
  /// With the internal force that the tangent of the last balance tells: one solve  [M.119].
  bool foresee(const Motion& motion, double time, double dt, Foreseen& ahead) override;
  bool sums() const { return options_.accelerations == Accelerations::summed; }
  [[nodiscard]] NewtonReport solve(Balance& balance, const Motion& motion);

  struct Buffers {  // of one step at a time
    Vector q_start, v_start, q, v, a, x;
    Vector free;
    Vector past, external, external_start;  // [N]
    Vector inertia, inner, outer, sum, moved;
    ModelResponse response, tangent;
    double scale = 0.0;  // [N] of the balance
    NewtonVectors newton;
  };
  [[nodiscard]] bool hold_tangent(const Motion& motion, double time, double dt);

  bool keeps_factors() const;
  bool remember(const Motion& motion, double dt);
  [[nodiscard]] bool factor_remembered();
  [[nodiscard]] bool factor(const SparseMatrix& whole, double dt);

  struct MassBuffers {  // of what is asked for between steps
    Vector force, acceleration, free, rest, answer;
  };
  void times_mass(const Eigen::Ref<const Vector>& x, Vector& out) const;
  [[nodiscard]] bool solve_mass(const Vector& force, Vector& acceleration) const;

  const Problem& problem_;
  Options options_;
  std::unique_ptr<LinearSolver> solver_;
  FreeCoordinates free_, inertial_;  // those among them that have mass
  MasslessLayer layer_;
  ContactTurns contact_;
  SparseMatrix mass_;
  MomentumLag lag_;
  MatrixSum whole_;
  SparseMatrix matrix_;  // of the free coordinates
  double factored_dt_ = 0.0;
  const Model* factored_model_ = nullptr;
  std::vector<double> remembered_, factored_;  // step [s], coordinates [m]; empty: others
  Buffers buffers_;
  mutable MassBuffers of_mass_;
  mutable std::unique_ptr<LinearSolver> mass_solver_;  // of the free coordinates, when needed
};

}  // namespace abut
