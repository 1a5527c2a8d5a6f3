// Goal: bars that the accurate method cannot take go on passively, between linear ones, walls and
// ties, and neither pass each other nor gain. Oracles: momentum, energy, the gap, symmetry.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::passive_bars_tests {
namespace {

struct Crush {
  std::string law = "neo_hookean", scheme = "newmark: {step: 2.0e-5}";
  std::string beside = "central_difference: {step: 1.0e-5}";
  int cells = 3;
  bool wall = false;

  /// A soft bar is run over by a stiff one, five times as fast as waves in it, and by its mirror
  /// image or against a wall.
  std::string text() const {
    std::string out =
        "meta: {title: test}\ntime: {begin: 0.0, end: 1.2e-2, window: 2.0e-5}\n"
        "bodies:\n";
    const auto stiff = [&](const char* name, double position, double velocity,
                           const std::string& ports) {
      out += fmt::format(
          "  {}:\n    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 0.25, elements: 20, "
          "area: 1.0e-4}}}}}}}}\n    material: {{linear_elastic: {{youngs_modulus: 1.0e7, "
          "density: 1000.0}}}}\n    integrator: {{{}}}\n    initial: {{position: [{}], velocity: "
          "[{}]}}\n    ports: {{{}}}\n",
          name, beside, position, velocity, ports);
    };
    stiff("left", -0.30, 30.0, "tip: {side: right}");
    out += fmt::format(
        "  soft:\n    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 0.1, elements: {}, "
        "area: 1.0e-4}}}}}}}}\n    material: {{{}: {{youngs_modulus: 1.0e5, poissons_ratio: 0.3, "
        "density: 1000.0}}}}\n    integrator: {{{}}}\n    ports: {{a: {{side: left}}, b: {{side: "
        "right}}}}\n",
        cells, law, scheme);
    if (wall)
      out +=
          "  right:\n    model: {rigid_wall: {}}\n    initial: {position: [0.15]}\n"
          "    ports: {tip: {side: left}}\n";
    else
      stiff("right", 0.15, -30.0, "tip: {side: left}");
    return out +
           "interfaces:\n  one: {sides: [left.tip, soft.a], contact: {}}\n"
           "  two: {sides: [soft.b, right.tip], contact: {}}\n";
  }
};

std::vector<Crush> crushes() {
  const std::string implicit = "newmark: {step: 2.0e-5}";
  const std::string step_by_step = "central_difference: {step: 1.0e-5}";
  const std::string soft = "neo_hookean", gives_way = "saint_venant_kirchhoff";
  return {{.law = soft, .scheme = implicit},
          {.law = soft, .scheme = step_by_step},
          {.law = soft, .scheme = step_by_step, .wall = true},
          {.law = gives_way, .scheme = implicit},
          {.law = gives_way, .scheme = implicit, .wall = true},
          {.law = gives_way, .scheme = step_by_step, .wall = true},
          {.law = soft, .scheme = implicit, .beside = implicit}};
}

TEST(PassiveBars, AreCrushedToTheEndAndGainNothing) {
  for (const Crush& crush : crushes()) {
    SCOPED_TRACE(crush.text());
    const ResultPtr result = run_text(crush.text());
    ASSERT_TRUE(result->completed()) << result->end.reason;
    EXPECT_GT(result->end.given_up.windows, 0);
    const auto energy = [](const RunResult::Row& row) {
      double sum = 0.0;
      for (const double total : row.total) sum += total;
      return sum;
    };
    const double first = energy(result->rows.front());
    const double may_gain = 1.0e-3;  // of accurate windows: what they gain beyond 8e-4 is repaid
    for (const RunResult::Row& row : result->rows)
      EXPECT_LE(energy(row), first * (1.0 + may_gain)) << row.time;
    if (!crush.wall) {
      EXPECT_LT(result->momentum_error(), roundoff(1.0e6, 1.0));
    }
    const double element = 0.1 / crush.cells;
    for (const char* joint : {"one", "two"})
      EXPECT_GE(result->measure(fmt::format("contact.{}.gap_min", joint)), -0.01 * element);
  }
}

}  // namespace
}  // namespace abut::passive_bars_tests
