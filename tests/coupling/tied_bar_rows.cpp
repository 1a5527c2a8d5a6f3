// Goal: parts of a bar that share nodes have its energy from the first record on, strained or not;
// rows of any steps are joined. Oracles: the undivided bar, the plastic impact of two end nodes,
// the energy identity [M.108], flight after an impact.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::tied_bar_rows_tests {
namespace {

// ---- strained from the start --------------------------------------------------------------------

/// A bar of a row, in cells of 0.01.
BarText part(double from, double to, const std::string& integrator) {
  BarText bar =
      unit_bar("", to - from, static_cast<int>(std::lround(100.0 * (to - from))), integrator, from);
  bar.layer.clear();
  bar.sides.clear();
  return bar;
}

constexpr const char* strain = "displacement_field: [\"0.001*exp(-((x-0.45)^2)/0.005)\"]";

/// Bars b0, b1, ... that are joined where they meet; what else there is, as the scene says it.
ResultPtr run_row(double end, double window, std::vector<BarText> bars,
                  const std::string& body = "", const std::string& joint = "") {
  std::string bodies, ties;
  for (std::size_t b = 0; b < bars.size(); ++b) {
    for (const char* side : {"left", "right"}) {
      if (b == (side[0] == 'l' ? 0 : bars.size() - 1)) continue;
      bars[b].sides.push_back(side);
      bars[b].tied += side;
    }
    bars[b].name = fmt::format("b{}", b);
    bodies += bars[b].text();
    if (b > 0)
      ties += joined(fmt::format("j{}", b), bars[b - 1].name + ".right", bars[b].name + ".left");
  }
  ties += joint;
  return run_scene(end, window, bodies + body, ties.empty() ? "" : "interfaces:\n" + ties);
}

/// Bars one after the other from 0 to 1, strained where they are cut.
struct Strained {
  std::string integrator;
  std::vector<double> cuts;                     // between 0 and 1
  std::vector<double> modulus{}, velocities{};  // by bar; empty: 1, 0

  ResultPtr run() const {
    std::vector<BarText> bars;
    for (std::size_t b = 0; b <= cuts.size(); ++b) {
      bars.push_back(
          part(b == 0 ? 0.0 : cuts[b - 1], b == cuts.size() ? 1.0 : cuts[b], integrator));
      bars.back().start = strain;
      if (!modulus.empty()) bars.back().modulus = modulus[b];
      if (!velocities.empty()) bars.back().velocity = velocities[b];
    }
    return run_row(2.0, 0.01, bars);
  }
};

/// Of the energy: windows leave 1e-6 of a step's way open, of some hundred windows.
constexpr double left_open = 1.0e-8;

double sum(const std::vector<double>& values) {
  double all = 0.0;
  for (const double value : values) all += value;
  return all;
}

/// Parts of a strained bar have its energy, from the first record on: also where they are of unlike
/// stiffness, of which nothing undivided tells.
TEST(TiedBars, ThatAreStrainedKeepTheirEnergyFromTheStart) {
  for (const std::string& integrator :
       {explicit_scheme(0.005), explicit_scheme(0.01), explicit_scheme(0.005, 2),
        explicit_scheme(0.005, 4), implicit_scheme("newmark", 0.005)}) {
    for (const std::vector<double>& cuts :
         {std::vector<double>{0.5}, {0.4}, {0.45}, {0.4, 0.5}, {0.3, 0.45, 0.6}}) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, cuts.size()));
      const auto whole = Strained{.integrator = integrator, .cuts = {}}.run();
      const double energy = sum(whole->rows.front().total);
      const auto cut = Strained{.integrator = integrator, .cuts = cuts}.run();
      ASSERT_TRUE(cut->completed());
      const double first = sum(cut->rows.front().total);
      // More terms smooth otherwise at an end that is held.
      if (integrator.find("terms") == std::string::npos) {
        EXPECT_NEAR(first, energy, roundoff(100.0, energy));
      }
      for (const RunResult::Row& row : cut->rows)
        EXPECT_NEAR(sum(row.total), first, left_open * first);
      Strained layered{.integrator = integrator, .cuts = {0.45}};
      layered.modulus = {1.0, 0.1};
      const auto unlike = layered.run();
      const double begin = sum(unlike->rows.front().total);
      for (const RunResult::Row& row : unlike->rows)
        EXPECT_NEAR(sum(row.total), begin, left_open * begin);
    }
  }
}

/// Strained and of unlike velocities: what is lost is what the plastic impact of both end nodes
/// takes, 1/2 m/2 of half a cell each [M.22], and nothing else.
TEST(TiedBars, ThatAreStrainedAndMeetLoseTheirImpactAlone) {
  for (const std::string& integrator : {explicit_scheme(0.005), explicit_scheme(0.01),
                                        std::string("newmark: {step: 0.005, mass: lumped}")}) {
    for (const double speed : {1.0e-3, -1.0e-3, 1.0e-4}) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, speed));
      Strained scene{.integrator = integrator, .cuts = {0.45}};
      scene.velocities = {speed, 0.0};
      const auto run = scene.run();
      ASSERT_TRUE(run->completed());
      const double first = sum(run->rows.front().total);
      const double lost = 0.5 * 0.5 * 0.005 * speed * speed;
      for (std::size_t k = 1; k < run->rows.size(); ++k)
        EXPECT_NEAR(sum(run->rows[k].total), first - lost, left_open * first);
    }
  }
}

// ---- rows of unlike steps -----------------------------------------------------------------------

/// Where two bars of a row step apart, all of its nodes are joined by forces: any steps in any
/// order, and the other end of a bar may touch.
TEST(TiedBars, InRowsOfAnyStepsKeepTheirEnergy) {
  const auto row = [](const std::vector<std::string>& integrators, bool hits) {
    std::vector<BarText> bars;
    for (const std::string& integrator : integrators) {
      const double from = 0.5 * static_cast<double>(bars.size());
      BarText& bar = bars.emplace_back(part(from, from + 0.5, integrator));
      if (hits)
        bar.velocity = -0.001;
      else
        bar.start = strain;
    }
    if (!hits) return run_row(5.0, 0.01, bars);
    bars.front().sides = {"left"};
    return run_row(5.0, 0.01, bars, wall_text(-0.0001, "right"),
                   touching("hit", "b0.left", "wall.right"));
  };
  const std::string i1 = implicit_scheme("newmark", 0.005), i2 = implicit_scheme("newmark", 0.01),
                    e1 = explicit_scheme(0.005), e2 = explicit_scheme(0.0025);
  for (const std::vector<std::string>& integrators : {std::vector<std::string>{i1, i2, i2, i1},
                                                      {e1, e2, e2, e1},
                                                      {i1, i1, e1, e1},
                                                      {i2, i2, i2, i1, e1, e1},
                                                      {e1, i2},
                                                      {e1, e1, i2},
                                                      {i1, i2, i2}}) {
    SCOPED_TRACE(fmt::format("{}", fmt::join(integrators, " ")));
    const auto shaken = row(integrators, false);
    ASSERT_TRUE(shaken->completed());
    const double first = sum(shaken->rows.front().total);
    for (const RunResult::Row& r : shaken->rows)
      EXPECT_NEAR(sum(r.total), first, left_open * first);
    if (integrators.size() > 3) continue;  // these are not back by the end
    const auto hit = row(integrators, true);
    ASSERT_TRUE(hit->completed()) << hit->events.back().text;
    const double mass = 0.5 * static_cast<double>(integrators.size());
    // It has bounced: the whole flies back as it came, but for what vibrates.
    EXPECT_NEAR(sum(hit->rows.back().momentum), 0.001 * mass, 0.02 * 0.001 * mass);
    EXPECT_NEAR(hit->energy_error(), 0.0, 1.0e-2);  // what contact may owe at a time
  }
}

/// A step that its body may clamp is not known from the scene: coordinator and bodies agree that a
/// force joins such bars, whether steps come out alike or not.
TEST(TiedBars, OfClampedStepsKeepTheirEnergy) {
  const auto row = [](const std::vector<double>& steps, double modulus) {
    std::vector<BarText> bars;
    for (std::size_t b = 0; b < steps.size(); ++b) {
      const double from = 0.5 * static_cast<double>(b);
      bars.push_back(part(from, from + 0.5,
                          fmt::format("central_difference: {{step: {}, "
                                      "above_limit: clamp}}",
                                      number(steps[b]))));
      bars[b].law =
          fmt::format("neo_hookean: {{youngs_modulus: {}, poissons_ratio: 0.0, density: 1.0}}",
                      number(b == 0 ? 1.0 : modulus));
      bars[b].start = "displacement_field: [\"1e-5*exp(-((x-0.45)^2)/0.005)\"]";
    }
    return run_row(2.0, 0.02, bars);
  };
  // The first bar's limit is 0.01, the second one's that over the root of its modulus.
  for (const std::vector<double>& steps : {std::vector<double>{0.005, 0.005},
                                           {0.02, 0.005},
                                           {0.005, 0.02},
                                           {0.02, 0.02},
                                           {0.02, 0.02 / 3.0}}) {
    for (const double modulus : {1.0, 0.1}) {
      SCOPED_TRACE(fmt::format("{} {}", fmt::join(steps, " "), modulus));
      const auto run = row(steps, modulus);
      ASSERT_TRUE(run->completed());
      // Of waves some cells long in bars that are not quite linear: twice the most, of steps at the
      // limit.
      const double first = sum(run->rows.front().total);
      for (const RunResult::Row& r : run->rows) EXPECT_NEAR(sum(r.total), first, 4.0e-4 * first);
    }
  }
}

}  // namespace
}  // namespace abut::tied_bar_rows_tests
