#include "subdomain_solver/solve/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.hpp"

namespace abut {

namespace {

constexpr int most_step_halvings = 8;
/// Residuals of path-dependent materials may rise a little before they fall.
constexpr double allowed_growth = 2.0;
/// Roundoffs are told by the norms of their parts; what solving adds grows with the condition.
constexpr double near_roundoff = 1.0e3;
constexpr int most_idle = 3;

/// Corrections in a row that have not halved the residual.
class Stagnation {
 public:
  bool see(double size, double roundoff) {
    idle_ = size > 0.5 * least_ ? idle_ + 1 : 0;
    least_ = std::min(least_, size);
    return idle_ >= most_idle && size <= near_roundoff * roundoff;
  }

 private:
  double least_ = std::numeric_limits<double>::infinity();
  int idle_ = 0;
};

/// A step along the correction that leads to an admissible x and to no much larger residual: part
/// of it, halved until it does. False: none is admissible.
bool advance(Equations& equations, double size, Vector& x, ResidualUnits& units,
             NewtonVectors& vectors) {
  auto& [r, dx, trial] = vectors;
  double part = 1.0;
  bool admissible = false;
  for (int halving = 0; halving <= most_step_halvings; ++halving, part *= 0.5) {
    trial = x + part * dx;
    admissible = equations.residual(trial, r, units);
    if (admissible && r.norm() <= allowed_growth * size) break;
  }
  if (admissible) x = trial;
  return admissible;
}

/// One correction of an x that is good enough, kept where it makes the residual smaller: within the
/// tolerance alone its error would go from step to step.
void polish(Equations& equations, double size, Vector& x, ResidualUnits& units,
            NewtonVectors& vectors) {
  auto& [r, dx, trial] = vectors;
  if (!equations.correct(r, dx)) return;
  trial = x + dx;
  if (equations.residual(trial, r, units) && r.norm() <= size) {
    x = trial;
    return;
  }
  const bool admissible = equations.residual(x, r, units);
  ABUT_ASSERT(admissible);  // as before
}

}  // namespace

NewtonReport solve_newton(Equations& equations, Vector& x, const NewtonOptions& options,
                          NewtonVectors& vectors) {
  using End = NewtonReport::End;
  NewtonReport report;
  auto& [r, dx, trial] = vectors;
  ResidualUnits units;
  Stagnation stagnation;
  const auto ended = [&report](End end) {
    report.end = end;
    return report;
  };
  if (!equations.residual(x, r, units)) return ended(End::inadmissible);
  for (;; ++report.iterations) {
    const double size = r.norm();
    const double scale = std::max(units.forces, units.roundoff / options.tolerance);
    report.residual = scale > 0.0 ? size / scale : size;
    if (!std::isfinite(size)) break;
    if (size <= options.tolerance * scale) {
      if (report.iterations == 0 && size > units.roundoff)
        polish(equations, size, x, units, vectors);
      return ended(End::converged);
    }
    if (stagnation.see(size, units.roundoff)) return ended(End::converged);
    if (report.iterations >= options.max_iterations) break;
    if (!equations.correct(r, dx)) return ended(End::singular);
    if (!advance(equations, size, x, units, vectors)) return ended(End::inadmissible);
    // What is left is the round-off of r itself: no iteration makes it smaller.
    if (dx.lpNorm<Eigen::Infinity>() <= equations.smallest_step(x)) {
      ++report.iterations;
      return ended(End::converged);
    }
  }
  return report;
}

}  // namespace abut
