// Goal: sides that see each other as dashpots, for comparison: where meshes are alike they are one,
// else what one cannot follow of the other is lost. Oracles: tied bodies, and the sign of the loss.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/overlapping_pair.hpp"

namespace abut::tied_dashpots_tests {
namespace {

/// Halves that meet in the middle. Unit density, a wave speed and a face of about one.
OverlappingPair halves(const std::string& schemes, const std::vector<int>& across) {
  OverlappingPair pair{.overlap = 0.0, .across = across, .schemes = schemes, .tied = ""};
  pair.seam = ", transmission: {robin: {impedance: 1.0}}";
  return pair;
}

TEST(TiedDashpots, BetweenTwinsAreTies) {
  for (const char* schemes : {"II", "IE", "EE"}) {
    for (const double window : {0.02, 0.2}) {
      OverlappingPair pair = halves(schemes, {4, 4});
      const auto damped = pair.run(4.0, window);
      pair.seam = "";
      const auto tied = pair.run(4.0, window);
      ASSERT_TRUE(damped->completed());
      // Round-off of some hundred steps.
      EXPECT_NEAR(damped->measure("energy.total.relative_drift_max"), 0.0, 1.0e-11) << schemes;
      EXPECT_LE(damped->measure("schwarz.iterations_mean"), 1.05) << schemes;
      for (const char* end : {"min", "max"}) {
        const std::string name = std::string("body.right.displacement.y.") + end;
        // Newton's method leaves 1e-9 of the forces in every step of implicit bodies.
        EXPECT_NEAR(damped->measure(name), tied->measure(name), 1.0e-8) << schemes << window;
      }
    }
  }
}

/// A cantilever's worth of waves over unlike meshes: ties keep their energy, dashpots lose it.
TEST(TiedDashpots, LoseWhatUnlikeMeshesCannotFollow) {
  for (const char* schemes : {"II", "EE"}) {
    OverlappingPair pair = halves(schemes, {4, 7});
    pair.start = "velocity_field: [\"sin(5*x)*cos(6*y)\", \"cos(7*x)\"]";
    const auto damped = pair.run(20.0, 0.2);
    pair.seam = "";
    const auto tied = pair.run(20.0, 0.2);
    ASSERT_TRUE(damped->completed());
    EXPECT_LT(damped->measure("energy.total.relative_drift_end"), -1.0e-2) << schemes;
    // Both start with velocities that differ at the joint, which ties make one at once.
    EXPECT_LT(damped->measure("energy.total.relative_drift_end"),
              2.0 * tied->measure("energy.total.relative_drift_end"))
        << schemes;
    EXPECT_LE(damped->measure("schwarz.iterations_mean"), 1.05) << schemes;
  }
}

}  // namespace
}  // namespace abut::tied_dashpots_tests
