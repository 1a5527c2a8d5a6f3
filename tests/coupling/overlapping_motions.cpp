// Goal: bodies that overlap are in equilibrium as one body would be, in either form; and motions
// alone, as in alternating Schwarz with Dirichlet data, do what they can: statics on any meshes, in
// time what is the same in both bodies. Oracles: the undivided body, and theory: the rate of
// alternating Schwarz, which overlaps quicken, and the growth of pairs that are not alike.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/support/overlapping_pair.hpp"

namespace abut::overlapping_motions_tests {
namespace {

const std::string motions = "overlap: {exchange: motions}";
const std::string alternating = "overlap: {exchange: motions, answer: alternating}";

/// Of a pair, or of the body that is there alone.
double extreme(const RunResult& run, const std::string& component, const std::string& end) {
  const auto of = [&](const char* body) {
    return run.measure(fmt::format("body.{}.displacement.{}.{}", body, component, end));
  };
  if (run.masses.size() == 1) return of("left");
  return end == "min" ? std::min(of("left"), of("right")) : std::max(of("left"), of("right"));
}

/// Clamped on the left, loaded on the right.
OverlappingPair in_equilibrium(const std::string& traction) {
  OverlappingPair pair{.schemes = "SS", .step = 0.5, .start = ""};
  pair.more = {"    constraints: {clamp: {on: left, fixed: true}}\n",
               fmt::format("    loads: {{pull: {{on: right, traction: [{}]}}}}\n", traction)};
  pair.schwarz = "tolerance: 1.0e-9";
  return pair;
}

/// `reference`: undivided, or a pair.
void expect_same(const RunResult& divided, const RunResult& reference, double share,
                 const std::string& trace) {
  SCOPED_TRACE(trace);
  ASSERT_TRUE(divided.completed());
  ASSERT_TRUE(reference.completed());
  double most = 0.0;
  for (const char* component : {"x", "y"})
    for (const char* end : {"min", "max"})
      most = std::max(most, std::abs(extreme(reference, component, end)));
  for (const char* component : {"x", "y"})
    for (const char* end : {"min", "max"})
      EXPECT_NEAR(extreme(divided, component, end), extreme(reference, component, end),
                  share * most)
          << component << end;
}

/// Nodes on nodes: either form is the undivided body, stretched and bent, whatever the law.
TEST(OverlappingStatics, AreTheWhole) {
  for (const char* law : {"linear_elastic", "neo_hookean"}) {
    for (const char* traction : {"1.0e-2*t, 0.0", "0.0, 1.0e-4*t"}) {
      for (const double overlap : {0.5, 1.0, 2.0}) {
        OverlappingPair pair = in_equilibrium(traction);
        pair.law = law;
        pair.overlap = overlap;
        const auto whole = pair.run_whole(1.0, 0.5);
        for (const std::string& tied : {std::string("overlap: {}"), motions}) {
          pair.tied = tied;
          const auto divided = pair.run(1.0, 0.5);
          // What the tolerance of the sweeps and Newton's method leave.
          expect_same(*divided, *whole, 1.0e-7,
                      fmt::format("{} {} {} {}", law, traction, overlap, tied));
          if (*law == 'l') {
            EXPECT_LE(divided->measure("schwarz.iterations_max"), 2.0);
          }
        }
      }
    }
  }
}

/// In space too: facets warp where contraction is held or sections twist, and nodes on nodes tell
/// all of it.
TEST(OverlappingStatics, AreTheWholeInSpace) {
  for (const char* law : {"linear_elastic", "neo_hookean"}) {
    for (const char* traction : {"1.0e-2*t, 0.0, 0.0", "0.0, 1.0e-4*t, 0.0",
                                 "0.0, \"-1.0e-3*t*(z - 0.5)\", \"1.0e-3*t*(y - 0.5)\""}) {
      for (const int across : {1, 2}) {
        OverlappingPair pair = in_equilibrium(traction);
        pair.dim = 3;
        pair.across = {across, across};
        pair.overlap = 2.0 / across;
        pair.poissons_ratio = 0.3;
        pair.law = law;
        pair.length = 4.0;
        const auto whole = pair.run_whole(1.0, 0.5);
        for (const std::string& tied : {std::string("overlap: {}"), motions}) {
          pair.tied = tied;
          // What the tolerance of the sweeps and Newton's method leave.
          expect_same(*pair.run(1.0, 0.5), *whole, 1.0e-7,
                      fmt::format("{} {} {} {}", law, traction, across, tied));
        }
      }
    }
  }
}

/// Unlike meshes: with forces the pair bends as either mesh would alone, within what meshes differ
/// by. Motions alone lose some of the moment at the sides: a percent, measured 0.2 and 1.5.
TEST(OverlappingStatics, OfUnlikeMeshesBendAsEither) {
  OverlappingPair pair = in_equilibrium("0.0, 1.0e-5*t");
  std::vector<double> bent;
  for (const int across : {4, 6}) {
    OverlappingPair one = pair;
    one.across = {across, across};
    bent.push_back(one.run_whole(1.0, 0.5)->measure("body.left.displacement.y.max"));
  }
  for (const std::string& tied : {std::string("overlap: {}"), motions}) {
    for (const double shift : {0.0, 0.1}) {
      pair.across = {4, 6};
      pair.tied = tied;
      pair.shift = shift;
      const auto divided = pair.run(1.0, 0.5);
      ASSERT_TRUE(divided->completed());
      const double y = extreme(*divided, "y", "max");
      EXPECT_NEAR(y, bent[1], 0.02 * bent[1]) << tied << shift;
      if (tied == motions) continue;
      EXPECT_GT(y, bent[0]) << shift;
      EXPECT_LT(y, bent[1]) << shift;
    }
  }
}

/// Iterations of alternating Schwarz in equilibrium, by overlap: each converges to the same, and
/// wider overlaps need fewer. With secants a few do.
TEST(OverlappingStatics, AlternatingSchwarzConvergesByItsOverlap) {
  OverlappingPair pair = in_equilibrium("1.0e-3*t, 0.0");
  pair.step = 1.0;
  pair.tied = motions;
  const auto together = pair.run(1.0, 1.0);
  const double x = extreme(*together, "x", "max");
  pair.tied = alternating;
  std::vector<double> plain;
  for (const double overlap : {0.5, 1.0, 2.0}) {
    pair.overlap = overlap;
    for (const char* accelerator : {"none", "aitken", "anderson"}) {
      pair.schwarz = fmt::format(
          "tolerance: 1.0e-8, max_iterations: 1000, accelerator: {{{}: {{}}}}", accelerator);
      const auto run = pair.run(1.0, 1.0);
      ASSERT_TRUE(run->completed()) << overlap << accelerator;
      EXPECT_NEAR(extreme(*run, "x", "max"), x, 2.0e-8 * x);  // as below
      const double count = run->measure("schwarz.iterations_max");
      if (accelerator[0] == 'n') plain.push_back(count);
      if (accelerator[1] == 'n') {
        EXPECT_LE(count, 13.0) << overlap;  // 12 until the last change is as small
      }
    }
  }
  // A stretched bar of length 6 leaves (1 - overlap/6) / (1 + overlap/6) in a pair of sweeps: with
  // twice the overlap half the iterations, but for a few.
  EXPECT_NEAR(plain[1] / plain[0], 0.5, 0.05);
  EXPECT_NEAR(plain[2] / plain[1], 0.5, 0.05);
}

/// The tolerance is of how far the sides still are from where they will be, not of the last change,
/// which of 8 % a sweep is a twelfth of it. What is left is told by how changes fall, to a factor
/// of two while the slowest part is not yet alone.
TEST(OverlappingStatics, AlternatingSchwarzEndsWithinItsTolerance) {
  for (const char* traction : {"1.0e-3*t, 0.0", "0.0, 1.0e-6*t"}) {
    const char* component = traction[0] == '1' ? "x" : "y";
    for (const double overlap : {0.5, 1.0, 2.0}) {
      OverlappingPair pair = in_equilibrium(traction);
      pair.step = 1.0;
      pair.overlap = overlap;
      pair.tied = motions;
      const double whole = extreme(*pair.run(1.0, 1.0), component, "max");
      pair.tied = alternating;
      for (const char* accelerator : {"none", "aitken", "anderson"}) {
        // Thousands of sweeps.
        if (*component == 'y' && *accelerator != 'a' && overlap < 2.0) continue;
        if (*component == 'y' && accelerator[1] == 'i') continue;
        for (const double tolerance : {1.0e-2, 1.0e-3, 1.0e-4, 1.0e-5}) {
          SCOPED_TRACE(fmt::format("{} {} {} {}", traction, overlap, accelerator, tolerance));
          pair.schwarz =
              fmt::format("tolerance: {}, max_iterations: 10000, accelerator: {{{}: {{}}}}",
                          tolerance, accelerator);
          const auto run = pair.run(1.0, 1.0);
          ASSERT_TRUE(run->completed());
          EXPECT_NEAR(extreme(*run, component, "max"), whole, 2.0 * tolerance * whole);
        }
      }
    }
  }
}

/// In time, bodies that are the same where both are move as the whole: of central differences as
/// the pair that exchanges forces, whose form begins half a drift later than that of a body alone.
TEST(OverlappingMotions, OfTwinsMoveAsTheWhole) {
  for (const int dim : {2, 3}) {
    for (const char* schemes : {"II", "EE"}) {
      OverlappingPair pair{.dim = dim, .across = {2, 2}, .schemes = schemes, .tied = motions};
      if (dim == 3) pair.start = "velocity_field: [\"x - 2*y\", \"0.5*x + z\", \"y\"]";
      const auto divided = pair.run(4.0, 0.2);
      OverlappingPair other = pair;
      other.tied = "overlap: {}";
      const auto reference = schemes[0] == 'I' ? pair.run_whole(4.0, 0.2) : other.run(4.0, 0.2);
      // Round-off of some hundred steps, and what Newton's method leaves.
      expect_same(*divided, *reference, 1.0e-8, fmt::format("{} {}", dim, schemes));
      EXPECT_LE(divided->measure("schwarz.iterations_mean"), 1.05);
    }
  }
}

/// What is refused, and why: pairs that are not alike gain energy that nobody gives.
TEST(OverlappingMotions, OfOthersGainEnergy) {
  const auto grown = [](OverlappingPair pair) {
    pair.step = 0.01;
    pair.tied = "overlap: {exchange: motions, unstable: true}";
    const auto run = pair.run(120.0, 0.2);
    double after = 0.0;
    for (const char* body : {"left", "right"})
      for (const char* kind : {"stored", "kinetic"})
        after += run->measure(fmt::format("body.{}.energy.{}", body, kind));
    return after / run->measure("energy.total.begin");
  };
  // Energy that is counted twice in the overlap may look like 7/6 of itself, no more.
  EXPECT_LT(grown({}), 1.5);
  EXPECT_GT(grown({.across = {4, 6}}), 10.0);
  EXPECT_GT(grown({.schemes = "IE"}), 10.0);
}

}  // namespace
}  // namespace abut::overlapping_motions_tests
