// Goal: joined faces of many rows take few calls of the bodies, and memory and probes that do not
// grow with the square of the face. Oracles: kernels of all rows on all others, and the counts of
// calls that method-independent theory gives: one where no wave leaves the band, one or two more
// where some do.

#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "coordinator/couple.hpp"
#include "coordinator/tied_estimate.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::tied_bands_tests {
namespace {

/// Two slabs that a face of `across` cells in each direction joins, of unit modulus and density,
/// five cells thick, whose every part moves otherwise; the first one has the longer steps.
struct Slabs {
  int dim = 2;
  std::vector<int> across = {16, 16};
  std::string schemes = "EE";
  double courant = 0.27;  // of the longer step on the first mesh
  double ratio = 1.0;     // of the steps
  int steps = 10;         // the longer ones, of a window
  int windows = 20;
  double tolerance = 1.0e-4;
  std::string schwarz = "ties: {band: waves}";
  std::string partner = "fe";  // model of the second slab

  double step() const { return courant / across[0] / std::sqrt(1.2); }  // plane strain, nu = 1/4

  SolidText body(std::size_t k) const {
    const double thick = 5.0 / across[0];
    SolidText out{
        .name = k == 0 ? "one" : "two",
        .material = unit_law("linear_elastic", 0.25),
        .integrator = scheme_named(schemes[k], k == 0 ? step() : step() / ratio),
        .position = {k == 0 ? 0.0 : thick},
        .side = k == 0 ? "right" : "left",
        .block = {std::vector<double>(index(dim), 1.0), std::vector<int>(index(dim), across[k])}};
    out.block.lengths[0] = thick;
    out.block.cells[0] = (5 * across[k] + across[0] - 1) / across[0];
    if (k == 1 && partner != "fe") {  // stands at the start
      out.model = partner;
      out.velocity = {0.0};
      if (partner == "modal") out.keys = "modes: 12, ";
      if (partner == "rigid") out.integrator = scheme_named('R', step() / ratio);
    } else {
      out.field = fmt::format("\"sin(2*x + 5*y)\", \"0.3*cos(3*x + 7*y)\"{}",
                              dim == 3 ? ", \"sin(6*z - y)\"" : "");
    }
    return out;
  }
  Document document() const {
    const double window = steps * step();
    return Document::from_text(
        "test", scene_text(windows * window, window, texts_of({body(0), body(1)}),
                           "interfaces:\n" + joined("tie", "one.face", "two.face") +
                               fmt::format("schwarz: {{tolerance: {}, {}}}\n", number(tolerance),
                                           schwarz)));
  }
  ResultPtr run() const { return run_document(document()); }
  Estimate::Ties estimate() const {
    const Document text = document();
    const Scene scene = read_scene(text);
    const std::vector<std::unique_ptr<Subdomain>> here = launch_local(scene, text);
    std::vector<Subdomain*> pointers;
    for (const std::unique_ptr<Subdomain>& body : here) pointers.push_back(body.get());
    Bodies bodies(pointers, scene.time.window);
    std::vector<Joint> joints = make_joints(scene, bodies);
    return estimate_ties(scene, joints, bodies).at(0);
  }
};

/// Beside the first window, which has a trial as well.
double calls(const RunResult& run) {
  const double windows = run.measure("windows");
  return (windows * run.measure("schwarz.iterations_mean") - 1.0) / windows;
}

const char* const motion[] = {"body.two.displacement.x.max", "body.two.displacement.y.min",
                              "body.one.displacement.x.mean", "body.two.energy.stored"};

/// As wide as the face, or as waves come in one explicit step: nothing is left out, and the rows
/// that are pressed at once do not disturb each other.
TEST(TiedBands, WholeBandsAreTheKernelOfAllRows) {
  std::vector<Slabs> all;
  for (const char* schemes : {"EE", "II", "IE", "EI"})
    for (const double ratio : {1.0, 4.0, 7.3})
      all.push_back(
          {.across = {6, 8}, .schemes = schemes, .ratio = ratio, .schwarz = "ties: {band: 9}"});
  all.push_back({.across = {12, 16}, .steps = 1});
  all.push_back({.dim = 3, .across = {20, 20}, .steps = 1, .windows = 5});
  all.push_back({.dim = 3, .across = {6, 9}, .steps = 1, .windows = 5});
  for (const Slabs& slabs : all) {
    SCOPED_TRACE(slabs.document().text());
    Slabs other = slabs;
    other.schwarz = "ties: {band: auto}";
    const auto band = slabs.run(), dense = other.run();
    ASSERT_TRUE(band->completed());
    EXPECT_EQ(band->measure("schwarz.iterations_mean"), dense->measure("schwarz.iterations_mean"));
    for (const char* what : motion)
      // of the order of 0.1 to 1; rounding of some hundred steps
      EXPECT_NEAR(band->measure(what), dense->measure(what), 1.0e-11) << what;
    EXPECT_TRUE(slabs.estimate().banded);
    EXPECT_FALSE(other.estimate().banded);
  }
}

/// Bands of so many nodes as waves cross in a window, and of twice as many.
TEST(TiedBands, TakeFewCalls) {
  for (const double courant : {0.27, 0.54}) {
    const int cone = static_cast<int>(std::ceil(10.0 * courant));
    for (const char* schemes : {"EE", "II"}) {
      SCOPED_TRACE(fmt::format("{} {}", schemes, courant));
      Slabs slabs{.across = {32, 32}, .schemes = schemes, .courant = courant};
      const auto with = [&slabs](int rows) {
        slabs.schwarz = fmt::format("ties: {{band: {}}}", rows);
        return calls(*slabs.run());
      };
      // Goals of the method, whose trial is a call of its own: 3.0 and 2.0.
      EXPECT_LE(with(cone), 2.0);
      EXPECT_LE(with(2 * cone), 1.0);
      EXPECT_GT(with(1), 2.0);  // what bands are for
    }
  }
}

/// What is chosen: 2 at most at a tolerance of 1e-4, 3 at 1e-6, whatever schemes and steps.
TEST(TiedBands, AsFarAsWavesComeTakeFewCalls) {
  for (const double tolerance : {1.0e-4, 1.0e-6}) {
    for (const char* schemes : {"EE", "II", "IE", "EI"}) {
      for (const double ratio : {1.0, 4.0, 7.3}) {
        SCOPED_TRACE(fmt::format("{} {} {}", tolerance, schemes, ratio));
        const auto run =
            Slabs{.across = {12, 16}, .schemes = schemes, .ratio = ratio, .tolerance = tolerance}
                .run();
        ASSERT_TRUE(run->completed());
        EXPECT_LE(calls(*run), tolerance > 1.0e-5 ? 2.0 : 3.0);
        // Work of what is missed: the square of the tolerance's part of the way in a step.
        EXPECT_NEAR(run->measure("energy.total.relative_drift_max"), 0.0, 1.0e-5);
      }
    }
  }
}

/// Faces of two and of four times as many nodes take as many probes, and twice, four times (in
/// space four, sixteen times) the memory.
TEST(TiedBands, ProbesDoNotGrowWithTheFace) {
  for (const int dim : {2, 3}) {
    const int across = dim == 2 ? 60 : 20, steps = dim == 2 ? 10 : 2;
    const auto cost = [&](int times) {
      return Slabs{.dim = dim, .across = {across * times, across * times}, .steps = steps}
          .estimate();
    };
    const Estimate::Ties one = cost(1), two = cost(2);
    EXPECT_LE(static_cast<double>(two.probes), 1.05 * static_cast<double>(one.probes));
    // Rows at the rim have fewer neighbours.
    EXPECT_NEAR(two.memory_mib / one.memory_mib, dim == 2 ? 2.0 : 4.0, 0.4);
    EXPECT_EQ(two.joints.at(0).rows, std::lround(std::pow(2 * across + 1, dim - 1)));
  }
}

/// Where not even the way of waves fits, bands are narrower, and what they miss is iterated.
TEST(TiedBands, FitTheMemoryThatIsGiven) {
  Slabs slabs{.across = {24, 32}, .schwarz = "ties: {memory: 8}"};
  EXPECT_FALSE(slabs.estimate().banded);
  double last = 0.0;
  for (const double memory : {0.5, 0.3, 0.2}) {
    SCOPED_TRACE(memory);
    slabs.schwarz = fmt::format("ties: {{memory: {}}}", memory);
    const Estimate::Ties ties = slabs.estimate();
    EXPECT_TRUE(ties.banded);
    EXPECT_EQ(ties.narrow, memory < 0.4);
    EXPECT_LE(ties.memory_mib, memory);
    const auto run = slabs.run();
    ASSERT_TRUE(run->completed());
    EXPECT_GT(calls(*run), last);
    last = calls(*run);
  }
}

/// A kernel of one step that is too large as well.
TEST(TiedBands, FitOneStep) {
  const Slabs slabs{.across = {24, 32}, .steps = 1, .schwarz = "ties: {memory: 0.06}"};
  EXPECT_TRUE(slabs.estimate().banded);
  EXPECT_LE(slabs.estimate().memory_mib, 0.06);
  EXPECT_LE(calls(*slabs.run()), 1.0);
}

/// Four blocks around a point, where rows say the same twice: forces that move nothing stay small.
TEST(TiedBands, NetsWithRedundantRowsConverge) {
  const auto run = run_file(std::string(ABUT_SOURCE_DIR) + "/configs/joined/blocks_2x2x2.yaml",
                            {"schwarz.ties.band=waves", "time.end=2.0"});
  ASSERT_TRUE(run->completed());
  EXPECT_LE(run->measure("schwarz.iterations_mean"), 3.0);
  EXPECT_NEAR(run->measure("energy.total.relative_drift_max"), 0.0, roundoff(1.0e5, 1.0));
}

/// Without kernels, for comparison: the force is relaxed, and the longer windows are, the worse.
TEST(TiedBands, AitkenTakesMoreCalls) {
  double last = 3.0;
  for (const int steps : {1, 2}) {
    Slabs slabs{.steps = steps, .schwarz = "accelerator: {aitken: {}}"};
    EXPECT_FALSE(slabs.estimate().used);
    const auto relaxed = slabs.run();
    ASSERT_TRUE(relaxed->completed());
    EXPECT_GT(relaxed->measure("schwarz.iterations_mean"), last);
    last = relaxed->measure("schwarz.iterations_mean");
    EXPECT_NEAR(relaxed->measure("energy.total.relative_drift_max"), 0.0,
                1.0e-6);  // windows end at 1e-4, squared and summed
  }
}

/// What does not feel its far rows through waves, a rigid body and one of modes, is left to
/// secants.
TEST(TiedBands, RigidAndModalBodiesConverge) {
  for (const char* body : {"rigid", "modal"}) {
    SCOPED_TRACE(body);
    Slabs slabs{.across = {8, 8}, .schemes = "EI", .windows = 40, .partner = body};
    const auto run = slabs.run();
    ASSERT_TRUE(run->completed());
    EXPECT_LE(calls(*run), 8.0);
  }
}

}  // namespace
}  // namespace abut::tied_bands_tests
