// Goal: nothing passes through a body unseen in free flight, whatever moves it and however it
// begins: a tool on its way, with and without a step of its own, or a support that moves. Asking
// for fields changes nothing, to the last bit. Oracles: the geometry, which says whether and when
// the sides meet; the same scene stopped at every window for its fields.

#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::seen_in_flight_tests {
namespace {

constexpr double window = 1.0e-5, end = 1.0e-3;  // [s]

/// A plate above a clamped block, at rest when the run begins.
struct Press {
  std::string name;
  std::string mover = "tool";  // or "support"
  std::string way = "-t";      // [m] of time, downwards
  std::string across = "0";
  int dim = 2;
  double step = 0.0;    // [s] of a tool
  double gap = 3.0e-4;  // [m]
  std::string scheme = "central_difference: {step: 5.0e-7}";
};

void PrintTo(const Press& press, std::ostream* out) { *out << press.name; }

/// `more`: sections beside those of bodies and contact.
ResultPtr run(const Press& p, const std::string& more = "") {
  const SolidText block{.name = "block",
                        .material =
                            "linear_elastic: {youngs_modulus: 2.1e10, poissons_ratio: 0.3, "
                            "density: 7800.0}",
                        .integrator = p.scheme,
                        .sides = {"top"},
                        .more = "    constraints: {base: {on: bottom, fixed: true}}\n",
                        .block = block_in(p.dim, {0.1, 0.1, 0.1}, {2, 2, 2})};
  SolidText press = tool("press", block_in(p.dim, {0.2, 0.02, 0.2}, {1, 1, 1}),
                         {-0.05, 0.1 + p.gap, -0.05}, "bottom");
  if (p.mover == "tool") {
    press.keys =
        fmt::format("way: [\"{}\", \"{}\"{}], {}", p.across, p.way, p.dim == 3 ? ", \"0\"" : "",
                    p.step > 0.0 ? fmt::format("step: {}, ", number(p.step)) : "");
  } else {
    press.model = "fe";
    press.material = block.material;
    press.integrator = "newmark: {step: 5.0e-6}";
    press.more = fmt::format("    constraints: {{drive: {{on: top, x: \"{}\", y: \"{}\"{}}}}}\n",
                             p.across, p.way, p.dim == 3 ? ", z: \"0\"" : "");
    press.block.cells = block.block.cells;
  }
  return run_solids(end, window, {block, press}, touching("pressed", "block.top", "press.face"),
                    "schwarz: {energy_guard: 1.0e9}\n" + more);  // coarse steps gain some
}

class Pressed : public testing::TestWithParam<Press> {};

TEST_P(Pressed, IsSeenWithAndWithoutFields) {
  const auto freely = run(GetParam());
  const auto stopped = run(GetParam(), "output: {fields: {every: 1}}\n");
  ASSERT_TRUE(freely->completed() && stopped->completed());
  const double impulse = freely->measure("contact.pressed.impulse");
  const double there = stopped->measure("contact.pressed.impulse");
  EXPECT_GT(impulse, 0.0);
  EXPECT_EQ(impulse, there);
  EXPECT_EQ(freely->end.body_hashes, stopped->end.body_hashes);
  EXPECT_EQ(freely->end.state_hash, stopped->end.state_hash);
  EXPECT_EQ(freely->measure("contact.pressed.closings"),
            stopped->measure("contact.pressed.closings"));
}

INSTANTIATE_TEST_SUITE_P(
    Ways, Pressed,
    testing::Values(
        Press{.name = "from_rest"}, Press{.name = "from_rest_3d", .dim = 3},
        Press{.name = "ever_faster", .way = "-1.0e3 * t^2"},
        Press{.name = "late_and_sudden", .way = "t < 7.0e-4 ? 0 : -5 * (t - 7.0e-4)"},
        Press{.name = "there_and_back", .way = "-5.0e-4 * sin(_pi * t / 1.0e-3)^2"},
        // Between two looks at windows' ends, where it stands as at the begin:
        Press{.name = "taps_within_windows",
              .way = "-2.0e-4 * (1 - cos(2 * _pi * t / 1.0e-5))",
              .step = 1.0e-6},
        Press{.name = "circles_within_windows",
              .way = "-2.0e-4 * (1 - cos(2 * _pi * t / 1.0e-5))",
              .across = "2.0e-4 * sin(2 * _pi * t / 1.0e-5)",
              .step = 1.0e-6},
        Press{.name = "a_support_that_moves", .mover = "support"},
        Press{.name = "a_support_that_moves_3d", .mover = "support", .way = "-5 * t", .dim = 3},
        Press{.name = "onto_an_implicit_block", .scheme = "newmark: {step: 5.0e-6}"}),
    [](const testing::TestParamInfo<Press>& of) { return of.param.name; });

/// What is prescribed to stay away stays unseen: a way that ends short of the block.
TEST(PressedNot, AWayThatEndsShortOfTheBlockPressesNothing) {
  const auto still = run({.name = "short", .way = "-2.99e-4 * sin(_pi * t / 2.0e-3)"});
  EXPECT_TRUE(still->completed());
  EXPECT_EQ(still->measure("contact.pressed.impulse"), 0.0);
  EXPECT_EQ(still->measure("contact.pressed.closings"), 0.0);
}

}  // namespace
}  // namespace abut::seen_in_flight_tests
