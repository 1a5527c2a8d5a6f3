// Goal: ripple is the standard deviation of a force over its mean, from a time on, however the
// force is cut into stretches. Oracles: closed forms of triangular and square waves.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/record/force_ripple.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::test_force_ripple {
namespace {

/// Of mean `mean` and amplitude `swing`: highest at whole times, lowest halfway.
double triangle(double time, double mean, double swing) {
  const double phase = time - std::floor(time);
  return mean + swing * (4.0 * std::abs(phase - 0.5) - 1.0);
}

TEST(ForceRipple, OfATriangularWaveIsItsAmplitudeOverRootThree) {
  for (const int pieces : {2, 4, 26}) {
    for (const auto& [mean, swing] :
         std::vector<std::pair<double, double>>{{1.0, 1.0}, {-5.0, 0.1}, {1.0e6, 1.0e-2}}) {
      ForceRipple ripple(1.25);  // inside a stretch; what comes before is another force
      for (int k = 0; k < 4 * pieces; ++k) {
        const double from = static_cast<double>(k) / pieces, to = (k + 1.0) / pieces;
        if (to <= 1.0)
          ripple.add(from, to, 7.0 * mean, 9.0 * mean);
        else
          ripple.add(from, to, triangle(from, mean, swing), triangle(to, mean, swing));
      }
      // From 1.25 to 4: eleven quarters, each a straight line over half of the swing.
      const double exact = swing / std::sqrt(3.0);
      const double middle = swing / 22.0;  // the first quarter, of mean -swing/2, has no partner
      const double deviation = std::sqrt(exact * exact - middle * middle);
      EXPECT_NEAR(ripple.value(), deviation / std::abs(mean - middle),
                  // sums of differences from the first force, which has the mean's round-off
                  roundoff(10.0, 1.0) + 1.0e-9 * swing / std::abs(mean))
          << pieces << " " << mean;
    }
  }
}

TEST(ForceRipple, OfASquareWaveIsItsAmplitudeAndOfAConstantNone) {
  ForceRipple square(0.0), constant(0.0), none(0.0), early(9.0);
  for (int k = 0; k < 8; ++k) {
    const double force = k % 2 == 0 ? 3.0 : 1.0;
    square.add(k, k + 1, force, force);
    constant.add(k, k + 1, 0.1, 0.1);
    none.add(k, k + 1, 0.0, 0.0);
    early.add(k, k + 1, 1.0, 2.0);
  }
  EXPECT_DOUBLE_EQ(square.value(), 0.5);
  EXPECT_EQ(constant.value(), 0.0);
  EXPECT_TRUE(std::isnan(none.value()));
  EXPECT_TRUE(std::isnan(early.value()));
}

}  // namespace
}  // namespace abut::test_force_ripple
