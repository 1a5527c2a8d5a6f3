// Goal: joined bodies in their passive forms move as the whole body does, whatever touches them.
// Oracles: the undivided body, whose halves with nodes that meet are the same equations; momentum
// and energy.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::tied_passively_tests {
namespace {

struct Halves {
  std::string name, element = "quad4", law = "linear_elastic", scheme = "newmark: {step: 2.0e-5}";
  int dim = 2;
  bool meet = true;  // nodes of the halves
  friend std::ostream& operator<<(std::ostream& out, const Halves& h) { return out << h.name; }
};

SolidText part(const Halves& h, const std::string& name, double height, int layers, double y,
               int across) {
  return {.name = name,
          .material = h.law + ": {youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0" +
                      (h.law == "j2_plasticity" ? ", yield_stress: 1.0e5, hardening: 1.0e6}" : "}"),
          .integrator = h.scheme,
          .position = {0.0, y},
          .velocity = {1.0, -3.0},
          .sides = {"bottom", "top"},
          .more = "    contact_layer: {massive: {}}\n",
          .block = block_in(h.dim, {0.1, height, 0.1}, {across, layers, across}, h.element)};
}

/// Until they fly again: back in their own schemes, halves would have the mass of these.
ResultPtr fall(const Halves& h, bool whole) {
  const SolidText floor =
      tool("floor", block_in(h.dim, {0.4, 0.02, 0.4}, {1, 1, 1}), {-0.1, -0.0202, -0.1}, "top");
  const std::string hit = "interfaces:\n  hit: {sides: [low.bottom, floor.face], contact: {}}\n";
  if (whole)
    return run_scene(2.5e-3, 1.0e-4, part(h, "low", 0.1, 4, 0.0, 4).text() + floor.text(), hit);
  return run_scene(2.5e-3, 1.0e-4,
                   part(h, "low", 0.05, 2, 0.0, 4).text() +
                       part(h, "high", 0.05, 2, 0.05, h.meet ? 4 : 3).text() + floor.text(),
                   hit + "  joint: {sides: [low.top, high.bottom], tied: {}}\n");
}

class TiedPassively : public testing::TestWithParam<Halves> {};

TEST_P(TiedPassively, AreTheWhole) {
  const Halves& h = GetParam();
  const auto halves = fall(h, false), whole = fall(h, true);
  ASSERT_TRUE(halves->completed() && whole->completed());
  EXPECT_GT(halves->end.given_up.windows, 0);
  const auto &last = halves->rows.back(), &undivided = whole->rows.back();
  const double scale = undivided.total[0];
  const double energy = last.total[0] + last.total[1];
  ASSERT_GT(scale, 0.0);
  // Impulses fit to a twentieth of the thickness, which decides when rows press: some
  // ten-thousandths of the energy. Where nodes do not meet, the joint is as stiff as its finer side
  // to some thousandths.
  const double tolerance = h.meet ? 1e-3 : 2e-2;
  EXPECT_NEAR(energy, undivided.total[0], tolerance * scale);
  EXPECT_NEAR(last.momentum[0] + last.momentum[1], undivided.momentum[0],
              tolerance * halves->masses[0] * 3.0);
}

INSTANTIATE_TEST_SUITE_P(
    Combinations, TiedPassively,
    testing::Values(Halves{.name = "linear"}, Halves{.name = "triangles", .element = "tri3"},
                    Halves{.name = "neo_hookean", .law = "neo_hookean"},
                    Halves{.name = "plastic", .law = "j2_plasticity"},
                    Halves{.name = "explicit",
                           .scheme = "central_difference: {step: 1.0e-5, above_limit: clamp}"},
                    Halves{.name = "generalized_alpha",
                           .scheme = "generalized_alpha: {step: 2.0e-5}"},
                    Halves{.name = "in_space", .element = "hex8", .dim = 3},
                    Halves{.name = "nodes_apart", .meet = false},
                    Halves{.name = "nodes_apart_neo_hookean", .law = "neo_hookean", .meet = false}),
    [](const auto& p) { return p.param.name; });

// What joined bodies gain is what the whole gains: nothing, whichever way windows go.

SolidText block(const std::string& name, const std::string& scheme, double modulus, double density,
                const std::vector<double>& place, const std::vector<double>& lengths,
                const std::vector<int>& cells) {
  return {.name = name,
          .material = "linear_elastic: {youngs_modulus: " + number(modulus) +
                      ", poissons_ratio: 0.3, density: " + number(density) + "}",
          .integrator = scheme,
          .position = place,
          .velocity = {0.0, name == "hammer" ? -10.0 : 0.0},
          .sides = {"left", "right", "top", "bottom"},
          .block = {lengths, cells, "quad4"}};
}

class JoinedAndHit : public testing::TestWithParam<std::string> {};

/// A hammer that is a hundred times as stiff strikes one of two joined blocks beside its middle.
/// Accurate implicit windows gain there, which the blocks repay beside their joint; where the
/// passive way begins, the sides of the joint move by the masses of their passive forms and not
/// alike, and the blow comes in the step that makes them one.
TEST_P(JoinedAndHit, GainNothing) {
  const std::string scheme = GetParam(), newmark = "newmark: {step: 2.0e-5}";
  const auto run = run_scene(
      3.0e-3, 2.0e-5,
      block("left", scheme, 1.0e7, 1000.0, {0.0, 0.0}, {0.1, 0.1}, {3, 3}).text() +
          block("right", newmark, 1.0e7, 1000.0, {0.1, 0.0}, {0.1, 0.1}, {2, 2}).text() +
          block("hammer", newmark, 1.0e9, 3000.0, {0.12, 0.1003}, {0.05, 0.1}, {1, 2}).text(),
      "interfaces:\n  joint: {sides: [left.right, right.left], tied: {}}\n"
      "  hit: {sides: [right.top, hammer.bottom], contact: {}}\n");
  ASSERT_TRUE(run->completed());
  if (scheme == newmark) {
    EXPECT_GT(run->end.given_up.repaid, 0.0);
  }
  double first = -1.0, most = 0.0;
  for (const RunResult::Row& row : run->rows) {
    double sum = 0.0;
    for (const double energy : row.total) sum += energy;
    if (first < 0.0) first = sum;
    most = std::max(most, sum / first - 1.0);
  }
  EXPECT_LT(most, 1e-3);  // what no scene may gain; without repayment 2e-3, by the joint 4e-3
}

INSTANTIATE_TEST_SUITE_P(Schemes, JoinedAndHit,
                         testing::Values("newmark: {step: 2.0e-5}",
                                         "central_difference: {step: 1.0e-5, above_limit: clamp}"),
                         [](const auto& p) { return p.param.substr(0, p.param.find(':')); });

}  // namespace
}  // namespace abut::tied_passively_tests
