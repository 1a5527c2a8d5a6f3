// Goal: bodies in the plane see the law of space: its entries in the right order, and under plane
// stress a sheet free to thin.
// Oracles: E/(1 - nu^2); uniaxial stress solved in space; the hardening curve; differences.

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/materials/plane.hpp"
#include "subdomain_solver/materials/stress_free.hpp"
#include "tests/support/material_gradients.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_plane_tests {
namespace {

constexpr std::array<int, 4> sheet_entries = {0, 1, 3, 4};

PlaneStress sheet_of(const Material& law) {
  return PlaneStress(std::make_unique<const Borrowed>(law));
}

std::vector<Matrix3> sample_sheets() {
  DrawTensors draw;
  std::vector<Matrix3> samples;
  for (const double size : {0.0, 1.0e-8, 5.0e-3, 0.1, 0.2, 0.25}) {
    const Matrix3 h = draw.matrix(size);
    const double angle = draw.between(-0.1, 0.1);
    samples.push_back(embed(Eigen::Rotation2Dd(angle).toRotationMatrix() *
                            (Eigen::Matrix2d::Identity() + h.topLeftCorner<2, 2>())));
  }
  return samples;
}

class PlaneLaw : public testing::TestWithParam<Law> {
 protected:
  PlaneStress sheet() const { return sheet_of(*GetParam().law); }
  History sheared() const {
    const PlaneStress law = sheet();
    History h = zero_history(law);
    Matrix3 f = Matrix3::Identity();
    f(0, 1) = 0.2;
    answer(law, f, h, true);
    return h;
  }
};

TEST_P(PlaneLaw, EntriesKeepTheOrderOfTheTangent) {
  const Material& law = *GetParam().law;
  History none = zero_history(law);
  for (const double hoop : {1.0, 1.2}) {
    const Eigen::Matrix2d f{{1.1, 0.05}, {-0.1, 0.9}};
    const PointResponse r = answer(law, embed(f, hoop), none);
    const PlaneTangent tangent = in_plane(r.tangent);
    const Matrix3 change = embed(Eigen::Matrix2d{{0.1, 0.4}, {-0.3, 0.2}}, 0.5);
    // dP of a change in the plane, by the tangent of space and by that of the plane.
    const Eigen::Matrix<double, 9, 1> whole = r.tangent * change.reshaped();
    const Matrix3 expected = whole.reshaped(3, 3);
    EXPECT_LT((in_plane(expected) - tangent * in_plane(change)).cwiseAbs().maxCoeff(),
              roundoff(20.0, 5.0));
    const Matrix3& p = r.stress;
    EXPECT_EQ(in_plane(p), PlaneEntries(p(0, 0), p(1, 0), p(0, 1), p(1, 1), p(2, 2)));
  }
}

TEST_P(PlaneLaw, StressFollowsTheEnergyOfTheSheet) {
  const PlaneStress law = sheet();
  for (const History& start : {zero_history(law), sheared()})
    for (const Matrix3& f : sample_sheets())
      EXPECT_LT(gradient_error(law, f, start, sheet_entries), 1.0) << "at\n" << f;
}

TEST_P(PlaneLaw, TangentIsCondensed) {
  const PlaneStress law = sheet();
  for (const History& start : {zero_history(law), sheared()})
    for (const Matrix3& f : sample_sheets()) {
      EXPECT_LT(tangent_error(law, f, start, sheet_entries), 1.0) << "at\n" << f;
      History h = start;
      const Tangent a = answer(law, f, h).tangent;
      EXPECT_LT((a - a.transpose()).cwiseAbs().maxCoeff(), roundoff(200.0, 5.0));
      EXPECT_EQ(a.col(8).cwiseAbs().maxCoeff(), 0.0);
    }
}

TEST_P(PlaneLaw, NothingIsLeftAcrossTheThickness) {
  const PlaneStress law = sheet();
  const Material& space = *GetParam().law;
  if (space.is_linear()) return;  // keeps no F33; its closed form is tested below
  for (const Matrix3& f : sample_sheets()) {
    History h = zero_history(law), none = zero_history(space);
    const PointResponse flat = answer(law, f, h, true);
    Matrix3 whole = f;
    whole(2, 2) = 1.0 + h.back();
    const PointResponse r = answer(space, whole, none);
    EXPECT_NEAR(r.stress(2, 2), 0.0, roundoff(20.0, 5.0));
    EXPECT_LT((r.stress - flat.stress).cwiseAbs().maxCoeff(), roundoff(20.0, 5.0));
  }
}

TEST_P(PlaneLaw, SmallStrainsSeeThePlaneStressModulus) {
  const PlaneStress law = sheet();
  History h = zero_history(law);
  const double e = law.moduli().youngs(), nu = law.moduli().poissons_ratio();
  const PlaneTangent a = in_plane(answer(law, Matrix3::Identity(), h).tangent);
  EXPECT_NEAR(a(0, 0), e / (1.0 - nu * nu), roundoff(20.0, 2.0));
  EXPECT_NEAR(a(0, 3), e * nu / (1.0 - nu * nu), roundoff(20.0, 2.0));
  EXPECT_NEAR(a(1, 1), law.moduli().shear, roundoff(20.0, 2.0));
  EXPECT_EQ(law.density(), 1.0);
}

TEST_P(PlaneLaw, InvertedSheetHasNoAnswer) {
  const PlaneStress law = sheet();
  const History before = zero_history(law);
  History after = before;
  PointResponse out;
  Matrix3 f = Matrix3::Identity();
  f(0, 0) = GetParam().objective ? -1.0 : std::nan("");  // small strains know no inversion
  EXPECT_FALSE(law.evaluate(f, before, after, Need::tangent, out));
}

INSTANTIATE_TEST_SUITE_P(All, PlaneLaw, testing::ValuesIn(all_laws()),
                         [](const auto& tested) { return tested.param.name; });

TEST(PlaneStress, LinearElasticIsTheClosedForm) {
  const LinearElastic hooke(test_moduli, 1.0);
  const PlaneStress law = sheet_of(hooke);
  EXPECT_TRUE(law.is_linear());
  EXPECT_EQ(law.history_size(), 0);
  const double e = test_moduli.youngs(), nu = test_moduli.poissons_ratio();
  const double e11 = 0.02, e22 = -0.005, e12 = 0.01;
  Matrix3 f = Matrix3::Identity();
  f(0, 0) += e11;
  f(1, 1) += e22;
  f(0, 1) += 2.0 * e12;
  History none;
  const PointResponse r = answer(law, f, none);
  const double tolerance = roundoff(20.0, 0.03);
  EXPECT_NEAR(r.stress(0, 0), e / (1.0 - nu * nu) * (e11 + nu * e22), tolerance);
  EXPECT_NEAR(r.stress(1, 1), e / (1.0 - nu * nu) * (e22 + nu * e11), tolerance);
  EXPECT_NEAR(r.stress(1, 0), e / (1.0 + nu) * e12, tolerance);
  EXPECT_NEAR(r.energy,
              0.5 * (r.stress(0, 0) * e11 + r.stress(1, 1) * e22 + 2.0 * r.stress(0, 1) * e12),
              0.03 * tolerance);
}

TEST(PlaneStress, NeoHookeanUniaxialIsThatOfSpace) {
  const NeoHookean rubber(test_moduli, 1.0);
  const PlaneStress law = sheet_of(rubber);
  for (const double s : {0.3, 0.8, 1.5, 4.0}) {
    // Lateral stretch t of a rod in space by bisection: P22(s, t, t) rises with t.
    double low = 0.1, high = 3.0;
    PointResponse rod;
    History none;
    while (true) {
      const double t = 0.5 * (low + high);
      if (t == low || t == high) break;
      rod = answer(rubber, Eigen::Vector3d(s, t, t).asDiagonal(), none);
      (rod.stress(1, 1) > 0.0 ? high : low) = t;
    }
    History h = zero_history(law);
    const PointResponse r = answer(law, embed(Eigen::Vector2d(s, low).asDiagonal()), h, true);
    const double tolerance = roundoff(100.0, r.tangent.cwiseAbs().maxCoeff());
    EXPECT_NEAR(r.stress(1, 1), 0.0, tolerance);
    EXPECT_NEAR(1.0 + h.back(), low, tolerance);
    EXPECT_NEAR(r.stress(0, 0), rod.stress(0, 0), tolerance);
  }
}

TEST(PlaneStress, PlasticUniaxialFollowsTheHardeningCurve) {
  const J2Plasticity metal(test_moduli, test_hardening(), 1.0);
  const PlaneStress law = sheet_of(metal);
  History h = zero_history(law);
  for (const double a : {1.0e-4, 0.05, 0.1, 0.5}) {
    const double elastic = test_hardening().stress(a) / test_moduli.youngs();
    const double along = elastic + a;
    const double across = -test_moduli.poissons_ratio() * elastic - 0.5 * a;
    const Eigen::Vector2d stretch(std::exp(along), std::exp(across));
    const PointResponse r = answer(law, embed(stretch.asDiagonal()), h, true);
    const double tolerance = roundoff(40.0, 1.0);
    EXPECT_NEAR(r.stress(0, 0) * stretch[0], test_hardening().stress(a), tolerance);
    EXPECT_NEAR(r.stress(1, 1), 0.0, tolerance);
    EXPECT_NEAR(h.back(), stretch[1] - 1.0, tolerance);
    EXPECT_NEAR(h[6], a, tolerance);
  }
}

TEST(PlaneStress, NoThicknessNoAnswer) {
  // S33 = 0 needs E33 = -lambda/(lambda + 2 mu) (E11 + E22) > -1/2: here -0.6.
  const SaintVenantKirchhoff stiff(test_moduli, 1.0);
  const PlaneStress law = sheet_of(stiff);
  const History before = zero_history(law);
  History after = before;
  PointResponse out;
  const Matrix3 f = embed(1.5 * Eigen::Matrix2d::Identity());
  EXPECT_FALSE(law.evaluate(f, before, after, Need::stress, out));
}

}  // namespace
}  // namespace abut::material_plane_tests
