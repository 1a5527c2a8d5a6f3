// Goal: bodies without inertia that contact alone holds come to rest in equilibrium, whatever
// stabilises them on the way, and a run says how much of the forces that bears.
// Oracles: columns under pressure in closed form, balance of forces, Coulomb's law, other
// stiffnesses of the stabilisation.

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::stabilised_statics_tests {
namespace {

/// Blocks of 1 m on each other, the lowest held, pressed by a load on the last one that grows until
/// half of the time.
struct Column {
  int dim = 2, floating = 1;
  double friction = 0.0, push = 0.0;  // [Pa] on the left of the last one
  double gap = 0.0;                   // [m] below each
  std::string stabilisation = {};     // its keys
  std::string law = "linear_elastic";
  bool upper_first = false;
  double pressure = 2.0e3;  // [Pa]
  // [m] By it the last block, held at its top, overlaps the one below, in place of loads.
  double overlap = 0.0;
  double unlike = 1.0;  // every other block is so much stiffer
  double metre = 1.0;   // [1/m] of the scene's lengths
  double rise = 4.0;    // [s] in which loads grow

  static constexpr double youngs = 1.0e6;  // [Pa]
  static constexpr int windows = 10;

  double stiffness(int k) const { return k % 2 == 1 ? unlike * youngs : youngs; }  // [Pa]

  SolidText block(int k) const {
    const bool top = k == last();
    std::vector<double> position(index(dim), 0.0);
    position[1] = metre * (k * (1.0 + gap) - (top ? overlap : 0.0));
    SolidText out{.name = fmt::format("b{}", k),
                  .material = fmt::format("{}: {{youngs_modulus: {}, poissons_ratio: 0.0, "
                                          "density: 1000.0}}",
                                          law, stiffness(k)),
                  .integrator = "quasi_static: {step: 1.0}",
                  .position = position,
                  .sides = {"bottom", "top"},
                  .block = block_in(dim, {metre, metre, metre}, {2 + k % 2, 2, 2})};
    if (k == 0) {
      out.sides = {"top"};
      out.more = "    constraints: {floor: {on: bottom, fixed: true}}\n";
      return out;
    }
    if (top && overlap > 0.0) {
      out.sides = {"bottom"};
      out.more = "    constraints: {ceiling: {on: top, fixed: true}}\n";
      return out;
    }
    if (!stabilisation.empty())
      out.integrator =
          fmt::format("quasi_static: {{step: 1.0, stabilisation: {{{}}}}}", stabilisation);
    if (!top) return out;
    const std::string grows = fmt::format("min(t / {}, 1)", rise);
    const char* none = dim == 3 ? ", '0'" : "";
    out.sides = {"bottom"};
    out.more = fmt::format(
        "    loads:\n      lid: {{on: top, traction: ['0', '{} * {}'{}]}}\n"
        "      push: {{on: left, traction: ['{} * {}', '0'{}]}}\n",
        -pressure, grows, none, push, grows, none);
    return out;
  }
  int last() const { return floating + (overlap > 0.0 ? 1 : 0); }
  /// By the accurate method alone.
  ResultPtr run(const std::string& schwarz = "on_nonconvergence: stop") const {
    std::vector<SolidText> bodies;
    std::string joints;
    for (int k = 0; k <= last(); ++k) bodies.push_back(block(k));
    for (int k = 0; k < last(); ++k)
      joints += fmt::format("  j{0}: {{sides: [b{1}.{2}, b{3}.{4}], contact: {{friction: {5}}}}}\n",
                            k, upper_first ? k + 1 : k, upper_first ? "bottom" : "top",
                            upper_first ? k : k + 1, upper_first ? "top" : "bottom", friction);
    return run_solids(windows, 1.0, bodies, joints + "schwarz: {" + schwarz + "}\n");
  }
};

double reaction(const RunResult& run, const std::string& axis) {
  return run.measure("body.b0.floor.reaction." + axis);
}

TEST(StabilisedStatics, ColumnsShortenAsHeldOnesDo) {
  for (const int dim : {2, 3}) {
    for (const int floating : {1, 2, 3}) {
      for (const bool upper_first : {false, true}) {
        for (const double gap : {0.0, 1.0e-3}) {
          const Column column{
              .dim = dim, .floating = floating, .gap = gap, .upper_first = upper_first};
          SCOPED_TRACE(fmt::format("{}D, {} floating, upper first {}, gap {}", dim, floating,
                                   upper_first, gap));
          const auto run = column.run();
          ASSERT_TRUE(run->completed()) << run->end.reason;
          // What stabilises falls to a tenth and less of it with every step of constant load, six,
          // and forces are as good as the sweeps' tolerance.
          EXPECT_NEAR(reaction(*run, "y"), column.pressure, 2.0e-6 * column.pressure);
          for (int k = 1; k <= floating; ++k) {
            // Each block is shortened by p L / E, and its mean node has gone down by half of that
            // and by all of those below.
            const double down = column.pressure / Column::youngs * (k + 0.5) + k * gap;
            const std::string body = fmt::format("body.b{}.", k);
            // The sweeps' tolerance.
            EXPECT_NEAR(run->measure(body + "displacement.y.mean"), -down, 1.0e-6 * down);
            // Six such steps.
            EXPECT_LT(run->measure(body + "stabilisation.share"), 1.0e-6);
          }
          // Across a gap the force of a step's end does work of the mean of none and itself.
          const double drift = run->measure("energy.total.relative_drift_end");
          if (gap == 0.0) {
            EXPECT_NEAR(drift, 0.0, 1.0e-6);  // sweeps' tolerance
          }
        }
      }
    }
  }
}

/// Of a column between held blocks: where it presses, as its overlap says, which shortens blocks
/// like springs in a row; or the run says that it has not found the forces.
void expect_pressed_or_told(const Column& column, bool to_converge) {
  SCOPED_TRACE(fmt::format("{}D, {} floating, every other one {} times as stiff, metre {}",
                           column.dim, column.floating, column.unlike, column.metre));
  const auto run = column.run();
  if (to_converge) {
    ASSERT_TRUE(run->completed()) << run->end.reason;
  }
  if (!run->completed()) {
    const bool told = run->end.reason.find("not converged") != std::string::npos ||
                      run->end.reason.find("is held against moving") != std::string::npos;
    EXPECT_TRUE(told) << run->end.reason;
    return;
  }
  double softness = 0.0;
  for (int k = 0; k <= column.last(); ++k) softness += 1.0 / column.stiffness(k);
  const double force = column.overlap / softness * std::pow(column.metre, column.dim - 1);
  double share = 0.0;
  for (int k = 1; k <= column.floating; ++k)
    share = std::max(share, run->measure(fmt::format("body.b{}.stabilisation.share", k)));
  // The sweeps' tolerance at every contact of the column, and what stabilises, as it is told.
  const double allowed = force * (1.0e-6 * (column.last() + 1) + column.last() * share);
  EXPECT_NEAR(reaction(*run, "y"), force, allowed);
  EXPECT_NEAR(run->measure(fmt::format("body.b{}.ceiling.reaction.y", column.last())), -force,
              allowed);
}

TEST(StabilisedStatics, ColumnsBetweenHeldBlocksPressAsTheirOverlapSaysOrTellThatTheyDoNot) {
  for (const int dim : {2, 3}) {
    for (const double metre : {1.0, 1000.0}) {
      for (const int floating : {1, 2, 3})
        expect_pressed_or_told(
            {.dim = dim, .floating = floating, .overlap = 1.0e-3, .metre = metre}, true);
      for (const double unlike : {10.0, 0.1, 1000.0})
        for (const int floating : {2, 3})
          expect_pressed_or_told({.dim = dim,
                                  .floating = floating,
                                  .overlap = 1.0e-3,
                                  .unlike = unlike,
                                  .metre = metre},
                                 false);
    }
  }
  expect_pressed_or_told({.floating = 5, .overlap = 1.0e-3}, false);
}

/// Columns with overlaps that are pressed out, by one iteration, which is too few.
TEST(PassiveStatics, ColumnsPressAsTheirOverlapSays) {
  for (const int floating : {2, 3}) {
    const Column column{.floating = floating, .overlap = 1.0e-3};
    const auto run = column.run("max_iterations: 1");
    ASSERT_TRUE(run->completed()) << run->end.reason;
    EXPECT_GT(run->end.given_up.windows, 0);
    double softness = 0.0;
    for (int k = 0; k <= column.last(); ++k) softness += 1.0 / column.stiffness(k);
    const double force = column.overlap / softness;
    // Every contact is a ten-thousandth of an edge apart, which presses as more overlap does.
    const double allowed = force * (0.01 + column.last() * 1.0e-4 / column.overlap);
    EXPECT_NEAR(reaction(*run, "y"), force, allowed) << floating;
  }
}

/// A block that a support presses onto another one and drags along it, against friction: the work
/// is that which the accurate method finds.
TEST(PassiveStatics, SupportsWorkByTheForcesInWhichStepsEnd) {
  const Column column{.law = "neo_hookean"};
  const SolidText lower = column.block(0);
  SolidText upper = lower;
  upper.name = "b1";
  upper.sides = {"bottom"};
  upper.position = {0.0, 1.0};
  upper.more =
      "    constraints: {grip: {on: top, x: '0.05 * max(0, t - 2) / 8', y: '-1e-3 * min(t, 2)'}}\n";
  const auto work = [&](const std::string& schwarz, bool passive) {
    const auto run = run_solids(10, 1.0, {lower, upper},
                                "  j0: {sides: [b0.top, b1.bottom], contact: {friction: 0.3}}\n"
                                "schwarz: {" +
                                    schwarz + "}\n");
    EXPECT_TRUE(run->completed()) << run->end.reason;
    EXPECT_EQ(run->end.given_up.windows > 0, passive);
    return run->measure("body.b1.energy.external_work");
  };
  const double accurate = work("on_nonconvergence: stop", false);
  // Forces on nodes are right to some hundredths.
  EXPECT_NEAR(work("max_iterations: 1", true), accurate, 0.03 * accurate);
}

TEST(StabilisedStatics, WhatDoesNotConvergeIsToldWithItsRemedy) {
  // Springs that are weaker than what presses on a block over its height do not hold it upright
  // while sweeps look for its contacts.
  const auto run = Column{.floating = 3, .stabilisation = "stiffness: 1.0e-4"}.run();
  EXPECT_EQ(run->end.status, "failed");
  for (const char* words : {"not converged after 50 iterations",
                            "bodies.b1.integrator.quasi_static.stabilisation.stiffness"})
    EXPECT_NE(run->end.reason.find(words), std::string::npos) << run->end.reason;
}

TEST(StabilisedStatics, LoadsMayGrowToTheEnd) {
  for (const int dim : {2, 3}) {
    for (const char* law : {"linear_elastic", "neo_hookean", "saint_venant_kirchhoff"}) {
      const Column column{.dim = dim, .law = law, .rise = Column::windows};
      SCOPED_TRACE(fmt::format("{}D {}", dim, law));
      const auto run = column.run();
      ASSERT_TRUE(run->completed()) << run->end.reason;
      // sigma w E / L of a block that goes down by w, 1.5 times its shortening, by what the load
      // grows in the last short window: 0.005 of a tenth [M.143]. Strains of 2e-3 change that by
      // some of it.
      const double borne = 0.01 * 1.5 * 0.005 * 0.1;
      EXPECT_NEAR(run->measure("body.b1.stabilisation.share"), borne, 5 * 2.0e-3 * borne);
      // The sweeps' tolerance.
      EXPECT_NEAR(reaction(*run, "y"), (1.0 - borne) * column.pressure, 2.0e-6 * column.pressure);
    }
  }
}

/// A block at rest is pushed by what it touches at once, in the window in which that moves, through
/// what it is in by roundings of their places.
TEST(StabilisedStatics, OverlapsByRoundingsAreTouches) {
  for (const int dim : {2, 3}) {
    for (const double overlap : {1.0e-9, 1.0e-7}) {
      const Column column{.dim = dim, .floating = 2, .gap = -overlap};
      SCOPED_TRACE(fmt::format("{}D, {} m", dim, overlap));
      const auto run = column.run();
      ASSERT_TRUE(run->completed()) << run->end.reason;
      EXPECT_NEAR(reaction(*run, "y"), column.pressure, 2.0e-6 * column.pressure);  // as above
      // From the first window on: p L/E of the three below each middle, and what parts them.
      const double down = column.pressure / Column::youngs * 2.5 - 2.0 * overlap;
      EXPECT_NEAR(run->measure("body.b2.displacement.y.mean"), -down, 1.0e-6 * down);  // the same
      EXPECT_NEAR(run->measure("contact.j0.begin"), 1.0, 0.01);  // the end of the first window
    }
  }
}

/// Whether a run warns that forces before its end have a part that springs bore.
bool warns_of_forces_on_the_way(const RunResult& run) {
  return std::ranges::any_of(run.events, [](const RunEvent& event) {
    return event.kind == RunEvent::Kind::warning &&
           event.text.find("forces before the end are too large") != std::string::npos;
  });
}

TEST(StabilisedStatics, WhatLeansOnSomethingSoftSettlesBeforeTheEnd) {
  // Springs of a block that is 400 times as stiff as what it leans on, s = d 0.01 400 E, keep
  // s/(s + E) of their force in a step, nine tenths: four short windows are not enough.
  for (const int dim : {2, 3}) {
    const Column column{.dim = dim, .unlike = 400.0, .rise = Column::windows};
    SCOPED_TRACE(fmt::format("{}D", dim));
    const auto run = column.run();
    ASSERT_TRUE(run->completed()) << run->end.reason;
    const double borne = run->measure("body.b1.stabilisation.share");
    EXPECT_LT(borne, run->measure("body.b1.stabilisation.at_most"));
    EXPECT_TRUE(warns_of_forces_on_the_way(*run));
    // What springs do not bear, the block below does; the sweeps' tolerance.
    EXPECT_NEAR(reaction(*run, "y"), (1.0 - borne) * column.pressure, 2.0e-6 * column.pressure);
  }
}

TEST(StabilisedStatics, AnswersDoNotDependOnTheStiffness) {
  // A column bends: what stabilises it is to be weak beside that.
  Column column{
      .floating = 2, .friction = 0.3, .push = 400.0, .stabilisation = "stiffness: 1.0e-3"};
  const auto given = column.run();
  column.stabilisation = "stiffness: 5.0e-4";
  const auto half = column.run();
  ASSERT_TRUE(given->completed() && half->completed()) << given->end.reason << half->end.reason;
  for (const char* measure : {"body.b2.displacement.y.mean", "body.b2.displacement.x.mean"}) {
    const double value = given->measure(measure);
    // The load stands for the last six steps: what is left is what stuck while it grew, and the
    // sweeps' tolerance. Measured 3e-6.
    EXPECT_NEAR(half->measure(measure), value, 1.0e-5 * std::abs(value)) << measure;
  }
}

TEST(StabilisedStatics, BodiesOfFiniteStrainSettleToo) {
  const Column column{.law = "neo_hookean"};
  const auto run = column.run();
  ASSERT_TRUE(run->completed()) << run->end.reason;
  // A hundredth of what stabilises is left after every step of constant load: six.
  EXPECT_NEAR(reaction(*run, "y"), column.pressure, 1.0e-7 * column.pressure);
  EXPECT_LT(run->measure("body.b1.stabilisation.share"), 1.0e-7);  // as above
  EXPECT_FALSE(warns_of_forces_on_the_way(*run));
}

TEST(StabilisedStatics, FrictionBearsAPush) {
  for (const int dim : {2, 3}) {
    const Column column{.dim = dim,
                        .floating = 2,
                        .friction = 0.5,
                        .push = 400.0,
                        .stabilisation = "stiffness: 1.0e-3"};  // as above
    const auto run = column.run();
    ASSERT_TRUE(run->completed()) << dim << run->end.reason;
    // Of a column that sticks all goes down to the floor; stabilisation as above.
    EXPECT_NEAR(reaction(*run, "x"), -400.0, 1.0e-5 * 400.0) << dim;                     // sweeps
    EXPECT_NEAR(reaction(*run, "y"), column.pressure, 1.0e-6 * column.pressure) << dim;  // alike
  }
}

TEST(StabilisedStatics, WhatNothingHoldsEndsTheRun) {
  // More than friction can bear: 0.1 times 2 kN, and the rest is left to the stabilisation.
  const auto slides =
      Column{.friction = 0.1, .push = 400.0, .stabilisation = "stiffness: 0.1"}.run();
  EXPECT_EQ(slides->end.status, "failed");
  EXPECT_NE(slides->end.reason.find("body 'b1' is held against moving along +x by nothing"),
            std::string::npos)
      << slides->end.reason;
  const auto pulled = Column{.pressure = -2.0e3}.run();
  EXPECT_EQ(pulled->end.status, "failed");
  EXPECT_NE(pulled->end.reason.find("moving along +y"), std::string::npos) << pulled->end.reason;
  const auto asked =
      Column{.friction = 0.1, .push = 400.0, .stabilisation = "stiffness: 0.1, at_most: 1.0"}.run();
  EXPECT_TRUE(asked->completed()) << asked->end.reason;
}

/// A block of 200 N between walls that press it with 20 kN each, and rub or do not: what presses
/// across says nothing of the way down.
TEST(StabilisedStatics, AreNotHeldAlongByWhatPressesAcross) {
  const auto clamped = [](const char* friction) {
    const auto wall = [](const char* name, const char* way, double place, const char* side) {
      return fmt::format(
          R"(  {}:
    model:
      rigid_tool:
        dimension: 2
        mesh: {{rectangle: {{lengths: [0.1, 1], elements: [1, 1]}}}}
        way: ["{}", "0"]
    initial: {{position: [{}, -0.5]}}
    ports: {{side: {{side: {}}}}}
)",
          name, way, place, side);
    };
    return run_text("time: {end: 1, window: 0.25}\nbodies:\n" +
                    wall("left", "1.0e-3*t", -0.1, "right") +
                    wall("right", "-1.0e-3*t", 0.1, "left") +
                    fmt::format(R"(  block:
    model:
      fe:
        dimension: 2
        plane: stress
        mesh: {{rectangle: {{lengths: [0.1, 0.2], elements: [5, 8]}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e7, poissons_ratio: 0.0, density: 1000}}}}
    integrator: {{quasi_static: {{step: 0.25}}}}
    body_force: [0, -10]
    ports: {{left: {{side: left}}, right: {{side: right}}}}
interfaces:
  one: {{sides: [block.left, left.side], contact: {{friction: {0}}}}}
  other: {{sides: [block.right, right.side], contact: {{friction: {0}}}}}
)",
                                friction));
  };
  const auto slips = clamped("0");
  EXPECT_EQ(slips->end.status, "failed");
  EXPECT_NE(slips->end.reason.find("'block' is held against moving along -y by nothing"),
            std::string::npos)
      << slips->end.reason;
  // Of all forces it is little, which alone is allowed at the end.
  EXPECT_LT(slips->measure("body.block.stabilisation.share"), 0.01);
  const auto held = clamped("0.05");  // of 40 kN: ten times the weight
  ASSERT_TRUE(held->completed()) << held->end.reason;
  // What sweeps leave.
  EXPECT_LT(held->measure("body.block.stabilisation.share_along"), 1.0e-6);
}

TEST(StabilisedStatics, KeysWithoutEffectAreRefused) {
  Column column;
  SolidText held = column.block(1);
  held.integrator = "quasi_static: {step: 1.0, stabilisation: {}}";
  held.more = "    constraints: {lid: {on: top, fixed: true}}\n";
  const std::string message = refusal([&] {
    run_solids(1.0, 1.0, {column.block(0), held},
               "  j: {sides: [b0.top, b1.bottom], contact: {}}\n");
  });
  EXPECT_NE(message.find("stabilisation: has no effect"), std::string::npos) << message;
}

}  // namespace
}  // namespace abut::stabilised_statics_tests
