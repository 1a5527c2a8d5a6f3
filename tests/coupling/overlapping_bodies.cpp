// Goal: bodies that overlap move as one body would, whatever their meshes, steps and integrators,
// as joined ones do. Oracles: the energy identity [M.106], balance of momentum and mass, the
// undivided body, linear fields, and what a pulse leaves behind.

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/support/overlapping_pair.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::overlapping_bodies_tests {
namespace {

double sum(const RunResult& run, const std::string& what) {
  return run.measure("body.left." + what) + run.measure("body.right." + what);
}

/// Accumulated rounding of a run of some hundred steps, relative.
constexpr double rounding = 1.0e-11;

struct Combination {
  std::string schemes;
  double ratio = 1.0, overlap = 1.0;
  std::vector<int> across;
  int dim = 2;
};

void PrintTo(const Combination& c, std::ostream* out) {
  *out << fmt::format("{} {} {} {} {}d", c.schemes, c.ratio, c.overlap, fmt::join(c.across, ":"),
                      c.dim);
}

std::vector<Combination> combinations() {
  std::vector<Combination> out;
  for (const double overlap : {0.5, 1.0, 2.0})
    for (const std::vector<int>& across : {std::vector<int>{4, 4}, {4, 6}, {3, 4}}) {
      for (const char* schemes : {"II", "IE", "EI", "EE"})
        out.push_back({schemes, 1.0, overlap, across});
      out.push_back({"IE", 4.0, overlap, across});
    }
  out.push_back({"EE", 7.3, 1.0, {4, 6}});
  out.push_back({"IE", 2.0, 1.0, {2, 3}, 3});
  return out;
}

class OverlappingCombination : public testing::TestWithParam<Combination> {};
INSTANTIATE_TEST_SUITE_P(Combinations, OverlappingCombination, testing::ValuesIn(combinations()));

/// Unlike meshes, where prescribed motion at the cuts would gain 2e3 to 1e4 of 1/s.
TEST_P(OverlappingCombination, KeepsEnergyAndMomentumInOneCallPerWindow) {
  const Combination& c = GetParam();
  OverlappingPair pair{.dim = c.dim,
                       .overlap = c.overlap,
                       .across = c.across,
                       .schemes = c.schemes,
                       .ratio = c.ratio};
  if (c.dim == 3) pair.start = "velocity_field: [\"x - 2*y\", \"0.5*x + z\", \"y\"]";
  const auto result = pair.run(4.0, 0.2);
  ASSERT_TRUE(result->completed());
  EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, rounding);
  // Newton's method leaves 1e-9 of the forces in every step of implicit bodies.
  EXPECT_LE(result->measure("momentum.total"), c.schemes == "EE" ? 1.0e-12 : 1.0e-7);
  EXPECT_LE(result->measure("schwarz.iterations_mean"), 1.05);
}

/// Each body has half of the material where both are, however cells are cut: mass and momentum are
/// those of one body.
TEST(OverlappingBodies, ShareTheMaterial) {
  for (const int dim : {2, 3}) {
    for (const char* cell : {"", "simplex"}) {
      for (const double shift : {0.0, 0.1}) {
        OverlappingPair pair{.dim = dim, .across = {2, 3}, .shift = shift};
        if (*cell != 0) pair.cells = {"", dim == 2 ? "tri3" : "tet4"};
        pair.start = dim == 2 ? "velocity: [1.0, 0.0]" : "velocity: [1.0, 0.0, 0.0]";
        const auto result = pair.run(0.2, 0.2);
        ASSERT_TRUE(result->completed());
        EXPECT_NEAR(sum(*result, "momentum.x"), 6.0, roundoff(600.0, 6.0));  // nodes times steps
      }
    }
  }
}

/// Nodes on nodes: the pair is the undivided body.
TEST(OverlappingBodies, ConformingOnesMoveAsTheWhole) {
  for (const char* schemes : {"II", "EE"}) {
    const OverlappingPair pair{.schemes = schemes};
    const auto divided = pair.run(4.0, 0.2);
    const auto whole = pair.run_whole(4.0, 0.2);
    for (const char* what : {"momentum.y", "energy.stored"}) {
      // Central differences of a body that nobody joins hold their energy at other times.
      if (schemes[0] == 'E' && what[0] == 'e') continue;
      EXPECT_NEAR(sum(*divided, what), whole->measure(fmt::format("body.left.{}", what)),
                  roundoff(125.0 * 200.0, 1.0))  // nodes times steps

          << schemes << " " << what;
    }
  }
}

/// A uniform stretch between held ends stays at rest, wherever cuts cross the partner's cells.
TEST(OverlappingBodies, LinearFieldsPass) {
  const auto check = [](OverlappingPair pair, const std::string& trace) {
    SCOPED_TRACE(trace);
    pair.poissons_ratio = 0.0;
    pair.start = pair.dim == 2 ? "displacement_field: [\"0.01*x\", \"0\"]"
                               : "displacement_field: [\"0.01*x\", \"0\", \"0\"]";
    pair.more = {"    constraints: {end: {on: left, x: 0}}\n",
                 "    constraints: {end: {on: right, x: 0.06}}\n"};
    const auto result = pair.run(2.0, 0.2);
    ASSERT_TRUE(result->completed());
    for (const char* body : {"left", "right"}) {
      for (const char* end : {"min", "max"}) {
        // 1 % of a modulus of one: 1e-10 of it
        EXPECT_NEAR(result->measure(fmt::format("body.{}.nodal_stress.xx.{}", body, end)), 0.01,
                    1.0e-12);
        EXPECT_NEAR(result->measure(fmt::format("body.{}.displacement.y.{}", body, end)), 0.0,
                    1.0e-12);
      }
    }
  };
  for (const char* schemes : {"II", "IE", "EE"}) {
    for (const double shift : {0.0, 0.07}) {
      check({.overlap = 2.0, .across = {4, 6}, .schemes = schemes, .shift = shift},
            fmt::format("{} {} wide", schemes, shift));
      for (const std::vector<int>& across : {std::vector<int>{4, 4}, {4, 6}, {3, 5}})
        for (const char* cell : {"quad4", "tri3"})
          check({.across = across, .schemes = schemes, .cells = {"quad4", cell}, .shift = shift},
                fmt::format("{} {} {} {}", schemes, shift, fmt::join(across, ":"), cell));
      for (const char* cell : {"hex8", "tet4"})
        check({.dim = 3,
               .across = {2, 3},
               .schemes = schemes,
               .cells = {"hex8", cell},
               .shift = shift},
              fmt::format("{} {} {}", schemes, shift, cell));
    }
  }
}

/// Share of the energy of a pulse, of two of the coarser cells, that stays on its side.
double left_behind(const std::vector<int>& across, double overlap, const std::string& tied) {
  OverlappingPair pair{
      .overlap = overlap, .across = across, .schemes = "EE", .poissons_ratio = 0.0, .tied = tied};
  const double width = 2.0 / *std::ranges::min_element(across);
  const double begin = 4.5 * width, end = begin + overlap + 9.0 * width;
  pair.length = end + 4.5 * width;
  const std::string hump = fmt::format("exp(-(x-{})^2/{})", begin, 2.0 * width * width);
  pair.start = fmt::format(
      "displacement_field: [\"{0}\", \"0\"], velocity_field: [\"(x-{1})/{2}*{0}\", \"0\"]", hump,
      begin, width * width);
  const auto result = pair.run(std::round(end - begin), 0.2);
  const double all = sum(*result, "energy.stored") + sum(*result, "energy.kinetic");
  return (result->measure("body.left.energy.stored") +
          result->measure("body.left.energy.kinetic")) /
         all;
}

/// Over overlaps within the height of the bar, and beyond it, where nodes between the sides follow:
/// if they did not, three heights would leave 2e-3 behind. Ties of such meshes leave 2e-4 to 8e-4.
TEST(OverlappingBodies, LetPulsesThrough) {
  for (const double overlap : {0.5, 1.0, 2.0, 3.0}) {
    for (const std::vector<int>& across : {std::vector<int>{4, 4}, {4, 6}, {3, 4}, {6, 4}}) {
      const double left = left_behind(across, overlap, "overlap: {}");
      // as ties of such meshes leave
      EXPECT_LE(left, 1.0e-3) << overlap << " " << fmt::format("{}", fmt::join(across, ":"));
    }
  }
  // Why they have halves.
  const double left = left_behind({4, 6}, 1.0, "overlap: {material: doubled}");
  EXPECT_GT(left, 0.1);
}

}  // namespace
}  // namespace abut::overlapping_bodies_tests
