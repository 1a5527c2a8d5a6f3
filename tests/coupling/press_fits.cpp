// Goal: interference that a scene wants is pressed in, at once or over a time, and what presses it
// in is all that is gained. Oracles: bars and Lame's rings in closed form, the balance of energy,
// other roles, meshes and orders; what is no fit is refused with a remedy.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::press_fits_tests {
namespace {

/// Two bars between walls, drawn a hundredth of a metre into each other.
struct Bars {
  int dim = 2;
  char lower = 'I', upper = 'I';  // schemes
  bool key_above = false, upper_first = false;
  double friction = 0.0, over = 0.1, end = 0.2, deep = 0.01;
  std::string key = {};  // in place of the usual one
  std::string element = {};

  static constexpr double stiff_below = 1.0e6, stiff_above = 2.0e6;  // [Pa]
  double breadth() const { return dim == 2 ? 0.4 : 0.4 * 0.3; }
  /// [N] in equilibrium: their stiffnesses in a row, times the overlap.
  double force() const {
    return breadth() * deep * stiff_below * stiff_above / (stiff_below + stiff_above);
  }
  SolidText bar(bool above) const {
    std::vector<double> lengths = {0.4, 1.0, 0.3};
    std::vector<int> cells = above ? std::vector{5, 9, 3} : std::vector{4, 8, 2};
    std::vector<double> position(index(dim), 0.0);
    position[1] = above ? 1.0 - deep : 0.0;
    SolidText out{.name = above ? "upper" : "lower",
                  .material = fmt::format("linear_elastic: {{youngs_modulus: {}, poissons_ratio: "
                                          "0.0, density: 1000.0}}",
                                          above ? stiff_above : stiff_below),
                  .integrator = scheme_named(above ? upper : lower, 1.0e-3),
                  .position = position,
                  .side = above ? "bottom" : "top",
                  .more = fmt::format("    constraints: {{wall: {{on: {}, fixed: true}}}}\n",
                                      above ? "top" : "bottom"),
                  .block = block_in(dim, lengths, cells, element)};
    const std::string usual = fmt::format("interference: {{over: {}}}", over);
    if (above == key_above) out.start = key.empty() ? usual : key == "none" ? "" : key;
    return out;
  }
  ResultPtr run() const {
    std::vector<SolidText> bodies{bar(upper_first), bar(!upper_first)};
    return run_solids(end, 1.0e-3, bodies,
                      fmt::format("  fit: {{sides: [lower.face, upper.face], contact: {{friction: "
                                  "{}}}}}\n",
                                  friction));
  }
};

/// Rows of second order are of the parts that show a face, so that unlike meshes pass a pressure on
/// the average alone: 3.8 % in the plane and of hex20, 9.8 % of tet10. Of single nodes it was a
/// third off.
constexpr double of_averages = 0.11;

double stored(const RunResult& run) {
  return run.measure("body.lower.energy.stored") + run.measure("body.upper.energy.stored");
}

/// [J] what there is in the bodies at the end, and what friction took, beside the external work.
double unbalanced(const RunResult& run) {
  double sum = 0.0;
  for (const double energy : run.rows.back().total) sum += energy;
  for (const double work : run.rows.back().work) sum -= work;
  for (const std::string body : {"lower", "upper"})
    sum += run.measure("body." + body + ".energy.dissipated");
  return sum;
}

bool told(const RunResult& run, const std::string& words) {
  return std::ranges::any_of(run.events, [&words](const RunEvent& event) {
    return event.text.find(words) != std::string::npos;
  });
}

/// A block drawn half a millimetre into the ground: no key wants that, and no interface names it.
TEST(PressFits, StaticsOfEverythingTellWhatTheyPressIn) {
  const std::string law = "linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: "
                          "1000.0}";
  const SolidText ground{.name = "ground",
                         .material = law,
                         .integrator = "quasi_static: {step: 0.5}",
                         .port = "skin",
                         .side = "boundary",
                         .more = "    constraints: {base: {on: bottom, fixed: true}}\n",
                         .block = {{1.0, 0.3}, {5, 3}, "quad4"}};
  const SolidText block{.name = "block",
                        .material = law,
                        .integrator = "quasi_static: {step: 0.5}",
                        .position = {0.2, 0.2995},
                        .port = "skin",
                        .side = "boundary",
                        .more = "    body_force: [0.0, -9.81]\n",
                        .block = {{0.5, 0.2}, {4, 2}, "quad4"}};
  const auto run =
      run_solids(1.0, 0.5, {ground, block}, "", "contact: {everything: {friction: 0.3}}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  EXPECT_TRUE(told(*run, "interference of 0.0005 m is pressed in"));
}

TEST(PressFits, StaticsHoldBarsInEquilibrium) {
  for (const int dim : {2, 3}) {
    for (const bool above : {false, true}) {
      for (const double over : {0.0, 0.1}) {
        for (const char* key : {"", "none"}) {
          const Bars bars{.dim = dim,
                          .lower = 'S',
                          .upper = 'S',
                          .key_above = above,
                          .upper_first = above,
                          .over = over,
                          .end = 0.11,
                          .key = key};
          SCOPED_TRACE(fmt::format("{}D, key above {}, over {}, key {}", dim, above, over, key));
          const auto run = bars.run();
          ASSERT_TRUE(run->completed()) << run->end.reason;
          // Tolerance of the sweeps.
          EXPECT_NEAR(stored(*run), 0.5 * bars.force() * bars.deep,
                      1.0e-6 * bars.force() * bars.deep);
          EXPECT_EQ(told(*run, "interference of 0.01 m is pressed in"), *key != '\0');
          // Forces grow linearly with what is pressed in, at once or in steps: sums alone are
          // rounded, beside the sweeps' tolerance, whose error is of second order in the work.
          EXPECT_NEAR(unbalanced(*run), 0.0, 1.0e-9 * bars.force() * bars.deep);
          EXPECT_TRUE(run->end.overlaps.empty());
        }
      }
    }
  }
}

/// Of faces of second order, whose nodes have unlike shares of an even pressure.
TEST(PressFits, PressureOfStaticBarsIsEven) {
  for (const char* element : {"quad4", "quad8", "tri6", "hex8", "hex20", "tet10"}) {
    const std::string name = element;
    const bool plane = name.starts_with("quad") || name.starts_with("tri");
    const Bars fit{.dim = plane ? 2 : 3,
                   .lower = 'S',
                   .upper = 'S',
                   .over = 0.0,
                   .end = 1.0e-3,
                   .element = element};
    const ResultPtr run = fit.run();
    ASSERT_TRUE(run->completed()) << run->end.reason;
    const double exact = fit.force() / fit.breadth();
    for (const char* body : {"lower", "upper"})
      EXPECT_NEAR(run->measure(fmt::format("body.{}.face.contact.pressure_max", body)), exact,
                  of_averages * exact)
          << element << ' ' << body;
  }
}

TEST(PressFits, WhatPressesInIsAllThatIsGained) {
  for (const int dim : {2, 3}) {
    for (const std::string schemes : {"II", "EE", "EI", "IE"}) {
      for (const bool above : {false, true}) {
        for (const double friction : {0.0, 0.3}) {
          const Bars bars{.dim = dim,
                          .lower = schemes[0],
                          .upper = schemes[1],
                          .key_above = above,
                          .friction = friction};
          SCOPED_TRACE(
              fmt::format("{}D, {}, key above {}, friction {}", dim, schemes, above, friction));
          const auto run = bars.run();
          ASSERT_TRUE(run->completed()) << run->end.reason;
          EXPECT_EQ(run->end.given_up.windows, 0);
          EXPECT_TRUE(run->end.overlaps.empty());
          const double rest = 0.5 * bars.force() * bars.deep;
          double total = 0.0;
          for (const double energy : run->rows.back().total) total += energy;
          // The least that such an overlap takes; pressed in over some four periods of the bars
          // hardly more is left swinging.
          EXPECT_GT(total, rest * (1.0 - 1.0e-3));
          EXPECT_LT(total, 1.2 * rest);
          // Exactly, whatever the schemes: by trapezoids, as all of them count.
          EXPECT_NEAR(unbalanced(*run), 0.0, 1.0e-11 * rest);  // sums over 200 substeps
          EXPECT_FALSE(told(*run, "steps of body")) << "which take nothing";
        }
      }
    }
  }
}

/// A quarter of a ring in plane stress; cells through its wall and around.
SolidText ring(const std::string& name, double inner, double outer, std::vector<int> cells,
               const std::string& side, const std::string& start,
               const std::string& integrator = "quasi_static: {step: 0.25}") {
  return {.name = name,
          .material =
              "linear_elastic: {youngs_modulus: 2.1e11, poissons_ratio: 0.3, density: 7800.0}",
          .integrator = integrator,
          .side = side,
          .keys = fmt::format("plane: stress, map: [\"({0} + {1} * x) * cos(y * pi / 180)\", "
                              "\"({0} + {1} * x) * sin(y * pi / 180)\"], ",
                              number(inner), number(outer - inner)),
          .start = start,
          .more = "    constraints: {a: {on: bottom, y: \"0\"}, b: {on: top, x: \"0\"}}\n",
          .block = {{1.0, 90.0}, std::move(cells)}};
}

const std::string ring_fit = "  fit: {sides: [hub.face, shaft.face], contact: {}}\n";

/// A quarter of a hollow shaft in a hub.
ResultPtr rings(int around, double interference, const std::string& key, double end,
                const std::string& integrator = "quasi_static: {step: 0.25}",
                double window = 0.25) {
  return run_solids(
      end, window,
      {ring("hub", 0.010, 0.020, {around / 2, around}, "left", key, integrator),
       ring("shaft", 0.004, 0.010 + interference, {around / 3, around}, "right", "", integrator)},
      ring_fit);
}

TEST(PressFits, RingsPressAsLameSays) {
  // p = d E / (a ((b^2 + a^2)/(b^2 - a^2) + (a^2 + c^2)/(a^2 - c^2))), for one material.
  const double a = 0.010, b = 0.020, c = 0.004, d = 1.0e-5;
  const double hub = (b * b + a * a) / (b * b - a * a), shaft = (a * a + c * c) / (a * a - c * c);
  const double pressure = d * 2.1e11 / (a * (hub + shaft));
  const double energy = 0.5 * pressure * d * 0.5 * std::numbers::pi * a;
  std::vector<double> errors;
  for (const int around : {24, 48}) {
    const auto at_once = rings(around, d, "", 0.25);
    ASSERT_TRUE(at_once->completed()) << at_once->end.reason;
    const double stored =
        at_once->measure("body.hub.energy.stored") + at_once->measure("body.shaft.energy.stored");
    errors.push_back(stored / energy - 1.0);
    const double at_once_work = at_once->rows.back().work[0] + at_once->rows.back().work[1];
    EXPECT_NEAR(at_once_work, stored, 1.0e-6 * stored);  // tolerance of the sweeps
    const auto grown = rings(around, d, "interference: {over: 1.0}", 1.0);
    ASSERT_TRUE(grown->completed()) << grown->end.reason;
    EXPECT_NEAR(
        grown->measure("body.hub.energy.stored") + grown->measure("body.shaft.energy.stored"),
        stored, 1.0e-6 * stored);  // tolerance of the sweeps
    const double work = grown->rows.back().work[0] + grown->rows.back().work[1];
    EXPECT_NEAR(work, stored, 1.0e-2 * stored);  // the ramp's steps: the rows' geometry follows
  }
  // Bilinear cells, and polygons of unlike numbers of corners for the circle.
  EXPECT_LT(std::abs(errors[0]), 2.0e-3);
  EXPECT_LT(std::abs(errors[1]), std::abs(errors[0]));
}

/// Of a wedge on a floor of three facets: averages over the floor's nodes, which have no rows of
/// contact, see its slope half a metre behind them.
TEST(PressFits, WhatTouchesIsNone) {
  const SolidText wedge{.name = "wedge",
                        .material = "linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, "
                                    "density: 1000.0}",
                        .integrator = "quasi_static: {step: 0.5}",
                        .side = "boundary",
                        .keys = "map: [x, \"y * (0.1 + 0.3 * x)\"], ",
                        .more = "    loads: {g: {acceleration: [\"0\", \"-9.81\"]}}\n",
                        .block = {{1.0, 1.0}, {6, 3}}};
  const SolidText floor{.name = "floor",
                        .position = {-1.5, -0.3},
                        .side = "boundary",
                        .model = "rigid_tool",
                        .block = {{4.0, 0.3}, {3, 1}}};
  const auto run = run_solids(1.0, 0.5, {wedge, floor},
                              "  rest: {sides: [wedge.face, floor.face], contact: {friction: "
                              "0.3}}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  EXPECT_FALSE(told(*run, "is pressed in"));
}

/// Polygons of eight and thirteen corners in a quarter, which stand off each other by more than the
/// interference on the average of any node of the one that finds the contact.
TEST(PressFits, PolygonsThatOverlapNowhereAreRefused) {
  expect_words(refusal([] {
                 run_solids(0.25, 0.25,
                            {ring("hub", 0.010, 0.020, {3, 13}, "left", ""),
                             ring("shaft", 0.004, 0.010 + 6.7e-6, {2, 8}, "right",
                                  "interference: {over: 0}")},
                            ring_fit);
               }),
               {"bodies.shaft.initial.interference", "has no effect"});
}

void expect_refused(const Bars& bars, std::initializer_list<const char*> words) {
  expect_words(refusal([&bars] { bars.run(); }), words);
}

TEST(PressFits, WhatIsNoFitIsRefused) {
  expect_refused({.key = "none"}, {"overlap by 0.01 m", "initial: {interference: {over: TIME}}"});
  // A facet is 1/9 m and 1/12.5 m long; half of it is the deepest fit.
  for (const char* key : {"", "none"})
    for (const char scheme : {'I', 'S'})
      expect_refused({.lower = scheme, .upper = scheme, .deep = 0.06, .key = key},
                     {"overlap by 0.06 m", "Move a body"});
  expect_refused({.over = 0.0}, {"initial.interference.over", "has inertia"});
  expect_refused({.deep = -0.001}, {"bodies.lower.initial.interference", "has no effect"});
  expect_refused({.key = "adjust: true, interference: {over: 1.0}"}, {"stands beside adjust"});
}

/// In motion, where round sides are facets of 7.5 and 11.25 degrees: their rows turn as they press,
/// and the work that presses them in was short of what it did by 1.7 %.
TEST(PressFits, RoundSidesThatArePressedInAreBalanced) {
  for (const char* const scheme :
       {"newmark: {step: 2.0e-6}", "central_difference: {step: 5.0e-8}"}) {
    SCOPED_TRACE(scheme);
    const auto run = rings(24, 2.0e-5, "interference: {over: 1.6e-4}", 2.0e-4, scheme, 2.0e-6);
    ASSERT_TRUE(run->completed()) << run->end.reason;
    double energy = 0.0, work = 0.0;
    for (const std::size_t b : {0u, 1u})
      energy += run->rows.back().total[b], work += run->rows.back().work[b];
    EXPECT_GT(energy, 0.0);
    // Of second order in the step, and of what rows close one by one.
    EXPECT_NEAR(work, energy, 2.0e-3 * energy);
  }
}

}  // namespace
}  // namespace abut::press_fits_tests
