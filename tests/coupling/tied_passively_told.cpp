// Goal: what joined bodies tell of the passive way, for every kind of body that can be joined, and
// how they come back from it. Oracles: impulses of a body's ports are what its momentum changes by;
// momentum and energy of all.

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::tied_passively_told_tests {
namespace {

/// What the ports of a body do to it in windows that are gone passively, and what joints tell.
struct Told : Observer {
  explicit Told(std::size_t of) : body(of) {}

  void on_window(const WindowReport& report) override {
    const Response& response = report.responses[body];
    const std::vector<double> now = response.records.back().momentum;
    const bool passive = report.window.length() > 0.0 && report.interfaces[0].iterations == 0;
    if (passive && !before.empty()) {
      ++windows;
      std::vector<double> impulse(now.size(), 0.0);
      for (const PortResponse& port : response.ports) add(port.trace, impulse);
      for (std::size_t i = 0; i < now.size(); ++i)
        missed = std::max(missed, std::abs(now[i] - before[i] - impulse[i]));
      joint_force = std::max(joint_force, report.interfaces[1].force);
      joint_missed = std::max(joint_missed, report.interfaces[1].missed);
    }
    before = now;
  }
  static void add(const Waveform& trace, std::vector<double>& impulse) {
    for (std::size_t i = 1; i < trace.time.size(); ++i)
      for (std::size_t k = 0; k < index(trace.width); ++k)
        impulse[k % impulse.size()] +=
            (trace.time[i] - trace.time[i - 1]) * trace.f[i * index(trace.width) + k];
  }

  std::size_t body;
  std::vector<double> before;  // [kg m/s]
  int windows = 0;
  double missed = 0.0;                           // [N s]
  double joint_force = 0.0, joint_missed = 0.0;  // [N] [m]
};

/// Parts that are tied one on the other and fall on a floor; the upper one is of any kind.
struct Upper {
  std::string name, model = "fe", law = "neo_hookean", scheme = "newmark: {step: 2.0e-5}";
  std::string element = "quad4", keys = {};
  int dim = 2, across = 3;
  int parts = 1;  // side by side
  friend std::ostream& operator<<(std::ostream& out, const Upper& u) { return out << u.name; }
};

std::string law_of(const std::string& law) {
  return law + ": {youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0}";
}

SolidText lower_of(const Upper& u) {
  return {.name = "low",
          .material = law_of(u.law),
          .integrator = "newmark: {step: 2.0e-5}",
          .position = {0.0, 0.0},
          .velocity = {1.0, -3.0},
          .sides = {"bottom", "top"},
          .more = "    contact_layer: {massive: {}}\n",
          .block = block_in(u.dim, {0.1, 0.05, 0.1}, {4, 2, 4})};
}

std::vector<SolidText> uppers_of(const Upper& u) {
  std::vector<SolidText> all;
  const double width = 0.1 / u.parts;
  for (int k = 0; k < u.parts; ++k)
    all.push_back(
        {.name = "high" + std::to_string(k),
         .material = law_of(u.law),
         .integrator = u.scheme,
         .position = {k * width, 0.05},
         .velocity = {1.0, -3.0},
         .model = u.model,
         .keys = u.keys,
         .sides = {"bottom", "left", "right"},
         .block = block_in(u.dim, {width, 0.05, 0.1}, {u.across, 2, u.across}, u.element)});
  return all;
}

std::string text_of(const Upper& u, double end) {
  const SolidText floor =
      tool("floor", block_in(u.dim, {0.4, 0.02, 0.4}, {1, 1, 1}), {-0.1, -0.0202, -0.1}, "top");
  std::string joints = "interfaces:\n  hit: {sides: [low.bottom, floor.face], contact: {}}\n";
  for (int k = 0; k < u.parts; ++k)
    joints += fmt::format("  joint{0}: {{sides: [low.top, high{0}.bottom], tied: {{}}}}\n", k);
  if (u.parts == 2) joints += "  between: {sides: [high0.right, high1.left], tied: {}}\n";
  return scene_text(end, 1.0e-4, lower_of(u).text() + texts_of(uppers_of(u)) + floor.text(),
                    joints);
}

class TiedPassivelyTold : public testing::TestWithParam<Upper> {};

TEST_P(TiedPassivelyTold, PortsTellWhatMovesTheBody) {
  const Upper& u = GetParam();
  Told told(1);
  const ResultPtr run = run_text(text_of(u, 2.0e-3), &told);
  const RunResult& result = *run;
  const RunEnd& end = result.end;
  ASSERT_EQ(end.status, "completed") << end.reason;
  ASSERT_GT(told.windows, 5);
  const double size = 3.0 * result.masses[1];
  // A passive step is solved to 1e-9 of its forces; rigid bodies move to round-off.
  EXPECT_LT(told.missed, 1e-8 * size);
  // The floor stops it within some windows: the joint carries at least that.
  EXPECT_GT(told.joint_force, size / 2.0e-3);
  EXPECT_GT(told.joint_missed, 0.0);
  // A step misses ties by a thousandth of the thickness, that of the cells' shortest edge, at most,
  // and takes back a tenth of what they have parted.
  EXPECT_LT(told.joint_missed, 10.0 * 1e-6 * 0.025);
  // Along the floor, where nothing rubs, momentum of all stays: equations are solved to 1e-9 of
  // their forces, in a hundred steps. In space an edge that is bent by a thousandth passes the
  // floor's diagonal with a normal that leans as much, and with some thousandths of the impulse:
  // measured 0.7e-5 to 1.4e-5.
  EXPECT_LT(result.momentum_error(), u.dim == 2 ? 1e-6 : 2e-5);
  double most = 0.0;
  for (const RunResult::Row& row : result.rows) {
    double sum = 0.0;
    for (const double each : row.total) sum += each;
    most = std::max(most, sum);
  }
  double first = 0.0;
  for (const double each : result.rows.front().total) first += each;
  EXPECT_LT(most, (1.0 + 1e-3) * first);  // of energy, as every step is allowed to gain
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, TiedPassivelyTold,
    testing::Values(
        Upper{.name = "unlike_meshes"},
        Upper{.name = "explicit",
              .scheme = "central_difference: {step: 1.0e-5, above_limit: clamp}"},
        Upper{.name = "rigid", .model = "rigid", .scheme = "rigid_motion: {step: 1.0e-4}"},
        Upper{.name = "modal", .model = "modal", .law = "linear_elastic", .keys = "modes: 6, "},
        Upper{.name = "tri6", .element = "tri6"},
        Upper{.name = "tet10", .element = "tet10", .dim = 3, .across = 2},
        Upper{.name = "rigid_in_space",
              .model = "rigid",
              .scheme = "rigid_motion: {step: 1.0e-4}",
              .element = "hex8",
              .dim = 3},
        Upper{.name = "two_parts_on_one_port", .parts = 2}),
    [](const auto& p) { return p.param.name; });

TEST(TiedPassivelyTold, ReturnWhenTheyFlyAgain) {
  const Upper u{.name = "unlike_meshes"};
  Told told(1);
  const ResultPtr run = run_text(text_of(u, 1.2e-2), &told);
  const RunResult& result = *run;
  const RunEnd& end = result.end;
  ASSERT_EQ(end.status, "completed") << end.reason;
  EXPECT_GT(end.given_up.windows, 0);
  EXPECT_GT(result.rows.back().iterations, 0);  // the accurate method has the last window
  EXPECT_LT(result.momentum_error(), 1e-6);     // equations: as above
  double last = 0.0, before = 0.0;
  for (const double each : result.rows.back().total) last += each;
  for (const double each : result.rows.front().total) before += each;
  EXPECT_LT(last, (1.0 + 1e-3) * before);  // of energy, as random scenes may gain
}

}  // namespace
}  // namespace abut::tied_passively_told_tests
