// Goal: a body that folds onto itself is told of, since contact within a body is not modelled; one
// that does not is not. Oracle: a horseshoe whose ends are thrown at each other, or away.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

std::string horseshoe(const std::string& law, double speed) {
  return fmt::format(
      "meta: {{title: test}}\ntime: {{begin: 0.0, end: 1.5, window: 0.05}}\nbodies:\n"
      "  shoe:\n"
      "    model: {{fe: {{dimension: 2, mesh: {{rectangle: {{lengths: [0.2, 36.0], elements: [2, "
      "36]}}}}, map: [(1 + x) * cos(0.3 + 0.16 * y), (1 + x) * sin(0.3 + 0.16 * y)]}}}}\n"
      "    material: {{{}: {{youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}}}}\n"
      "    integrator: {{central_difference: {{step: 0.01}}}}\n"
      "    initial: {{velocity_field: [\"0\", \"{} * y * exp(3 * (x - 1))\"]}}\n"
      "    ports: {{skin: {{side: boundary}}}}\n"
      "  wall: {{model: {{rigid_tool: {{dimension: 2, mesh: {{rectangle: {{lengths: [1.0, 1.0], "
      "elements: [2, 2]}}}}}}}}, initial: {{position: [9.0, 0.0]}}, ports: {{face: {{side: "
      "left}}}}}}\n"
      "interfaces: {{touch: {{sides: [shoe.skin, wall.face], contact: {{}}}}}}\n",
      law, number(speed));
}

bool warned(const RunResult& result) {
  return std::ranges::any_of(result.events, [](const RunEvent& event) {
    return event.kind == RunEvent::Kind::warning &&
           event.text.find("passed through each other") != std::string::npos;
  });
}

TEST(SelfCrossings, AreToldOf) {
  for (const double speed : {-1.0, 0.2}) {
    const auto result = run_document(Document::from_text("test", horseshoe("neo_hookean", speed)));
    ASSERT_TRUE(result->completed());
    EXPECT_EQ(result->measure("body.shoe.contact.crossings") > 0.0, speed < 0.0) << speed;
    EXPECT_EQ(warned(*result), speed < 0.0) << speed;
  }
}

/// Small strains do not fold a body, and looking costs.
TEST(SelfCrossings, AreNotLookedForUnderSmallStrain) {
  const auto result = run_document(Document::from_text("test", horseshoe("linear_elastic", 0.2)));
  ASSERT_TRUE(result->completed());
  EXPECT_FALSE(result->measures.values.contains("body.shoe.contact.crossings"));
}

}  // namespace
}  // namespace abut
