// Why a run ends, and what its end says of its bodies.

#include <fmt/format.h>

#include "coordinator/controller.hpp"
#include "coordinator/record/validity_notes.hpp"

namespace abut {

std::string Controller::Attempt::trouble(double tolerance) const {
  if (failed) return fmt::format("{}: {}", to_string(failed->cause), failed->detail);
  FieldResiduals residual;
  int iterations = 0;
  for (const SchwarzReport& r : reports) {
    if (r.converged) continue;
    residual.include(r.residual);
    iterations = r.iterations;
  }
  const bool forces = residual.force == residual.largest() && residual.displacement <= tolerance;
  return fmt::format(
      "Schwarz iteration not converged after {} iterations: residual{} {:.3g}, tolerance {:.3g}",
      iterations, forces ? " of forces" : "", residual.largest(), tolerance);
}

/// By the measures that it has told last.
void Controller::judge(int body) {
  const Description& about = bodies_.describe(body);
  for (const std::string& note : validity_notes(about, end_.body_measures.back()))
    narrator_.warning(clock_.time(), about.name, note);
  const std::string why = unheld(about, end_.body_measures.back());
  if (end_.status == "completed" && !why.empty()) fail(clock_.time(), why);
}

}  // namespace abut
