// Goal: a body that folds onto itself is told of, since contact within a body is not modelled; one
// that does not is not. Oracle: a horseshoe whose ends are thrown at each other, or away.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

ResultPtr horseshoe(const std::string& law, double speed) {
  const SolidText shoe{
      .name = "shoe",
      .material = unit_law(law, 0.3),
      .integrator = "central_difference: {step: 0.01}",
      .port = "skin",
      .side = "boundary",
      .keys = "map: [(1 + x) * cos(0.3 + 0.16 * y), (1 + x) * sin(0.3 + 0.16 * y)], ",
      .field = fmt::format("\"0\", \"{} * y * exp(3 * (x - 1))\"", number(speed)),
      .block = {{0.2, 36.0}, {2, 36}}};
  const SolidText wall = tool("wall", {{1.0, 1.0}, {2, 2}}, {9.0}, "left");
  return run_solids(1.5, 0.05, {shoe, wall}, touching("touch", "shoe.skin", "wall.face"));
}

bool warned(const RunResult& result) {
  return std::ranges::any_of(result.events, [](const RunEvent& event) {
    return event.kind == RunEvent::Kind::warning &&
           event.text.find("passed through each other") != std::string::npos;
  });
}

TEST(SelfCrossings, AreToldOf) {
  for (const double speed : {-1.0, 0.2}) {
    const auto result = horseshoe("neo_hookean", speed);
    ASSERT_TRUE(result->completed());
    EXPECT_EQ(result->measure("body.shoe.contact.crossings") > 0.0, speed < 0.0) << speed;
    EXPECT_EQ(warned(*result), speed < 0.0) << speed;
  }
}

/// Small strains do not fold a body, and looking costs.
TEST(SelfCrossings, AreNotLookedForUnderSmallStrain) {
  const auto result = horseshoe("linear_elastic", 0.2);
  ASSERT_TRUE(result->completed());
  EXPECT_FALSE(result->measures.values.contains("body.shoe.contact.crossings"));
}

}  // namespace
}  // namespace abut
