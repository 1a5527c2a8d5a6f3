#include "subdomain_solver/solve/newton.hpp"

#include <cmath>

namespace abut {

namespace {

constexpr int most_halvings = 8;
/// Residuals of path-dependent materials may rise a little before they fall.
constexpr double allowed_growth = 2.0;

}  // namespace

NewtonReport solve_newton(Equations& equations, Vector& x, const NewtonOptions& options,
                          NewtonVectors& vectors) {
  NewtonReport report;
  auto& [r, dx, trial] = vectors;
  double scale = 0.0;
  if (!equations.residual(x, r, scale)) {
    report.end = NewtonReport::End::inadmissible;
    return report;
  }
  for (;; ++report.iterations) {
    const double size = r.norm();
    report.residual = scale > 0.0 ? size / scale : size;
    if (!std::isfinite(size)) break;
    if (size <= options.tolerance * scale) {
      report.end = NewtonReport::End::converged;
      return report;
    }
    if (report.iterations >= options.max_iterations) break;
    if (!equations.correct(r, dx)) {
      report.end = NewtonReport::End::singular;
      return report;
    }
    double part = 1.0, trial_scale = 0.0;
    bool admissible = false;
    for (int halving = 0; halving <= most_halvings; ++halving, part *= 0.5) {
      trial = x + part * dx;
      admissible = equations.residual(trial, r, trial_scale);
      if (admissible && r.norm() <= allowed_growth * size) break;
    }
    if (!admissible) {
      report.end = NewtonReport::End::inadmissible;
      return report;
    }
    x = trial;
    scale = trial_scale;
    // What is left is the round-off of r itself: no iteration makes it smaller.
    if (dx.lpNorm<Eigen::Infinity>() <= equations.smallest_step(x)) {
      report.end = NewtonReport::End::converged;
      ++report.iterations;
      return report;
    }
  }
  return report;
}

}  // namespace abut
