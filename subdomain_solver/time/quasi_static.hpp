#pragma once

#include "subdomain_solver/solve/loose_solver.hpp"
#include "subdomain_solver/solve/newton.hpp"
#include "subdomain_solver/time/contact_turns.hpp"
#include "subdomain_solver/time/integrator.hpp"
#include "subdomain_solver/time/stabilisation.hpp"

namespace abut {

/// Equilibrium r(q) = f(t) at the end of every step; loads and supports change with time, inertia
/// is left out. A step that Newton's method does not solve is halved, down to a smallest part, and
/// parts grow again after quick solves. A step allocates nothing itself once its buffers have
/// grown.
///
/// A body that its supports leave rigid motions is carried by them where it is told (carry_to), and
/// the rest of its balance is solved; what is left over of the forces along these motions is told
/// (unbalanced), for partners to make it nothing  [M.112]. Where contact alone holds them they are
/// stabilised instead  [M.143].
class QuasiStatic final : public Integrator {
 public:
  struct Options {
    NewtonOptions newton;
    int most_halvings = 8;  // the smallest part is step / 2^n
    // (dofs, k) rigid motions that its supports leave it, 0 there; columns of length sqrt(n) at
    // right angles, n: free coordinates
    Eigen::MatrixXd loose = {};
    double stabilised = 0.0;  // [N/m] stiffness that holds the loose motions; 0: they are carried
    double at_most = 0.0;     // share of all that presses on the body, that it may bear at the end
    bool joined = false;      // the first equilibrium is that of the first step, with its partners
  };

  QuasiStatic(const Problem& problem, const Options& options, std::unique_ptr<LinearSolver> solver);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  void acceleration(const Motion& motion, double, double, const Vector&,
                    Vector& out) const override {
    out.setZero(static_cast<Eigen::Index>(motion.q.size()));
  }

  /// [m] (k) where its loose motions are at the end of the next step; empty: where they are.
  void carry_to(std::span<const double> place);
  /// What holds the loose motions; null: nothing has to.
  const Stabilisation* stabilisation() const { return stabilisation_ ? &*stabilisation_ : nullptr; }
  /// [N] (dofs) with which it held the body at the end of the last step.
  void stabilising_force(const Motion& motion, Vector& out) const;
  /// Of a passive step: forces [N] (dofs) that held a body that is stabilised, how far it went [m]
  /// (dofs), and what acted on it [N] (dofs). Returns the part of the forces on the body that this
  /// bore, over what is allowed at the end of a run; 0 of one that is not stabilised.
  double tell_held(const Vector& force, std::span<const double> gone, const Vector& acting,
                   Motion& motion);
  /// [N] (k) of what acts, along the loose motions, in the last step; of what is stabilised
  /// nothing.
  std::span<const double> unbalanced() const {
    return {unbalanced_.data(), index(unbalanced_.size())};
  }
  /// [m] (dofs) by which a force [N] and places [m] (k) of the loose motions would move the body,
  /// by the tangent of the last balance, and what they would leave over [N] (k). False: it has
  /// none.
  [[nodiscard]] bool give(const Motion& motion, double time, const Vector& force,
                          const Vector& place, Vector& moved, Vector& left);
  double kinetic(const Motion&) const override { return 0.0; }

 private:
  class Balance;

  struct Buffers {  // of one part of a step at a time
    Vector q, x, dx, moved, between, sum, pull, external;
    double scale = 0.0;  // [N] of the balance
    ModelResponse response, tangent, on_the_way;
    NewtonVectors newton;
  };

  [[nodiscard]] NewtonReport part(Motion& motion, double end, Contact* contact);
  [[nodiscard]] std::optional<Failed> stand(Motion& motion, double time);
  std::unique_ptr<LinearSolver> with_motions(std::unique_ptr<LinearSolver> solver);
  Vector place_of(const Motion& motion) const;
  bool carries() const { return loose_.cols() > 0; }
  bool holds_what_falls();
  void settle(Motion& motion);

  const Problem& problem_;
  Options options_;
  FreeCoordinates free_;
  std::optional<Stabilisation> stabilisation_;
  Eigen::MatrixXd loose_;                // of the free coordinates: those that are carried
  Vector carried_, place_, unbalanced_;  // to where in the step, and in a part of it
  LooseSolver* loose_solver_ = nullptr;  // the solver, where there are loose motions
  std::unique_ptr<LinearSolver> solver_;
  ContactTurns contact_;
  SparseMatrix matrix_;  // of the free coordinates
  bool factored_ = false;
  int held_up_ = 0;  // times that springs have been stiffened in this step
  Buffers buffers_;
  Motion before_;  // the step
};

}  // namespace abut
