#include "coordinator/attempt.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coordinator/coupling/steps.hpp"

namespace abut {

namespace {

/// Residuals up to this are near, when as many sweeps as usual have been made.
constexpr double near = 1.0e-5;
/// Where contact presses both sides of a joint, these do not follow its forces, and what they miss
/// each other by stays, whatever the sweeps: it is of one window, and closes as one side parts.
/// Stiff blocks that rest on each other without joints make energy of less.
constexpr double near_beside_ties = 5.0e-2;

}  // namespace

bool Attempt::converged() const { return std::ranges::all_of(reports, &SchwarzReport::converged); }

bool Attempt::nearly() const {
  return !failed && std::ranges::all_of(reports, [](const SchwarzReport& r) {
    return r.converged || (r.contradiction.empty() && r.iterations >= Steps::usual_most &&
                           r.residual.largest() <= (r.beside_ties ? near_beside_ties : near));
  });
}

FieldResiduals Attempt::missed() const {
  FieldResiduals residual;
  for (const SchwarzReport& r : reports)
    if (!r.converged) residual.include(r.residual);
  return residual;
}

std::string Attempt::trouble(double tolerance) const {
  if (failed) return fmt::format("{}: {}", to_string(failed->cause), failed->detail);
  const FieldResiduals residual = missed();
  int iterations = 0;
  for (const SchwarzReport& r : reports)
    if (!r.converged) iterations = r.iterations;
  const bool forces = residual.force == residual.largest() && residual.displacement <= tolerance;
  return fmt::format(
      "Schwarz iteration not converged after {} iterations: residual{} {:.3g}, tolerance {:.3g}",
      iterations, forces ? " of forces" : "", residual.largest(), tolerance);
}

}  // namespace abut
