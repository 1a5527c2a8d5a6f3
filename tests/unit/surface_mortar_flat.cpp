// Goal: mortar rows between flat faces are exact whatever the meshes are, slivers included.
// Oracle: identities (sums of one, adjointness, balance of forces and moments), linear fields, and
// nodal forces of a constant pressure in closed form or with the sides' parts exchanged.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "tests/support/surface_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_mortar_flat_tests {
namespace {

class FlatMortar : public testing::TestWithParam<FlatCase> {
 protected:
  /// The pair somewhere in space, for what must not depend on where it lies.
  FlatCase posed() const {
    FlatCase c = GetParam();
    const Eigen::Matrix3d turn =
        c.k.dim == 3 ? some_rotation()
                     : Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    c.k = moved(c.k, turn, {0.4, -0.3, c.k.dim == 3 ? 0.8 : 0.0});
    c.n = moved(c.n, turn, {0.4, -0.3, c.k.dim == 3 ? 0.8 : 0.0});
    return c;
  }
};

/// Rows come from some ten thousand operations on numbers of size one at most, divided by weights
/// that are not small against the terms summed up; 1e-12 is 4500 roundings.
constexpr double exact = 1.0e-12;

TEST_P(FlatMortar, RowsSumUpToOne) {
  const FlatCase c = posed();
  const SurfaceRows rows = mortar(c.k, c.n);
  ASSERT_GT(rows.count(), 0);
  const std::vector<double> k_ones(c.k.points.size(), 1.0), n_ones(c.n.points.size(), 1.0);
  std::vector<double> sums(index(rows.count() * rows.dim));
  apply(rows.k, rows.dim, k_ones, sums);
  for (double sum : sums) EXPECT_NEAR(sum, 1.0, exact);
  apply(rows.n, rows.dim, n_ones, sums);
  for (double sum : sums) EXPECT_NEAR(sum, 1.0, exact);
}

TEST_P(FlatMortar, LinearFieldsAndPositionsPassExactly) {
  const FlatCase c = posed();
  const SurfaceRows rows = mortar(c.k, c.n);
  std::vector<double> tx(index(rows.count() * rows.dim)), py = tx;
  apply(rows.k, rows.dim, c.k.points, tx);
  apply(rows.n, rows.dim, c.n.points, py);
  EXPECT_LE(largest_difference(tx, py), exact);
  for (double gap : rows.gaps) EXPECT_NEAR(gap, 0.0, exact);
}

TEST_P(FlatMortar, ConstantPressureIsThatOfTheConsistentNodalForces) {
  const FlatCase c = posed();
  MortarOptions options;
  options.quadrature = PieceQuadrature::four_times_seven;
  const SurfaceRows rows = mortar(c.k, c.n, options);
  std::vector<double> f_k(index(c.k.nodes()), 0.0), consistent;
  std::vector<double> f_n(index(c.n.nodes()), 0.0), other = f_n;
  add_transposed(rows.k, 1, 1.0, rows.weights, f_k);
  add_transposed(rows.n, 1, 1.0, rows.weights, f_n);
  // N as the ground: its weights are the integrals of its shape functions over the same overlap
  options.merge = 0.0;
  options.dual_from = 2.0;
  const SurfaceRows swapped = mortar(c.n, c.k, options);
  for (int r = 0; r < swapped.count(); ++r) other[swapped.nodes[r]] = swapped.weights[r];
  // Quadrilaterals that are no parallelograms: measured 6e-7 of a facet's weight with four times
  // seven points (quadrature of functions that are no polynomials), a facet is 1/36.
  const double tolerance = c.straight ? exact : 1.0e-6 / 36.0;
  EXPECT_LE(largest_difference(f_n, other), tolerance);
  if (!c.inside) return;
  tributary_weights(c.k.pose(), consistent);
  EXPECT_LE(largest_difference(f_k, consistent), tolerance);
}

TEST_P(FlatMortar, AnyForcesBalanceInTotalMomentAndWork) {
  const FlatCase c = posed();
  const SurfaceRows rows = mortar(c.k, c.n);
  DrawNumbers draw(11);
  const int dim = rows.dim;
  const std::size_t size = index(rows.count() * dim);
  const std::vector<double> f = draw.many(size, -1.0, 1.0);
  std::vector<double> f_k(c.k.points.size(), 0.0), f_n(c.n.points.size(), 0.0);
  add_transposed(rows.k, dim, 1.0, f, f_k);
  add_transposed(rows.n, dim, -1.0, f, f_n);
  Eigen::Vector3d total = Eigen::Vector3d::Zero(), moment = total;
  const PosedSurface fk{dim, f_k, {}, {}}, fn{dim, f_n, {}, {}};
  for (int i = 0; i < c.k.nodes(); ++i) {
    total += fk.point(i);
    moment += c.k.pose().point(i).cross(fk.point(i));
  }
  for (int i = 0; i < c.n.nodes(); ++i) {
    total += fn.point(i);
    moment += c.n.pose().point(i).cross(fn.point(i));
  }
  // as many terms of size one as there are rows
  EXPECT_LE(total.norm(), exact * rows.count());
  EXPECT_LE(moment.norm(), exact * rows.count());
  const std::vector<double> u = draw.many(c.k.points.size(), -1.0, 1.0);
  const std::vector<double> v = draw.many(c.n.points.size(), -1.0, 1.0);
  std::vector<double> tu(size), pv(size);
  apply(rows.k, dim, u, tu);
  apply(rows.n, dim, v, pv);
  double nodes = 0.0, of_rows = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) nodes += f_k[i] * u[i];
  for (std::size_t i = 0; i < v.size(); ++i) nodes += f_n[i] * v[i];
  for (std::size_t i = 0; i < size; ++i) of_rows += f[i] * (tu[i] - pv[i]);
  EXPECT_NEAR(nodes, of_rows, exact * rows.count());
}

TEST_P(FlatMortar, WeightsAreTheAreaAndNormalsThoseOfThePartner) {
  const FlatCase c = posed();
  const SurfaceRows rows = mortar(c.k, c.n);
  const Eigen::Vector3d up = mean_normal(corners(c.n.pose(), 0));
  for (int r = 0; r < rows.count(); ++r)
    for (int d = 0; d < rows.dim; ++d) EXPECT_NEAR(rows.normals[rows.dim * r + d], up[d], exact);
  double area = 0.0, k_area = 0.0;
  for (double w : rows.weights) area += w;
  for (int f = 0; f < c.k.pose().facet_count(); ++f) k_area += abut::area(corners(c.k.pose(), f));
  if (c.inside) {
    EXPECT_NEAR(area, k_area, exact);
  }
  EXPECT_LE(area, k_area + exact);
}

TEST_P(FlatMortar, RowsDoNotDependOnWhereThePairLies) {
  const FlatCase a = GetParam(), b = posed();
  const SurfaceRows here = mortar(a.k, a.n), there = mortar(b.k, b.n);
  ASSERT_EQ(here.nodes, there.nodes);
  EXPECT_LE(largest_difference(here.weights, there.weights), exact);
  for (int r = 0; r < here.count(); ++r) {
    // round-off may find a piece, of weight zero, on one side only: compared with all columns
    EXPECT_LE(largest_difference(dense(here.k, r, a.k.nodes()), dense(there.k, r, a.k.nodes())),
              exact);
    EXPECT_LE(largest_difference(dense(here.n, r, a.n.nodes()), dense(there.n, r, a.n.nodes())),
              exact);
  }
}

TEST_P(FlatMortar, MergedRowsHaveSupportAndBoundedCoefficients) {
  const FlatCase c = posed();
  std::vector<double> full;
  tributary_weights(c.k.pose(), full);
  const SurfaceRows rows = mortar(c.k, c.n), all = mortar(c.k, c.n, {.merge = 0.0});
  // and coefficients stay of size one: without merging they are up to 37 in these cases
  for (double p : rows.n.values) EXPECT_LE(std::abs(p), 1.5);
  double kept = 0.0, sum = 0.0;
  for (int r = 0; r < rows.count(); ++r) {
    kept += rows.weights[r];
    // alone on its facets, a row has nobody to join
    if (rows.count() > 1) {
      EXPECT_GE(rows.weights[r], 0.2499 * full[rows.nodes[r]]) << c.name;
    }
  }
  for (double w : all.weights) sum += w;
  EXPECT_NEAR(kept, sum, exact);
}

TEST(FlatMortarSlivers, DroppedRowsLosePressureThatMergedRowsKeep) {
  // The published stress errors of these overhangs: 22 and 1 per cent with rows below a tenth of
  // their full weight dropped, 1e-10 with rows merged.
  for (const FlatCase& c : flat_cases()) {
    if (c.name != "turned_30_overhanging" && c.name != "segments_touch_1e-9") continue;
    std::vector<double> full;
    tributary_weights(c.k.pose(), full);
    const SurfaceRows all = mortar(c.k, c.n, {.merge = 0.0}), merged = mortar(c.k, c.n);
    double covered = 0.0, dropped = 0.0, kept = 0.0;
    for (int r = 0; r < all.count(); ++r) {
      covered += all.weights[r];
      if (all.weights[r] < 0.1 * full[all.nodes[r]]) dropped += all.weights[r];
    }
    for (double w : merged.weights) kept += w;
    EXPECT_GT(dropped, 0.02 * covered);
    EXPECT_NEAR(kept, covered, exact * covered);
    EXPECT_LT(merged.count(), all.count());
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, FlatMortar, testing::ValuesIn(flat_cases()), [](const auto& each) {
  std::string name = each.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace abut::surface_mortar_flat_tests
