#pragma once

#include "subdomain_solver/model.hpp"

namespace abut {

struct NewtonOptions {
  double tolerance = 1.0e-9;  // of the residual, relative to the largest force that it balances
  int max_iterations = 25;
};

/// Nonlinear equations R(x) = 0 as Newton's method sees them.
class Equations {
 public:
  virtual ~Equations() = default;
  /// R at x, and the size of the forces whose balance it is. False: x is inadmissible.
  [[nodiscard]] virtual bool residual(const Vector& x, Vector& r, double& scale) = 0;
  /// dx = -(dR/dx)^-1 r at the x of the last residual. False: the matrix is singular.
  [[nodiscard]] virtual bool correct(const Vector& r, Vector& dx) = 0;
  /// Step in x below which nothing changes but round-off.
  virtual double smallest_step(const Vector& x) const = 0;
};

struct NewtonReport {
  enum class End { converged, inadmissible, singular, not_converged } end = End::not_converged;
  int iterations = 0;
  double residual = 0.0;  // relative to the scale
  bool converged() const { return end == End::converged; }
};

/// What Newton's method works with, kept from solve to solve.
struct NewtonVectors {
  Vector r, dx, trial;
};

/// Newton's method with a line search that halves: a step is shortened while it leads to an
/// inadmissible x or to a larger residual. x holds the first guess, and the answer when converged.
NewtonReport solve_newton(Equations& equations, Vector& x, const NewtonOptions& options,
                          NewtonVectors& vectors);

}  // namespace abut
