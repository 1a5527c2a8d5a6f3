#pragma once

#include "subdomain_solver/solve/loose_solver.hpp"
#include "subdomain_solver/solve/newton.hpp"
#include "subdomain_solver/time/contact_turns.hpp"
#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Equilibrium r(q) = f(t) at the end of every step; loads and supports change with time, inertia
/// is left out. A step that Newton's method does not solve is halved, down to a smallest part, and
/// parts grow again after quick solves. A step allocates nothing itself once its buffers have
/// grown.
///
/// A body that its supports leave rigid motions is carried by them where it is told (carry_to), and
/// the rest of its balance is solved; what is left over of the forces along these motions is told
/// (unbalanced), for partners to make it nothing  [M.112].
class QuasiStatic final : public Integrator {
 public:
  struct Options {
    NewtonOptions newton;
    int most_halvings = 8;  // the smallest part is step / 2^n
    // (dofs, k) rigid motions that its supports leave it, 0 there; columns of length sqrt(n) at
    // right angles, n: free coordinates
    Eigen::MatrixXd loose = {};
    bool joined = false;  // the first equilibrium is that of the first step, with its partners
  };

  QuasiStatic(const Problem& problem, const Options& options, std::unique_ptr<LinearSolver> solver);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  void acceleration(const Motion& motion, double, double, Vector& out) const override {
    out.setZero(static_cast<Eigen::Index>(motion.q.size()));
  }

  /// [m] (k) where its loose motions are at the end of the next step; empty: where they are.
  void carry_to(std::span<const double> place);
  /// [N] (k) of what acts, along the loose motions, in the last step.
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

  const Problem& problem_;
  Options options_;
  FreeCoordinates free_;
  Eigen::MatrixXd loose_;                // of the free coordinates
  Vector carried_, place_, unbalanced_;  // to where in the step, and in a part of it
  LooseSolver* loose_solver_ = nullptr;  // the solver, where there are loose motions
  std::unique_ptr<LinearSolver> solver_;
  ContactTurns contact_;
  SparseMatrix matrix_;  // of the free coordinates
  bool factored_ = false;
  Buffers buffers_;
  Motion before_;  // the step
};

}  // namespace abut
