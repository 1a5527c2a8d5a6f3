// How and why a run ends, and what its end says of its bodies.

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/index.hpp"
#include "base/without_remedy.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/coupling/watch.hpp"
#include "coordinator/record/validity_notes.hpp"
#include "coordinator/settled_end.hpp"

namespace abut {

namespace {

/// Of what springs bore before a window, below which they let go of it in the end.
constexpr double let_go = 0.95;

}  // namespace

/// Springs of bodies that lean on something slender let go of little in a window: more short ones
/// come before the end, unless they let go of nothing. before: what they bore before the window.
Controller::Judgement Controller::judge_springs(const TimeWindow& window, double before) {
  const std::optional<double> end = settled_further(window, scene_.time.end);
  if (!end) return {};
  const double after = borne_of_allowed(bodies_);
  if (after <= 1.0 || after > let_go * before) return {};
  return {Judgement::Verdict::cut, *end, {}};
}

/// By the measures that it has told last.
void Controller::judge(int body) {
  const Description& about = bodies_.describe(body);
  for (const std::string& note : validity_notes(about, end_.body_measures.back()))
    narrator_.warning(clock_.time(), about.name, note);
  const std::string why = unheld(about, end_.body_measures.back());
  if (end_.status == "completed" && !why.empty()) fail(clock_.time(), why);
}

/// [J] by body, by its last record.
std::vector<double> Controller::kinetic_energies() const {
  std::vector<double> all;
  for (const Response& response : bodies_.responses())
    all.push_back(response.records.empty() ? 0.0 : response.records.back().energy.kinetic);
  return all;
}

/// What makes velocities of tied surfaces one [M.122] is none of the bodies' steps.
void Controller::tell_lost_at_start() {
  const double lost = std::accumulate(start_lost_.begin(), start_lost_.end(), 0.0);
  if (!(lost > 0.01 * guard_.most())) return;
  narrator_.warning(
      clock_.time(), "ties",
      fmt::format(
          "velocities of tied surfaces differ at the start, and making them one took {:.3g} "
          "J, {:.2g} % of what there was in motion, as a blow does after which bodies "
          "stick; give both sides the same velocities where they are tied",
          lost, 100.0 * lost / guard_.most()));
}

/// What bodies have lost in steps of their own, and contact between them, beside friction and what
/// the passive way has given up.
void Controller::tell_losses() {
  if (passive_.statics()) return;
  const std::vector<double>& taken = passive_.ledger().taken;
  const double notable = 0.05 * guard_.most();  // by which motion is a fortieth slower
  double lost = -guard_.change() - passive_.ledger().given_up();
  for (const Joint& joint : joints_) lost -= dissipated(joint);
  int coarsest = 0;
  for (int b = 0; b < bodies_.count(); ++b) {
    const Description& body = bodies_.describe(b);
    if (!std::isfinite(body.mass)) continue;  // what drives it works through it
    const double passive = index(b) < taken.size() ? taken[index(b)] : 0.0;
    const double at_start = index(b) < start_lost_.size() ? start_lost_[index(b)] : 0.0;
    const double own = -guard_.unexplained(b) - passive - at_start;
    lost -= own + at_start;
    if (body.step > bodies_.describe(coarsest).step) coarsest = b;
    if (!(own > notable)) continue;
    narrator_.warning(
        clock_.time(), body.name,
        fmt::format("steps of body '{}' took {:.3g} J, {:.2g} % of the most there was in motion, "
                    "without contact: its scheme damps, or does so where it strains or turns much "
                    "in a step; smaller steps take less",
                    body.name, own, 100.0 * own / guard_.most()));
  }
  if (!(lost > notable) || joints_.empty()) return;
  const std::string& name = bodies_.describe(coarsest).name;
  const bool tied = std::ranges::any_of(joints_, &Joint::tied);
  narrator_.warning(
      clock_.time(), name,
      fmt::format(
          "{} took {:.3g} J, {:.2g} % of the most there was in motion, "
          "beside friction: {} short against the steps, of which those of "
          "'{}' are the longest; smaller ones take less",
          tied ? "contact, ties of unlike steps, and rims of ties that may touch," : "contact",
          lost, 100.0 * lost / guard_.most(), tied ? "what they pass on is" : "it is", name));
}

void Controller::look_for_overlaps() {
  const bool all_touch = scene_.everything() != nullptr;
  for (const Overlap& overlap : overlaps_.look(bodies_, joints_, clock_.time(), all_touch)) {
    narrator_.overlap(overlap, joints_, all_touch);
    const auto before = std::ranges::find_if(end_.overlaps, [&overlap](const Overlap& told) {
      return std::ranges::equal(told.body, overlap.body);
    });
    if (before == end_.overlaps.end())
      end_.overlaps.push_back(overlap);
    else
      *before = overlap;
  }
}

void Controller::look_for_passed() {
  for (const Joint& joint : joints_) {
    if (joint.contact.force_scale > 0.0 || !joint.watch->passed(joint, bodies_)) continue;
    end_.never_met.push_back(joint.name);
    narrator_.never_met(joint.name, clock_.time());
  }
}

RunEnd Controller::finish(double wall_seconds) {
  const SpanScope span(bodies_.spans(), "end");
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
  tell_losses();
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
