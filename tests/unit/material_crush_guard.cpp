// Goal: what stiffens a crushed cell is a law with a potential, grows without end and is nothing
// where the cell is not crushed. Oracles: central differences of the energy and of the stress;
// smoothness where it begins.

#include <cmath>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include "subdomain_solver/materials/crush_guard.hpp"
#include "tests/support/materials.hpp"

namespace abut::material_crush_guard_tests {
namespace {

constexpr double p_wave = 7.0;

PointResponse guard_at(const Matrix3& f, Need want = Need::tangent) {
  PointResponse out;
  out.energy = 0.0;
  out.stress.setZero();
  out.tangent.setZero();
  guard_against_crushing(f, p_wave, want, out);
  return out;
}

Matrix3 with_volume(DrawTensors& draw, double j) {
  Matrix3 f = Matrix3::Identity() + draw.matrix(0.4);
  if (f.determinant() < 0.0) f.col(0) *= -1.0;
  return f * std::cbrt(j / f.determinant());
}

TEST(CrushGuard, HasAPotential) {
  DrawTensors draw;
  for (const double j : {0.05, 0.1, 0.25, 0.39}) {
    for (int k = 0; k < 20; ++k) {
      const Matrix3 f = with_volume(draw, j);
      const PointResponse here = guard_at(f);
      // Central differences: h^2 times third derivatives, some dozens where J is the third power
      // of entries that are of the size of the step's unit, and roundings over h: both 4e-12 to
      // 4e-9 of what is differentiated; by a margin.
      const double h = 2.0e-6 * std::cbrt(j), stiff = here.tangent.cwiseAbs().maxCoeff();
      const double margin = 5e-8;
      for (int e = 0; e < 9; ++e) {
        Matrix3 up = f, down = f;
        up.reshaped()(e) += h;
        down.reshaped()(e) -= h;
        const PointResponse above = guard_at(up), below = guard_at(down);
        EXPECT_NEAR((above.energy - below.energy) / (2.0 * h), here.stress.reshaped()(e),
                    margin * (stiff * std::cbrt(j) + here.stress.norm()));
        const Matrix3 slope = (above.stress - below.stress) / (2.0 * h);
        EXPECT_LT((slope.reshaped() - here.tangent.col(e)).cwiseAbs().maxCoeff(), margin * stiff);
      }
    }
  }
}

TEST(CrushGuard, IsNothingWhereNothingIsCrushed) {
  DrawTensors draw;
  for (const double j : {crushed * 1.0001, 0.7, 1.0, 2.0}) {
    const PointResponse r = guard_at(with_volume(draw, j));
    EXPECT_EQ(r.energy, 0.0);
    EXPECT_EQ(r.stress.norm(), 0.0);
    EXPECT_EQ(r.tangent.norm(), 0.0);
  }
}

/// Twice differentiable: near its begin the energy goes with the third power, the stress with the
/// second and the moduli with the first of what is missing.
TEST(CrushGuard, BeginsSmoothly) {
  const auto at = [](double missing) {
    return guard_at(std::cbrt(crushed * (1.0 - missing)) * Matrix3::Identity());
  };
  const PointResponse near = at(1.0e-3), nearer = at(5.0e-4);
  // Powers to a hundredth: the next terms are a thousandth of these ones.
  EXPECT_NEAR(near.energy / nearer.energy, 8.0, 0.08);
  EXPECT_NEAR(near.stress.norm() / nearer.stress.norm(), 4.0, 0.04);
  EXPECT_NEAR(near.tangent.norm() / nearer.tangent.norm(), 2.0, 0.02);
}

TEST(CrushGuard, NeverGivesWay) {
  double before = 0.0;
  for (const double j : {0.3, 0.1, 1.0e-2, 1.0e-3}) {
    const double energy = guard_at(std::cbrt(j) * Matrix3::Identity()).energy;
    EXPECT_GT(energy, 10.0 * before) << j;
    before = energy;
  }
  // 0.2 p_wave (J0/J - 1)^3
  EXPECT_NEAR(before, 0.2 * p_wave * std::pow(399.0, 3), 4e-13 * before);
}

}  // namespace
}  // namespace abut::material_crush_guard_tests
