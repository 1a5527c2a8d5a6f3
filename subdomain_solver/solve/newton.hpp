#pragma once

#include "subdomain_solver/model.hpp"

namespace abut {

struct NewtonOptions {
  double tolerance = 1.0e-9;  // of the residual, relative to the largest force that it balances
  int max_iterations = 25;
};

/// What a residual is measured by.
struct ResidualUnits {
  double forces = 0.0;    // size of the forces whose balance it is
  double roundoff = 0.0;  // of them: a balance below it cannot be improved
};

/// Nonlinear equations R(x) = 0 as Newton's method sees them.
class Equations {
 public:
  virtual ~Equations() = default;
  /// R at x, and its units. False: x is inadmissible.
  [[nodiscard]] virtual bool residual(const Vector& x, Vector& r, ResidualUnits& units) = 0;
  /// dx = -(dR/dx)^-1 r at the x of the last residual. False: the matrix is singular.
  [[nodiscard]] virtual bool correct(const Vector& r, Vector& dx) = 0;
  /// Step in x below which nothing changes but round-off.
  virtual double smallest_step(const Vector& x) const = 0;
};

struct NewtonReport {
  enum class End { converged, inadmissible, singular, not_converged } end = End::not_converged;
  int iterations = 0;
  double residual = 0.0;  // relative to the forces, or to their roundoff over the tolerance
  bool converged() const { return end == End::converged; }
};

/// What Newton's method works with, kept from solve to solve.
struct NewtonVectors {
  Vector r, dx, trial;
};

/// Newton's method with a line search that halves: a step is shortened while it leads to an
/// inadmissible x or to a larger residual. x holds the first guess, and the answer when converged.
/// A first guess within the tolerance is corrected once all the same unless its residual is
/// round-off. Where corrections no longer make a residual smaller that
/// is near its roundoff, x is as good as its numbers.
NewtonReport solve_newton(Equations& equations, Vector& x, const NewtonOptions& options,
                          NewtonVectors& vectors);

}  // namespace abut
