// How and why a run ends, and what its end says of its bodies.

#include <fmt/format.h>

#include "base/without_remedy.hpp"
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

RunEnd Controller::finish(double wall_seconds) {
  end_.time = clock_.time();
  end_.windows = clock_.windows();
  end_.wall_seconds = wall_seconds;
  end_.exchanges = bodies_.exchanges();
  end_.compute_seconds = bodies_.compute_seconds();
  end_.overhead_median_seconds = bodies_.overhead_median();
  std::uint64_t hash = 0;
  for (int b = 0; b < bodies_.count(); ++b) {
    end_.body_hashes.push_back(bodies_[b].state_hash());
    hash = hash_combine(hash, end_.body_hashes.back());
  }
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, Archive::Form::bare);
  state(archive);
  end_.state_hash = hash_combine(hash, hash_bytes(bytes));
  if (end_.status != "failed") {
    look_for_overlaps();
    look_for_passed();
  }
  for (int b = 0; b < bodies_.count(); ++b) {
    end_.body_measures.push_back(bodies_[b].measure());
    judge(b);
  }
  end_.given_up = given_up();
  narrator_.given_up(end_);
  narrator_.end(end_);
  return end_;
}

/// The bodies are in the middle of a solve, or gone: there is no state to hash.
void Controller::give_up(const std::exception& error, bool interrupted, double wall_seconds) {
  end_.status = interrupted ? "interrupted" : "failed";  // a wait that the user ends is no failure
  if (!interrupted) {
    end_.reason = narrator_.in_units(without_remedy(error));
    narrator_.thrown(clock_.time(), end_.reason);
  }
  end_.compute_seconds = bodies_.compute_seconds();
  end_.wall_seconds = wall_seconds;
  end_.exchanges = bodies_.exchanges();
  end_.windows = clock_.windows();
  end_.time = clock_.time();
  end_.given_up = given_up();
  narrator_.end_after_error(end_);
}

}  // namespace abut
