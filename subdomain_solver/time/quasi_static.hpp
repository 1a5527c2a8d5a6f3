#pragma once

#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/newton.hpp"
#include "subdomain_solver/time/contact_turns.hpp"
#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Equilibrium r(q) = f(t) at the end of every step; loads and supports change with time, inertia
/// is left out. A step that Newton's method does not solve is halved, down to a smallest part, and
/// parts grow again after quick solves. A step allocates nothing itself once its buffers have
/// grown.
class QuasiStatic final : public Integrator {
 public:
  struct Options {
    NewtonOptions newton;
    int most_halvings = 8;  // the smallest part is step / 2^n
  };

  QuasiStatic(const Problem& problem, const Options& options, std::unique_ptr<LinearSolver> solver);

  [[nodiscard]] std::optional<Failed> begin(Motion& motion, double time) override;
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double time, double dt) override;
  void acceleration(const Motion& motion, double, double, Vector& out) const override {
    out.setZero(static_cast<Eigen::Index>(motion.q.size()));
  }
  bool has_inertia() const override { return false; }
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

  const Problem& problem_;
  Options options_;
  std::unique_ptr<LinearSolver> solver_;
  FreeCoordinates free_;
  ContactTurns contact_;
  SparseMatrix matrix_;  // of the free coordinates
  bool factored_ = false;
  Buffers buffers_;
  Motion before_;  // the step
};

}  // namespace abut
