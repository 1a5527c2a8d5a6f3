// Goal: where everything may touch everything, bodies move as if every pair that touches were
// written, whenever it comes near.
// Oracles: the same scene with its interfaces written, bit for bit; balances of momentum and
// energy.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::everything_tests {
namespace {

struct Case {
  std::string name;
  int dim = 2;
  std::string law, integrator, contact;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const int dim : {2, 3})
    for (const std::string law : {"linear_elastic", "neo_hookean"})
      for (const std::string scheme : {"central_difference", "newmark", "generalized_alpha"})
        for (const std::string contact :
             {"", "friction: 0.3", "friction: 0.1, static_friction: 0.2"}) {
          if (dim == 3 && law == "neo_hookean" && scheme != "central_difference") continue;
          const std::string rubs = contact.empty() ? "smooth" : contact.size() > 14 ? "two" : "one";
          out.push_back({fmt::format("{}d_{}_{}_{}", dim, law, scheme, rubs), dim,
                         unit_law(law, 0.25), scheme + ": {step: 0.0125}", contact});
        }
  return out;
}

/// Bars of a length of 1 in a row, the outer ones on their way to the middle one at speeds of
/// their own.
std::vector<SolidText> row(const Case& c) {
  std::vector<SolidText> bars;
  for (const int k : {0, 1, 2}) {
    SolidText bar;
    bar.name = std::vector<std::string>{"middle", "left", "right"}[k];
    bar.dim = c.dim;
    bar.mesh = bar_mesh(c.dim, 2 - (c.dim - 2) + k % 2);  // in space as few as do not match
    bar.material = c.law;
    bar.integrator = c.integrator;
    bar.position = {k == 0 ? 0.0 : k == 1 ? -1.0002 : 1.004};
    bar.velocity = {k == 0 ? 0.0 : k == 1 ? 1.0e-3 : -1.0e-3, k == 1 ? 2.0e-4 : 0.0};
    if (k == 0) {
      bar.sides = {"left", "right"};
    } else {
      bar.side = k == 1 ? "right" : "left";
    }
    bars.push_back(bar);
  }
  return bars;
}

ResultPtr run(const Case& c, bool everything) {
  std::string rest = fmt::format("contact: {{everything: {{{}}}}}\n", c.contact);
  if (!everything) {
    const auto pair = [&c](const char* name, const char* sides) {
      return fmt::format("  {}: {{sides: [{}], contact: {{{}}}}}\n", name, sides, c.contact);
    };
    rest = "interfaces:\n" + pair("west", "middle.left, left.face") +
           pair("east", "middle.right, right.face");
  }
  return run_solids(6.0, 0.025, row(c), "", rest);
}

class Everything : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Combinations, Everything, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.name; });

TEST_P(Everything, IsThePairsThatTouchBitForBit) {
  const auto pairs = run(GetParam(), false), all = run(GetParam(), true);
  ASSERT_TRUE(pairs->completed());
  ASSERT_TRUE(all->completed());
  EXPECT_EQ(all->end.body_hashes, pairs->end.body_hashes);
  EXPECT_EQ(all->measure("contact.everything.closings"),
            pairs->measure("contact.west.closings") + pairs->measure("contact.east.closings"));
  EXPECT_EQ(all->measure("contact.everything.dissipated"),
            pairs->measure("contact.west.dissipated") + pairs->measure("contact.east.dissipated"));
  EXPECT_EQ(all->measure("contact.everything.force_peak"),
            std::max(pairs->measure("contact.west.force_peak"),
                     pairs->measure("contact.east.force_peak")));
  EXPECT_GT(pairs->measure("contact.east.begin"), pairs->measure("contact.west.begin") + 1.0);
}

/// Two blocks that are tied, one on the other, each with all of its boundary and the joint as
/// ports, and one that comes from the right and strikes the upper one.
ResultPtr tied_blocks_are_struck(bool everything) {
  std::vector<SolidText> blocks;
  for (const char* const name : {"lower", "upper", "comes"}) {
    const bool comes = name[0] == 'c', upper = name[0] == 'u';
    SolidText block{.name = name,
                    .material = unit_law("linear_elastic", 0.25),
                    .integrator = "central_difference: {step: 0.0125}",
                    .position = {comes ? 1.0005 : 0.0, comes   ? 1.2
                                                       : upper ? 1.0
                                                               : 0.0},
                    .velocity = {comes ? -1.0e-3 : 0.0, 0.0},
                    .port = "skin",
                    .side = "boundary",
                    .block = block_in(2, {1.0, comes ? 0.5 : 1.0}, {4, comes ? 3 : 4})};
    if (!comes) block.sides = {upper ? "bottom" : "top"};
    blocks.push_back(block);
  }
  std::string rest = "interfaces:\n  joint: {sides: [lower.top, upper.bottom], tied: {}}\n";
  if (everything) {
    rest += "contact: {everything: {}}\n";
  } else {
    rest += "  high: {sides: [upper.skin, comes.skin], contact: {}}\n";
    rest += "  low: {sides: [lower.skin, comes.skin], contact: {}}\n";
  }
  return run_solids(4.0, 0.025, blocks, "", rest);
}

/// What is tied, or looked at, is part of what touches: it touches once.
TEST(EverythingWithParts, TouchesByTheSurfaceThatHasThem) {
  const auto pairs = tied_blocks_are_struck(false), all = tied_blocks_are_struck(true);
  ASSERT_TRUE(pairs->completed()) << pairs->end.reason;
  ASSERT_TRUE(all->completed()) << all->end.reason;
  EXPECT_EQ(all->measure("contact.everything.closings"), pairs->measure("contact.high.closings"));
  EXPECT_GT(all->measure("contact.everything.impulse"), 0.0);
  // Pairs are joined as they come near, so that sums are in another order: the sweeps' tolerance of
  // 1e-6 in each of some ten windows in contact.
  constexpr double sweeps = 1.0e-6 * 10.0;
  EXPECT_NEAR(all->measure("contact.everything.impulse"), pairs->measure("contact.high.impulse"),
              sweeps * pairs->measure("contact.high.impulse"));
  constexpr double speed = 1.0e-3;  // [m/s] of what comes
  for (const std::size_t b : {0u, 1u, 2u})
    EXPECT_NEAR(all->velocity(b), pairs->velocity(b), sweeps * speed) << b;
}

/// A block of one cell runs into another one, in passive windows of several steps, in each of which
/// contact has a force of its own.
TEST(EverythingInPassiveWindows, HasTheImpulseThatBodiesGet) {
  std::string text;
  for (const char* const name : {"comes", "stands"}) {
    const bool comes = name[0] == 'c';
    text += SolidText{.name = name,
                      .material = unit_law("neo_hookean", 0.25),
                      .integrator = "central_difference: {step: 0.02}",
                      .position = {comes ? -1.0105 : 0.0, 0.0},
                      .velocity = {comes ? 0.05 : 0.0, 0.0},
                      .port = "skin",
                      .side = "boundary",
                      .block = block_in(2, {1.0, 1.0}, {1, 1})}
                .text();
  }
  const auto result = run_text(scene_text(6.0, 0.1, text, "contact: {everything: {}}\n"));
  ASSERT_TRUE(result->completed()) << result->end.reason;
  EXPECT_GT(result->end.given_up.windows, 0);
  const double got = result->rows.back().momentum[1] - result->rows.front().momentum[1];
  ASSERT_GT(got, 0.025);  // [kg m/s], what a blow without rebound gives
  // Flat sides meet: along the normal of both. Of some hundred steps' rounding.
  EXPECT_NEAR(result->measure("contact.everything.impulse"), got, 1.0e-10 * got);
}

/// Bars in a row whose moduli and densities differ alike; the first comes, a little sideways.
std::string chain(const std::vector<double>& ratios, const std::string& scheme, int steps,
                  double friction) {
  std::string text;
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    SolidText bar;
    bar.name = fmt::format("bar_{}", k);
    bar.mesh = bar_mesh(2, 2 + static_cast<int>(k % 2));
    bar.material =
        fmt::format("linear_elastic: {{youngs_modulus: {0}, poissons_ratio: 0.25, density: {0}}}",
                    number(ratios[k]));
    bar.integrator = scheme + ": {step: 0.0125}";
    bar.position = {1.0001 * static_cast<double>(k)};
    bar.velocity = {k == 0 ? 1.0e-3 : 0.0, k == 0 ? 2.0e-4 : 0.0};
    bar.sides = {"left", "right"};
    text += bar.text();
  }
  return scene_text(12.0, 0.0125 * steps, text,
                    fmt::format("contact: {{everything: {{friction: {}}}}}\n", number(friction)));
}

/// The goal of chains is 4 sweeps. Trapezoidal bars lose and gain what one step of a flat impact is
/// worth; explicit ones what rows that close one by one leave.
TEST(ChainsOfFive, SweepAtMostTwiceWhateverTheirMassesAndWindows) {
  for (const std::string scheme : {"central_difference", "newmark"})
    for (const std::vector<double>& ratios : {std::vector<double>{1.0, 1.0, 1.0, 1.0, 1.0},
                                              {1.0, 100.0, 1.0, 0.01, 1.0},
                                              {0.01, 0.1, 1.0, 10.0, 100.0},
                                              {100.0, 10.0, 1.0, 0.1, 0.01}})
      for (const int steps : {1, 5, 20})
        for (const double friction : {0.0, 0.3}) {
          SCOPED_TRACE(fmt::format("{} {} {} {}", scheme, fmt::join(ratios, ":"), steps, friction));
          const auto result = run_text(chain(ratios, scheme, steps, friction));
          ASSERT_TRUE(result->completed());
          EXPECT_LE(result->measure("schwarz.iterations_max"), 2.0);
          EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, 5.0e-4);
          // Rounding; where bodies solve equations, 1e-9 of the forces in every step.
          EXPECT_LE(result->measure("momentum.total"), scheme == "newmark" ? 1.0e-8 : 1.0e-11);
        }
}

}  // namespace
}  // namespace abut::everything_tests
