// Goal: one surface touches several others, as the side that finds contact with one and is found
// by another. Oracles: balance of momentum; three equal blocks in a row hand on their velocity as
// equal bodies do; a mirror along the diagonal.

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::several_partners_tests {
namespace {

constexpr double speed = 0.01;  // of that of sound

/// Three blocks in a row, the first of which moves; the skin of each is one port.
struct Chain {
  std::string law = "linear_elastic", scheme = "central_difference";
  std::array<std::string, 2> kinematic = {"auto", "auto"};
  double window = 0.025;
  int dim = 2;

  /// As many cells across as dimensions at least: the skin has no mass, and would turn about nodes
  /// inside that lie on one line.
  SolidText block(const std::string& name, double place, double v, int across) const {
    return {.name = name,
            .dim = dim,
            .mesh = bar_mesh(dim, across),
            .material = unit_law(law, 0.0),
            .integrator = scheme + ": {step: 0.0125}",
            .position = {place},
            .velocity = {v},
            .port = "skin",
            .side = "boundary"};
  }
  ResultPtr run() const {
    const auto role = [](const std::string& side) {
      return fmt::format(", transmission: {{unilateral: {{kinematic: {}}}}}", side);
    };
    return run_solids(5.0, window,
                      {block("a", -1.0, speed, dim), block("b", 0.002, 0.0, dim + 1),
                       block("c", 1.004, 0.0, dim)},
                      touching("first", "a.skin", "b.skin", role(kinematic[0])) +
                          touching("second", "b.skin", "c.skin", role(kinematic[1])));
  }
};

/// Eight elements disperse the front: 10 % of the velocity stay behind in vibration, as between two
/// blocks, and once more at the second contact.
void expect_handed_on(const RunResult& result, const std::string& what) {
  ASSERT_TRUE(result.completed()) << what;
  EXPECT_LE(result.momentum_error(), 1.0e-11) << what;      // forces balance point by point
  EXPECT_NEAR(result.energy_error(), 0.0, 1.0e-3) << what;  // measured 6e-5, coarse as they are
  EXPECT_NEAR(result.velocity(0), 0.0, 0.1 * speed) << what;
  EXPECT_NEAR(result.velocity(1), 0.0, 0.1 * speed) << what;
  EXPECT_NEAR(result.velocity(2), speed, 0.15 * speed) << what;
  for (const char* joint : {"first", "second"}) {
    EXPECT_EQ(result.times(RunEvent::Kind::contact_closed, joint).size(), 1u) << what;
    EXPECT_EQ(result.times(RunEvent::Kind::contact_opened, joint).size(), 1u) << what;
  }
  // Each interface tells its own force, not that of the whole port. Bodies solve their equations to
  // 1e-9 of the forces.
  const double solved = 1.0e-9 * result.masses[2] * speed;
  const double mass = result.masses[2], after = result.velocity(2);
  EXPECT_NEAR(result.measure("contact.second.impulse"), mass * after, solved) << what;
  EXPECT_NEAR(result.measure("contact.first.impulse"), mass * (speed - result.velocity(0)), solved)
      << what;
}

TEST(SeveralPartners, RolesMayBeMixedOnOneSkin) {
  for (const char* scheme : {"central_difference", "newmark"}) {
    for (const double window : {0.025, 0.5}) {
      for (const char* first : {"auto", "a.skin", "b.skin"}) {
        for (const char* second : {"auto", "b.skin", "c.skin"}) {
          Chain chain;
          chain.scheme = scheme;
          chain.window = window;
          chain.kinematic = {first, second};
          const ResultPtr result = chain.run();
          const std::string what = fmt::format("{}, windows of {} s, kinematic {} and {}", scheme,
                                               window, first, second);
          expect_handed_on(*result, what);
          // The middle block is predicted without what its other partner does within the window.
          const double most = window < 0.1 ? 2.0 : 4.0;
          EXPECT_LE(result->measure("schwarz.iterations_max"), most) << what;
        }
      }
    }
  }
}

TEST(SeveralPartners, OfRubberAndInSpace) {
  for (const int dim : {2, 3}) {
    Chain chain;
    chain.dim = dim;
    chain.law = dim == 2 ? "neo_hookean" : "linear_elastic";
    const ResultPtr result = chain.run();
    expect_handed_on(*result, fmt::format("{} dimensions", dim));
    EXPECT_LE(result->measure("schwarz.iterations_mean"), dim == 2 ? 3.0 : 1.0);
  }
}

TEST(SeveralPartners, AMirrorAlongTheDiagonalChangesNothing) {
  const ResultPtr result = run_file(ABUT_SOURCE_DIR "/configs/contact/ball_in_corner.yaml");
  ASSERT_TRUE(result->completed());
  // Sums in another order, over 160 windows.
  const double rounding = 1.0e-12;
  const double x = result->measure("mean_velocity.disk.end_x");
  EXPECT_NEAR(result->measure("mean_velocity.disk.end_y") / x, 1.0, rounding);
  const double below = result->measure("contact.below.impulse");
  EXPECT_NEAR(result->measure("contact.beside.impulse") / below, 1.0, rounding);
  // Each interface tells its own force: what changes the momentum along its axis.
  EXPECT_NEAR(below, result->masses[0] * (50.0 + x), 1.0e-9 * below);
}

}  // namespace
}  // namespace abut::several_partners_tests
