#include "tests/random/verdict.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "tests/random/draw.hpp"

namespace abut {

namespace {

/// [s] of the processor, a hundred times what scenes take mostly.
constexpr double patience = 60.0;
/// Of the largest energy and momentum. Which node is pressed first, and where a body slides, turns
/// on roundings and on tolerances of the iteration; what differs by more was decided by the order,
/// the place or the units.
constexpr double like = 0.05;

/// Starts that differ by such a part of every velocity, so many of them, tell how far a scene's
/// own end can be foretold: where bodies bounce on, differences grow by a factor at each impact.
constexpr double nudge = 1e-9;
constexpr int nudges = 4;
/// The largest of so few differences may be as many times smaller than another one.
constexpr double as_much = 2.0;

RandomScene nudged(RandomScene scene, int k) {
  const auto number = static_cast<std::uint64_t>(k);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    RandomBody& body = scene.bodies[b];
    // Parts of one body start as one.
    const std::uint64_t one = body.whole < 0 ? b + 1000 : static_cast<std::uint64_t>(body.whole);
    const double factor = 1.0 + nudge * Draw(one * nudges + number).uniform(-1.0, 1.0);
    body.velocity *= factor;
    body.spin *= factor;
  }
  return scene;
}

View view_of(Again again, const RandomScene& scene) {
  View view;
  if (again == Again::fields) view.fields_every = 3;
  view.bodies_reversed = again == Again::order || again == Again::bodies;
  view.interfaces_reversed = again == Again::order || again == Again::interfaces;
  if (again == Again::turned) {
    const Eigen::Vector3d axis = scene.dim == 2 ? Eigen::Vector3d::UnitZ().eval()
                                                : Eigen::Vector3d(1.0, 2.0, 3.0).normalized();
    view.turn = Eigen::AngleAxisd(37.0 * std::numbers::pi / 180.0, axis).toRotationMatrix();
  }
  if (again == Again::moved) view.shift = Eigen::Vector3d(100.0, -30.0, scene.dim == 3 ? 7.0 : 0.0);
  if (again == Again::units) {  // mm, t, s
    view.length = 1e3;
    view.mass = 1e-3;
  }
  return view;
}

Again way_of(std::uint64_t seed) {
  if (seed < first_of_all_kinds) return static_cast<Again>(seed % 7);
  constexpr Again all[] = {Again::fields, Again::processes, Again::bodies, Again::interfaces,
                           Again::finder, Again::turned,    Again::moved,  Again::units,
                           Again::fast,   Again::resumed};
  return all[seed % std::size(all)];
}

Again again_of(const RandomScene& scene) {
  const Again again = way_of(scene.seed);
  const bool bars_turn = scene.dim == 1 && again == Again::turned;
  return (again == Again::finder && scene.everything) || bars_turn ? Again::order : again;
}

Where where_of(Again again) {
  return again == Again::processes ? Where::processes
         : again == Again::resumed ? Where::resumed
                                   : Where::here;
}

/// Ways that must not change a bit.
bool same_bits(Again again) {
  return again == Again::fields || again == Again::processes || again == Again::resumed;
}

/// Some bodies take forces only, and the scene that names them is rightly refused.
bool cannot_find(const TrialRun& run) {
  return run.status == "refused" &&
         run.reason.find("cannot be the kinematic side") != run.reason.npos;
}

/// Of the ends of two runs, over the most that there was.
double difference_of(const TrialRun& a, const TrialRun& b, const View& view) {
  const double joule = view.mass * view.length * view.length, pulse = view.mass * view.length;
  double out = std::abs(a.energy - b.energy / joule) / std::max(a.scale, 1e-300);
  const std::size_t count = std::min(a.momenta.size(), b.momenta.size());
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3d& theirs = b.momenta[view.bodies_reversed ? count - 1 - k : k];
    const double miss = (view.turn * a.momenta[k] - theirs / pulse).norm();
    out = std::max(out, miss / std::max(a.impulse, 1e-300));
  }
  return out;
}

/// Of the first run, against starts that are nearly the same. One that fails tells nothing.
double sensitivity_of(const RandomScene& scene, const Verdict& verdict, const View& view,
                      const std::filesystem::path& folder) {
  double most = 0.0;
  for (int k = 0; k < nudges; ++k) {
    nudged(scene, k).write(folder, view);
    const TrialRun near = try_run(folder, patience);
    if (!near.trouble(scene.free(), scene.turns()).empty()) continue;
    most = std::max(most, difference_of(verdict.run, near, View{}));
  }
  return most;
}

const char* space_of(int dim) { return dim == 1 ? "of bars" : dim == 2 ? "planar" : "in space"; }

}  // namespace

const char* to_string(Again again) {
  const char* const names[] = {"fields", "order",     "finder", "turned",     "moved",  "units",
                               "fast",   "processes", "bodies", "interfaces", "resumed"};
  return names[static_cast<int>(again)];
}

RandomScene scene_of(std::uint64_t seed) {
  return random_scene(seed, way_of(seed) == Again::fast ? 1000.0 : 0.0);
}

Verdict judge(const RandomScene& scene, const std::filesystem::path& folder) {
  Verdict verdict;
  verdict.again = again_of(scene);
  View first;
  if (verdict.again == Again::finder) first.finder = 0;
  scene.write(folder, first);
  verdict.run = try_run(folder, patience);
  if (verdict.again == Again::finder && cannot_find(verdict.run)) {
    verdict.again = Again::order;
    first.finder = -1;
    scene.write(folder, first);
    verdict.run = try_run(folder, patience);
  }
  verdict.view = first;
  verdict.trouble = verdict.run.trouble(scene.free(), scene.turns());
  if (!verdict.trouble.empty() || verdict.again == Again::fast) return verdict;
  View view = view_of(verdict.again, scene);
  if (verdict.again == Again::finder) view.finder = 1;
  scene.write(folder, view);
  verdict.other = try_run(folder, patience, where_of(verdict.again));
  if (verdict.again == Again::finder && cannot_find(verdict.other)) verdict.other = verdict.run;
  const std::string trouble = verdict.other.trouble(scene.free(), scene.turns());
  verdict.difference = difference_of(verdict.run, verdict.other, view);
  if (!trouble.empty()) {
    verdict.trouble = fmt::format("{}: {}", to_string(verdict.again), trouble);
  } else if (same_bits(verdict.again) && verdict.run.hashes != verdict.other.hashes) {
    verdict.trouble = fmt::format("{}: bits differ", to_string(verdict.again));
  } else if (verdict.difference > like) {
    verdict.sensitivity = sensitivity_of(scene, verdict, first, folder);
    if (verdict.difference > as_much * verdict.sensitivity)
      verdict.trouble =
          fmt::format("{}: {:.2g} of the most differ, {:.2g} where velocities do by 1e-9",
                      to_string(verdict.again), verdict.difference, verdict.sensitivity);
  }
  if (!verdict.trouble.empty()) verdict.view = view;
  return verdict;
}

std::string line_of(const RandomScene& scene, const Verdict& verdict) {
  return fmt::format(
      "{:>6} {:11} passive {:3.0f} % grown {:8.1e} lost {:6.2f} % momentum {:7.1e} angular {:7.1e} "
      "{:6.2f} s "
      "{:6} {:7.1e} {}{}{}",
      scene.seed, verdict.run.status, 100.0 * verdict.run.passive, verdict.run.growth,
      100.0 * verdict.run.loss, scene.free() ? verdict.run.momentum : 0.0,
      scene.free() && scene.turns() ? verdict.run.angular : 0.0, verdict.run.seconds,
      to_string(verdict.again), verdict.difference,
      verdict.sensitivity > 0.0 ? fmt::format("(nudged {:.1e}) ", verdict.sensitivity) : "",
      scene.words(), verdict.trouble.empty() ? "" : "\n           " + verdict.trouble);
}

void Table::add(const RandomScene& scene, const Verdict& verdict) {
  Row& row = rows_[scene.dim];
  ++row.scenes;
  row.completed += verdict.run.completed() ? 1 : 0;
  row.sound += verdict.run.trouble(scene.free(), scene.turns()).empty() ? 1 : 0;
  row.passive += verdict.run.passive;
  row.growth = std::max(row.growth, verdict.run.growth);
  if (scene.free()) row.momentum = std::max(row.momentum, verdict.run.momentum);
  row.seconds += verdict.run.seconds;
  if (scene.conserves() && verdict.run.completed())
    row.losses.push_back(std::abs(verdict.run.loss));
  if (!verdict.run.trouble(scene.free(), scene.turns()).empty()) return;
  Pairs& pairs = again_[verdict.again];
  ++pairs.scenes;
  pairs.same += verdict.trouble.empty() ? 1 : 0;
  unforetold_ += verdict.trouble.empty() && verdict.difference > like ? 1 : 0;
  pairs.differences.push_back(verdict.difference);
}

/// Beside friction, plasticity and what is owed at the end, in percent of the most there was.
std::string Table::losses() const {
  std::string out =
      "\n| schemes that conserve | scenes | energy lost within .05 % | within .5 % | within 5 % | "
      "median |\n|---|---|---|---|---|---|\n";
  for (const auto& [dim, row] : rows_) {
    std::vector<double> losses = row.losses;
    if (losses.empty()) continue;
    std::ranges::sort(losses);
    const auto within = [&losses](double part) {
      return std::ranges::upper_bound(losses, part) - losses.begin();
    };
    out += fmt::format("| {} | {} | {} | {} | {} | {:.2g} % |\n", space_of(dim), losses.size(),
                       within(5.0e-4), within(5.0e-3), within(5.0e-2),
                       100.0 * losses[losses.size() / 2]);
  }
  return out;
}

std::string Table::text() const {
  std::string out =
      "| scenes | completed | all checks hold | windows passive | energy grown at most | momentum "
      "changed at most | processor time each |\n|---|---|---|---|---|---|---|\n";
  for (const auto& [dim, row] : rows_)
    out += fmt::format("| {} {} | {} | {} | {:.0f} % | {:.1e} | {:.1e} | {:.2f} s |\n", row.scenes,
                       space_of(dim), row.completed, row.sound, 100.0 * row.passive / row.scenes,
                       row.growth, row.momentum, row.seconds / row.scenes);
  out += losses();
  out +=
      "\n| run again | scenes | as good | difference, median | nine tenths below |\n"
      "|---|---|---|---|---|\n";
  for (auto [again, pairs] : again_) {
    std::ranges::sort(pairs.differences);
    const std::size_t n = pairs.differences.size();
    out += fmt::format("| {} | {} | {} | {:.1e} | {:.1e} |\n", to_string(again), pairs.scenes,
                       pairs.same, pairs.differences[n / 2], pairs.differences[n * 9 / 10]);
  }
  return out;
}

std::string Table::sentence() const {
  std::string out;
  for (const auto& [dim, row] : rows_)
    out += fmt::format("{}completed {} of {} {}", out.empty() ? "" : ", ", row.completed,
                       row.scenes, space_of(dim));
  int scenes = 0, same = 0;
  for (const auto& [again, pairs] : again_) {
    scenes += pairs.scenes;
    same += pairs.same;
  }
  out += fmt::format("; as good the second time {} of {}", same, scenes);
  if (unforetold_ > 0)
    out += fmt::format(", {} of them because starts that differ by 1e-9 end as far apart",
                       unforetold_);
  return out;
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace abut
