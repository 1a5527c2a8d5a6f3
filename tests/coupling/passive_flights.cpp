// Goal: a body that nothing touches, in steps that are long for its waves and turns, does not end
// the run by the energy that its scheme makes: it goes on passively. Oracles: momentum, energy that
// does not grow; the same scene where that is forbidden, which must fail.

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

/// Of the most energy: what accurate windows may leave above the start [M.21].
constexpr double granted = 5.0e-3;
/// [m/s] of 10 m/s: rounding of Newton's steps, 1e-10 of forces, in fifty windows.
constexpr double kept = 1.0e-8;

/// Waves of 1100 m/s cross it seven times in a step; it turns by 0.24 rad in it, and swings.
SolidText spinning(const std::string& law, double swing) {
  return {.name = "block",
          .material = law + ": {youngs_modulus: 1.2e9, poissons_ratio: 0.2, density: 1000.0}",
          .integrator = "newmark: {step: 1.2e-2}",
          .port = "skin",
          .side = "boundary",
          .field = fmt::format(
              "\"10 - 20 * (y - 1) + {0} * (x - 0.9)\", \"20 * (x - 0.9) - {0} * (y - 1)\"", swing),
          .block = {{1.8, 2.0}, {4, 3}}};
}

std::unique_ptr<RunResult> flight(const std::string& law, double swing, const std::string& more) {
  return run_solids(1.2, 2.4e-2,
                    {spinning(law, swing), tool("far", {{1.0, 1.0}, {1, 1}}, {99.0}, "left")}, "",
                    "contact: {everything: {}}\n" + more);
}

TEST(PassiveFlights, GoOnWhereSchemesMakeEnergy) {
  for (const std::string law : {"neo_hookean", "hencky", "saint_venant_kirchhoff"}) {
    for (const double swing : {10.0, 30.0}) {
      SCOPED_TRACE(fmt::format("{} {}", law, swing));
      const auto run = flight(law, swing, "");
      ASSERT_TRUE(run->completed()) << run->end.reason;
      double first = 0.0, most = 0.0, grown = 0.0;
      for (const RunResult::Row& row : run->rows) {
        if (&row == &run->rows.front()) first = row.total[0];
        most = std::max(most, row.total[0]);
        grown = std::max(grown, row.total[0] - first);
      }
      EXPECT_LT(grown, granted * most);
      EXPECT_NEAR(run->measure("body.block.momentum.x"), 3.6e4, 3.6e3 * kept);
      EXPECT_GT(run->end.given_up.windows, 0);
      EXPECT_EQ(flight(law, swing, "schwarz: {on_nonconvergence: stop}\n")->end.status, "failed");
    }
  }
}

}  // namespace
}  // namespace abut
