// Goal: rows of single points, chosen for comparison, run wherever mortar rows do, balance forces
// as these do, and show what they cost. Oracles: a constant pressure that mortar rows pass to 1e-9;
// balance of momentum; energy; rest; the words of refusals.

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"

namespace abut::rows_of_points_tests {
namespace {

/// A block of so many cells across and two upwards, with a port, face.
SolidText block(int dim, const std::string& name, int across, double height, double place) {
  const bool plane = dim == 2;
  return {.name = name,
          .material = unit_law("linear_elastic", 0.3),
          .position = plane ? std::vector{0.0, place} : std::vector{0.0, 0.0, place},
          .block = {plane ? std::vector{1.0, height} : std::vector{1.0, 1.0, height},
                    plane ? std::vector{across, 2} : std::vector{across, across, 2}}};
}

/// Two blocks under a strain of 1e-4 across their joint.
std::string patch(int dim, int upper, int lower, const std::string& rows) {
  const bool plane = dim == 2;
  const auto pressed = [&](const std::string& name, int across, bool above) {
    const char* low = plane ? "bottom" : "back";
    const char* high = plane ? "top" : "front";
    SolidText out = block(dim, name, across, 0.5, above ? 0.5 : 0.0);
    out.integrator = "quasi_static: {step: 1.0}";
    out.side = above ? low : high;
    out.more = fmt::format(
        "    constraints: {{far: {{on: {}, {}: \"{}\"}}, side: {{on: left, x: \"0\"}}{}}}\n",
        above ? high : low, plane ? "y" : "z", above ? "-1.0e-4 * t" : "0",
        plane ? "" : ", low: {on: bottom, y: \"0\"}");
    return out;
  };
  return scene_text(
      1.0, 1.0, texts_of({pressed("upper", upper, true), pressed("lower", lower, false)}),
      fmt::format("interfaces: {{joint: {{sides: [upper.face, lower.face], contact: {{rows: "
                  "{}}}}}}}\n",
                  rows));
}

TEST(RowsOfPoints, PassNoConstantPressure) {
  for (const int dim : {2, 3}) {
    for (const auto& [upper, lower] : {std::pair(4, 6), std::pair(6, 4), std::pair(3, 7)}) {
      for (const bool points : {false, true}) {
        const auto result =
            run_text(patch(dim, upper, lower, points ? "point_to_surface" : "mortar"));
        ASSERT_TRUE(result->completed());
        const char* component = dim == 2 ? "yy" : "zz";
        const double exact = dim == 2 ? -1.0e-4 / 0.91 : -1.0e-4;  // plane strain; uniaxial
        double miss = 0.0;
        for (const char* body : {"upper", "lower"})
          for (const char* end : {"min", "max"})
            miss = std::max(miss, std::abs(result->measure(fmt::format("body.{}.nodal_stress.{}.{}",
                                                                       body, component, end)) /
                                               exact -
                                           1.0));
        if (points) {
          EXPECT_GT(miss, 0.01) << dim << upper << lower;
        } else {
          EXPECT_LT(miss, 1.0e-9) << dim << upper << lower;  // Newton's tolerance
        }
      }
    }
  }
}

struct Impact {
  std::string name;
  int dim = 2;
  std::string partner, scheme;
  bool round = false;
};

void PrintTo(const Impact& impact, std::ostream* out) { *out << impact.name; }

std::vector<Impact> impacts() {
  std::vector<Impact> out;
  for (const int dim : {2, 3})
    for (const char* partner : {"fe", "rigid", "rigid_tool", "modal"})
      for (const char* scheme : {"central_difference", "newmark"})
        for (const bool round : {false, true})
          out.push_back(
              {fmt::format("{}d_{}_{}_{}", dim, partner, scheme, round ? "round" : "flat"), dim,
               partner, scheme, round});
  return out;
}

std::string text(const Impact& impact) {
  const int dim = impact.dim;
  const auto body = [&](const std::string& name, const std::string& model, int across, double place,
                        double speed, const char* side) {
    const char* up = impact.round ? " + 0.1 * sin(3.141592653589793 * x)" : "";
    SolidText out = block(dim, name, across, 0.25, place);
    out.model = model;
    out.keys = fmt::format("{}map: [x, y{}{}], ", model == "modal" ? "modes: 8, " : "",
                           dim == 2 ? "" : ", z", up);
    out.side = side;
    if (model == "rigid_tool") {
      out.material = "";
    } else {
      out.integrator = implicit_scheme(model == "rigid" ? "rigid_motion" : impact.scheme, 0.01);
      out.velocity = dim == 2 ? std::vector{0.0, speed} : std::vector{0.0, 0.0, speed};
    }
    return out;
  };
  const bool plane = dim == 2;
  return scene_text(
      3.0, 0.05,
      texts_of({body("upper", "fe", 4, 0.252, -0.01, plane ? "bottom" : "back"),
                body("lower", impact.partner, 3, 0.0, 0.01, plane ? "top" : "front")}),
      "interfaces: {touch: {sides: [upper.face, lower.face], contact: {rows: "
      "point_to_surface}}}\n");
}

class PointImpact : public testing::TestWithParam<Impact> {};
INSTANTIATE_TEST_SUITE_P(Combinations, PointImpact, testing::ValuesIn(impacts()),
                         [](const auto& i) { return i.param.name; });

TEST_P(PointImpact, BalancesMomentumAndEnergy) {
  const Impact& impact = GetParam();
  const auto result = run_text(text(impact));
  ASSERT_TRUE(result->completed());
  EXPECT_GE(result->times(RunEvent::Kind::contact_closed, "touch").size(), 1u);
  EXPECT_GT(result->measure("contact.touch.impulse"), 0.0);
  if (!impact.round) {  // round ones rock
    EXPECT_EQ(result->times(RunEvent::Kind::contact_opened, "touch").size(), 1u);
  }
  if (impact.partner != "rigid_tool") {
    const bool is_explicit = impact.scheme.starts_with("central");
    // Rounding; where bodies solve equations, 1e-9 of the forces in every step.
    EXPECT_LE(result->measure("momentum.total"), is_explicit ? 1.0e-12 : 1.0e-8);
  }
  // The layer and rows that close inside a step, as with mortar rows.
  EXPECT_NEAR(result->measure("energy.total.relative_drift_end"), 0.0, 0.02);
}

std::string refused(const std::string& scene) {
  return refusal([&scene] { run_text(scene); });
}

TEST(RowsOfPoints, AreRefusedWhereTheyWouldMissOrDoNothing) {
  std::string edged = text({"edged", 2, "fe", "central_difference", false});
  const std::size_t lower = edged.find("  lower:");
  edged.replace(edged.find("side: top", lower), 9, "side: boundary");
  edged.insert(edged.find("contact:"), "transmission: {unilateral: {kinematic: upper.face}}, ");
  const std::string message = refused(edged);
  EXPECT_NE(message.find("contact.rows: is point_to_surface, but lower.face has sharp edges"),
            std::string::npos)
      << message;
  SceneText bars = two_bars();
  std::string flat = bars.text();
  flat.replace(flat.find("contact: {}"), 11, "contact: {rows: point_to_surface}");
  EXPECT_NE(refused(flat).find("contact.rows: has no effect: ends of bars are points"),
            std::string::npos)
      << refused(flat);
}

}  // namespace
}  // namespace abut::rows_of_points_tests
