// Goal: what slides along a side at hardly any distance, or none, passes the end of that side: the
// facet behind the end is no nearer to it than the side. Oracle: free fall.

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

constexpr double g = 9.81;  // [m/s^2]
/// Of the way: normals of sides that have turned by what impulses of nothing are off by. Pegs that
/// were held by the guides' ends came to half of their way at most.
constexpr double of_normals = 1.0e-6;

struct Fit {
  int dim;
  std::string model;
  double clearance;  // [m]
};

void PrintTo(const Fit& fit, std::ostream* out) {
  *out << fit.model << " in " << fit.dim << " dimensions, " << fit.clearance << " m apart";
}

std::vector<double> along_last(int dim, double across, double along) {
  return dim == 2 ? std::vector{across, along} : std::vector{across, across, along};
}

/// Guides on two or four sides of a peg that falls past their lower ends.
std::vector<SolidText> guided(const Fit& fit) {
  const int dim = fit.dim;
  const bool rigid = fit.model == "rigid";
  const std::vector<double> size = along_last(dim, 0.06, 0.1);
  std::vector<double> weight(index(dim), 0.0);
  weight.back() = -g;
  std::vector<SolidText> bodies = {
      {.name = "peg",
       .material = "neo_hookean: {youngs_modulus: 1.0e8, poissons_ratio: 0.3, density: 2000.0}",
       .integrator = rigid ? "rigid_motion: {step: 1.0e-3}" : "newmark: {step: 1.0e-3}",
       .position = std::vector<double>(index(dim), 0.0),
       .port = "skin",
       .side = "boundary",
       .model = fit.model,
       .more = fmt::format("    body_force: [{}]\n", fmt::join(weight, ", ")),
       .block = block_in(dim, size, std::vector<int>(index(dim), 2))}};
  for (int axis = 0; axis + 1 < dim; ++axis) {
    for (const double way : {-0.05 - fit.clearance, 0.06 + fit.clearance}) {
      std::vector<double> place = along_last(dim, -0.02, -0.03);
      std::vector<double> lengths = along_last(dim, 0.1, 0.1);
      place[index(axis)] = way;
      lengths[index(axis)] = 0.05;
      bodies.push_back({.name = fmt::format("guide{}", bodies.size()),
                        .position = place,
                        .port = "skin",
                        .side = "boundary",
                        .model = "rigid_tool",
                        .block = block_in(dim, lengths, std::vector<int>(index(dim), 1))});
    }
  }
  return bodies;
}

class PassivePastCorners : public testing::TestWithParam<Fit> {};

TEST_P(PassivePastCorners, WhatFitsFallsFreely) {
  constexpr double end = 0.1;
  const Fit& fit = GetParam();
  const auto run = run_solids(end, 1.0e-3, guided(fit), "", "contact: {everything: {}}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const double fallen = run->rows.back().work[0] / (run->masses[0] * g);  // by what weight has done
  EXPECT_NEAR(fallen, 0.5 * g * end * end, of_normals * 0.5 * g * end * end);
}

INSTANTIATE_TEST_SUITE_P(Fits, PassivePastCorners,
                         testing::Values(Fit{2, "rigid", 0.0}, Fit{2, "rigid", 1.0e-6},
                                         Fit{2, "rigid", 1.0e-4}, Fit{2, "fe", 0.0},
                                         Fit{2, "fe", 1.0e-6}, Fit{3, "rigid", 0.0},
                                         Fit{3, "rigid", 1.0e-6}, Fit{3, "fe", 0.0}));

}  // namespace
}  // namespace abut
