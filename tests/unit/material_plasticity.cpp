// Goal: J2 plasticity yields where it must, hardens as it must, keeps volume and loses energy.
// Oracles: closed forms in uniaxial stress and small simple shear; invariants along random paths.

#include <cmath>
#include <functional>
#include <string>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "subdomain_solver/materials/finite_strain.hpp"
#include "subdomain_solver/materials/log_strain.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_plasticity_tests {
namespace {

const J2Plasticity& metal() {
  static const J2Plasticity law(test_moduli, test_hardening(), 1.0);
  return law;
}

/// F of uniaxial stress along x at an equivalent plastic strain a: logarithmic strains are
/// s(a)/E + a and -nu s(a)/E - a/2.
Matrix3 uniaxial(double a) {
  const double elastic = test_hardening().stress(a) / test_moduli.youngs();
  const double along = elastic + a;
  const double across = -test_moduli.poissons_ratio() * elastic - 0.5 * a;
  return Eigen::Vector3d(std::exp(along), std::exp(across), std::exp(across)).asDiagonal();
}

double plastic_determinant(const History& h) {
  Matrix3 m;
  m << h[0], h[3], h[5], h[3], h[1], h[4], h[5], h[4], h[2];
  return (m + Matrix3::Identity()).determinant();
}

/// A strain with a principal axis across the plane takes the way of plane bodies; the same one with
/// its axes in another order takes the general way.
TEST(LogStrain, IsThatOfSpaceInThePlane) {
  DrawTensors draw;
  for (int k = 0; k < 1000; ++k) {
    const double size = std::pow(10.0, -draw.between(0.5, 12.0));
    Matrix3 plane = Matrix3::Zero();
    for (int i = 0; i < 3; ++i) plane(i, i) = size * draw.between(-1.0, 1.0);
    plane(0, 1) = plane(1, 0) = k % 10 == 0 ? 0.0 : size * draw.between(-1.0, 1.0);
    Matrix3 turn;  // 1 2 3 -> 2 3 1
    turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    LogStrain one, other;
    ASSERT_TRUE(one.set(plane) && other.set(turn * plane * turn.transpose()));
    const Matrix3 back = turn.transpose() * other.strain() * turn;
    // Some roundings of the largest entry.
    EXPECT_LT((one.strain() - back).lpNorm<Eigen::Infinity>(), 8e-15 * size) << plane;
    EXPECT_LT((one.principal_elastic() - other.principal_elastic()).norm(), 8e-15 * size) << plane;
  }
}

// Some dozen roundings of strains of order 1.
constexpr double tolerance = 2.0e-15;

TEST(J2Plasticity, UniaxialStressFollowsTheHardeningCurve) {
  for (const double a : {1.0e-6, 0.01, 0.2, 1.0}) {
    History h = zero_history(metal());
    const PointResponse r = answer(metal(), uniaxial(a), h, true);
    const Matrix3 kirchhoff = r.stress * uniaxial(a).transpose();
    EXPECT_NEAR(kirchhoff(0, 0), test_hardening().stress(a), tolerance);
    EXPECT_NEAR(kirchhoff(1, 1), 0.0, tolerance);
    EXPECT_NEAR(kirchhoff(2, 2), 0.0, tolerance);
    EXPECT_NEAR(h[6], a, tolerance);
    EXPECT_NEAR(h[0], std::expm1(-2.0 * a), tolerance);  // plastic stretch exp(a) along x
    EXPECT_NEAR(h[1], std::expm1(a), 4.0 * tolerance);
    EXPECT_NEAR(r.dissipation, test_hardening().yield_stress * a, tolerance);
  }
}

TEST(J2Plasticity, ProportionalLoadingForgetsItsSteps) {
  // Fixed axes and one direction of flow: the return is exact, whatever the steps.
  History once = zero_history(metal()), many = once;
  const PointResponse big = answer(metal(), uniaxial(0.5), once, true);
  PointResponse small;
  double dissipated = 0.0;
  const int steps = 50;
  for (int i = 1; i <= steps; ++i) {
    small = answer(metal(), uniaxial(0.5 * i / steps), many, true);
    dissipated += small.dissipation;
  }
  EXPECT_LT((big.stress - small.stress).cwiseAbs().maxCoeff(), steps * tolerance);
  EXPECT_LT(largest_difference(once, many), steps * tolerance);
  EXPECT_NEAR(dissipated, big.dissipation, steps * tolerance);
  EXPECT_NEAR(small.energy, big.energy, steps * tolerance);
}

TEST(J2Plasticity, SmallSimpleShearYieldsAtTheMisesShearStress) {
  // Yield strains of 1e-6, so that the axes hardly turn: tau = s(a)/sqrt(3) at a shear of
  // tau/mu + sqrt(3) a, up to products of strains.
  Hardening hard;
  hard.yield_stress = 1.0e-6;
  hard.modulus = 0.1;
  const J2Plasticity law(test_moduli, hard, 1.0);
  for (const double a : {1.0e-7, 1.0e-6, 1.0e-5}) {
    const double tau = hard.stress(a) / std::sqrt(3.0);
    Matrix3 f = Matrix3::Identity();
    f(0, 1) = tau / test_moduli.shear + std::sqrt(3.0) * a;
    History h = zero_history(law);
    const PointResponse r = answer(law, f, h, true);
    EXPECT_NEAR(r.stress(0, 1) / tau, 1.0, 10.0 * f(0, 1));
    EXPECT_NEAR(h[6] / a, 1.0, 10.0 * f(0, 1) * f(0, 1) / a);
  }
}

TEST(J2Plasticity, BelowYieldItIsHencky) {
  const Hencky elastic(test_moduli, 1.0);
  const double limit = test_hardening().yield_stress / test_moduli.youngs();
  const Eigen::Vector3d direction(1.0, -test_moduli.poissons_ratio(),
                                  -test_moduli.poissons_ratio());
  for (const double part : {0.5, 0.999999, 1.000001}) {
    const Matrix3 f = (part * limit * direction).array().exp().matrix().asDiagonal();
    History h = zero_history(metal()), none;
    const PointResponse r = answer(metal(), f, h, true), e = answer(elastic, f, none);
    if (part < 1.0) {
      EXPECT_LT((r.stress - e.stress).cwiseAbs().maxCoeff(), tolerance);
      EXPECT_NEAR(r.energy, e.energy, tolerance);
      EXPECT_LT((r.tangent - e.tangent).cwiseAbs().maxCoeff(), 10.0 * tolerance);
      EXPECT_EQ(h, zero_history(metal()));
    } else {
      EXPECT_GT(h[6], 0.0);
    }
  }
}

TEST(J2Plasticity, UnloadsElasticallyAndYieldsAgainWhereItLeft) {
  const double a = 0.1, e = test_moduli.youngs(), nu = test_moduli.poissons_ratio();
  History loaded = zero_history(metal());
  answer(metal(), uniaxial(a), loaded, true);
  History h = loaded;
  const double top = test_hardening().stress(a);
  // Back along uniaxial stress to zero and beyond, up to just before yield on the other side.
  for (const double stress : {0.5 * top, 0.0, -0.999 * top}) {
    const Eigen::Vector3d back((stress - top) / e, -nu * (stress - top) / e,
                               -nu * (stress - top) / e);
    const Matrix3 f = uniaxial(a) * Matrix3(back.array().exp().matrix().asDiagonal());
    const PointResponse r = answer(metal(), f, h, true);
    EXPECT_NEAR((r.stress * f.transpose())(0, 0), stress, 2.0 * tolerance);
    EXPECT_EQ(r.dissipation, 0.0);
    EXPECT_EQ(h, loaded);
  }
  const PointResponse again = answer(metal(), uniaxial(0.2), h, true);
  EXPECT_NEAR((again.stress * uniaxial(0.2).transpose())(0, 0), test_hardening().stress(0.2),
              4.0 * tolerance);
  EXPECT_NEAR(h[6], 0.2, 4.0 * tolerance);
}

TEST(J2Plasticity, PressureDoesNotYield) {
  for (const double s : {0.3, 0.9, 1.5, 4.0}) {
    History h = zero_history(metal());
    const PointResponse r = answer(metal(), s * Matrix3::Identity(), h, true);
    EXPECT_EQ(h, zero_history(metal()));
    EXPECT_NEAR(s * r.stress(0, 0), 3.0 * test_moduli.bulk * std::log(s), 4.0 * tolerance);
  }
}

TEST(J2Plasticity, RandomPathsDissipateKeepPlasticVolumeAndStayOnTheSurface) {
  DrawTensors draw;
  History h = zero_history(metal());
  const int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double before = h[6];
    const Matrix3 f = Matrix3::Identity() + draw.matrix(0.3);
    const PointResponse r = answer(metal(), f, h, true, Need::stress);
    ASSERT_GE(r.dissipation, 0.0);
    ASSERT_GE(h[6], before);
    const Matrix3 kirchhoff = r.stress * f.transpose();
    const double mises = std::sqrt(1.5) * deviator(kirchhoff).norm();
    ASSERT_LE(mises, test_hardening().stress(h[6]) * (1.0 + 1.0e-12));  // 1e-13 of 40 summed steps
  }
  EXPECT_GT(h[6], 10.0);  // hundreds of yielding steps, until hardening has widened the surface
  EXPECT_NEAR(plastic_determinant(h), 1.0, roundoff(steps, 1.0));  // one rounding a step at most
}

TEST(J2Plasticity, EnergyBalanceClosesWithFinerSteps) {
  // Energy balance along a fine path of large shear and back: work of P over F equals what is
  // stored and dissipated; the trapezoidal sum of the work is of second order in the step.
  const auto imbalance = [](int steps) {
    History h = zero_history(metal());
    Matrix3 last_f = Matrix3::Identity(), last_p = Matrix3::Zero();
    double work = 0.0, dissipated = 0.0, stored = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double angle = 2.0 * 3.14159265358979 * i / steps;
      Matrix3 f = Matrix3::Identity();
      f(0, 1) = 0.4 * std::sin(angle);
      f(2, 2) = 1.0 + 0.1 * (1.0 - std::cos(angle));
      const PointResponse r = answer(metal(), f, h, true, Need::stress);
      work += 0.5 * (r.stress + last_p).cwiseProduct(f - last_f).sum();
      dissipated += r.dissipation;
      stored = r.energy;
      last_f = f;
      last_p = r.stress;
    }
    return std::abs(work - stored - dissipated) / work;
  };
  const double coarse = imbalance(400), fine = imbalance(1600);
  EXPECT_LT(coarse, 1.0e-2);  // of first order at most in steps of 2 pi / 400 = 0.016
  // The return map is of first order where axes turn, so the order is between one and two.
  EXPECT_GT(observed_order(coarse, fine, 4.0), 0.9);
}

TEST(J2Plasticity, PerfectPlasticityAndLargeStepsConverge) {
  Hardening perfect;
  perfect.yield_stress = 1.0e-5;
  Hardening sharp = perfect;
  sharp.saturation = Saturation{0.5, 1.0e5};
  for (const Hardening& hard : {perfect, sharp}) {
    const J2Plasticity law(test_moduli, hard, 1.0);
    DrawTensors draw;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d stretch(draw.between(0.1, 10.0), draw.between(0.1, 10.0), 1.0);
      const Matrix3 f = draw.rotation() * stretch.asDiagonal() * draw.rotation();
      History h = zero_history(law);
      const PointResponse r = answer(law, f, h, true);
      const double mises = std::sqrt(1.5) * deviator(Matrix3(r.stress * f.transpose())).norm();
      // The volumetric stress, up to 3 kappa ln 10, rounds where the deviator is read off.
      EXPECT_NEAR(mises, hard.stress(h[6]), roundoff(100.0, 10.0));
    }
  }
}

TEST(J2Plasticity, SofteningIsRefused) {
  const auto refusal = [](const Hardening& h) -> std::string {
    try {
      J2Plasticity(test_moduli, h, 1.0);
    } catch (const InputError& error) {
      return error.where;
    }
    return "";
  };
  Hardening h = test_hardening();
  EXPECT_EQ(refusal(h), "");
  h.modulus = -1.0;
  EXPECT_EQ(refusal(h), "hardening_modulus");
  h = test_hardening();
  h.saturation->stress = 0.5 * h.yield_stress;
  EXPECT_EQ(refusal(h), "saturation_stress");
  h.saturation->rate = 0.0;
  EXPECT_EQ(refusal(h), "saturation_rate");
  h.yield_stress = 0.0;
  EXPECT_EQ(refusal(h), "yield_stress");
}

}  // namespace
}  // namespace abut::material_plasticity_tests
