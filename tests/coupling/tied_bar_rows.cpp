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

namespace abut {
namespace {

// ---- strained from the start --------------------------------------------------------------------

/// Bars one after the other from 0 to 1, strained where they are cut; cells of 0.01.
struct Strained {
  std::string integrator;
  std::vector<double> cuts;                     // between 0 and 1
  std::vector<double> modulus{}, velocities{};  // by bar; empty: 1, 0
  std::string field = "0.001*exp(-((x-0.45)^2)/0.005)";

  std::string text() const {
    std::string out = "meta: {title: test}\ntime: {begin: 0.0, end: 2.0, window: 0.01}\nbodies:\n";
    std::string ties = cuts.empty() ? "" : "interfaces:\n";
    for (std::size_t b = 0; b <= cuts.size(); ++b) {
      const double from = b == 0 ? 0.0 : cuts[b - 1], to = b == cuts.size() ? 1.0 : cuts[b];
      std::string ports;
      if (b > 0) ports += "left: {side: left, tied: true}, ";
      if (b < cuts.size()) ports += "right: {side: right, tied: true}";
      out += fmt::format(
          "  b{}:\n    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: {}, elements: {}, area: "
          "1.0}}}}}}}}\n    material: {{linear_elastic: {{youngs_modulus: {}, density: 1.0}}}}\n"
          "    integrator: {{{}}}\n    initial: {{position: [{}], velocity: [{}], "
          "displacement_field: [\"{}\"]}}\n    ports: {{{}}}\n",
          b, number(to - from), std::lround(100.0 * (to - from)),
          number(modulus.empty() ? 1.0 : modulus[b]), integrator, number(from),
          number(velocities.empty() ? 0.0 : velocities[b]), field, ports);
      if (b > 0)
        ties += fmt::format("  j{}: {{sides: [b{}.right, b{}.left], tied: {{}}}}\n", b, b - 1, b);
    }
    return out + ties;
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
      const auto whole = run_document(
          Document::from_text("test", Strained{.integrator = integrator, .cuts = {}}.text()));
      const double energy = sum(whole->rows.front().total);
      const auto cut = run_document(
          Document::from_text("test", Strained{.integrator = integrator, .cuts = cuts}.text()));
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
      const auto unlike = run_document(Document::from_text("test", layered.text()));
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
      const auto run = run_document(Document::from_text("test", scene.text()));
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
  const auto row = [](const std::vector<std::string>& integrators, const std::string& contact) {
    std::string text = "meta: {title: test}\ntime: {begin: 0.0, end: 5.0, window: 0.01}\nbodies:\n";
    std::string ties = "interfaces:\n";
    const std::size_t count = integrators.size();
    for (std::size_t b = 0; b < count; ++b) {
      std::string ports = b > 0             ? "left: {side: left, tied: true}, "
                          : contact.empty() ? ""
                                            : "left: {side: left}, ";
      if (b + 1 < count) ports += "right: {side: right, tied: true}";
      text += fmt::format(
          "  b{}:\n    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 0.5, elements: 50, "
          "area: "
          "1.0}}}}}}}}\n    material: {{linear_elastic: {{youngs_modulus: 1.0, density: 1.0}}}}\n"
          "    integrator: {{{}}}\n    initial: {{position: [{}], {}}}\n    ports: {{{}}}\n",
          b, integrators[b], number(0.5 * static_cast<double>(b)),
          contact.empty() ? "displacement_field: [\"0.001*exp(-((x-0.45)^2)/0.005)\"]"
                          : "velocity: [-0.001]",
          ports);
      if (b > 0)
        ties += fmt::format("  j{}: {{sides: [b{}.right, b{}.left], tied: {{}}}}\n", b, b - 1, b);
    }
    if (!contact.empty()) ties += "  hit: {sides: [b0.left, wall.face], contact: {}}\n";
    return run_document(Document::from_text("test", text + contact + ties));
  };
  const std::string wall =
      "  wall: {model: {rigid_wall: {}}, initial: {position: [-0.0001]}, ports: {face: {side: "
      "right}}}\n";
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
    const auto shaken = row(integrators, "");
    ASSERT_TRUE(shaken->completed());
    const double first = sum(shaken->rows.front().total);
    for (const RunResult::Row& r : shaken->rows)
      EXPECT_NEAR(sum(r.total), first, left_open * first);
    if (integrators.size() > 3) continue;  // these are not back by the end
    const auto hit = row(integrators, wall);
    ASSERT_TRUE(hit->completed()) << hit->events.back().text;
    const double mass = 0.5 * static_cast<double>(integrators.size());
    // It has bounced: the whole flies back as it came, but for what vibrates.
    EXPECT_NEAR(sum(hit->rows.back().momentum), 0.001 * mass, 0.02 * 0.001 * mass);
    EXPECT_NEAR(hit->energy_error(), 0.0, 1.0e-2);
  }
}

/// A step that its body may clamp is not known from the scene: coordinator and bodies agree that a
/// force joins such bars, whether steps come out alike or not.
TEST(TiedBars, OfClampedStepsKeepTheirEnergy) {
  const auto row = [](const std::vector<double>& steps, double modulus) {
    std::string text = "meta: {title: test}\ntime: {begin: 0.0, end: 2.0, window: 0.02}\nbodies:\n";
    std::string ties = "interfaces:\n";
    for (std::size_t b = 0; b < steps.size(); ++b) {
      text += fmt::format(
          "  b{}:\n    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 0.5, elements: 50, "
          "area: 1.0}}}}}}}}\n    material: {{neo_hookean: {{youngs_modulus: {}, poissons_ratio: "
          "0.0, density: 1.0}}}}\n    integrator: {{central_difference: {{step: {}, above_limit: "
          "clamp}}}}\n    initial: {{position: [{}], displacement_field: "
          "[\"1e-5*exp(-((x-0.45)^2)/0.005)\"]}}\n    ports: {{{}}}\n",
          b, number(b == 0 ? 1.0 : modulus), number(steps[b]), number(0.5 * static_cast<double>(b)),
          b == 0 ? "right: {side: right, tied: true}" : "left: {side: left, tied: true}");
      if (b > 0)
        ties += fmt::format("  j{}: {{sides: [b{}.right, b{}.left], tied: {{}}}}\n", b, b - 1, b);
    }
    return run_document(Document::from_text("test", text + ties));
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
}  // namespace abut
