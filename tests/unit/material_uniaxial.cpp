// Goal: bars see the law of space with a cross section that is free to swell and shrink.
// Oracles: closed forms under uniaxial stress; the law in space at the stretch that was found;
// differences.

#include <array>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "subdomain_solver/materials/stress_free.hpp"
#include "tests/support/material_gradients.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_uniaxial_tests {
namespace {

constexpr std::array<int, 1> bar_entry = {0};
constexpr std::array<double, 6> stretches = {1.0, 1.0 + 1.0e-8, 0.995, 0.8, 1.1, 1.25};

// The search for the stretch across ends at a step of 1e-13 of the strain, here up to 0.3, times
// moduli of order 1.
constexpr double tolerance = 1.0e-13;

const double young = test_moduli.youngs(), poisson = test_moduli.poissons_ratio();

Matrix3 along(double stretch) { return Eigen::Vector3d(stretch, 1.0, 1.0).asDiagonal(); }

UniaxialStress bar_of(const Material& law) {
  return UniaxialStress(std::make_unique<const Borrowed>(law));
}

class BarLaw : public testing::TestWithParam<Law> {
 protected:
  UniaxialStress bar() const { return bar_of(*GetParam().law); }
  History pulled() const {
    const UniaxialStress law = bar();
    History h = zero_history(law);
    answer(law, along(1.13), h, true);
    return h;
  }
};

TEST_P(BarLaw, StressFollowsTheEnergyOfTheBar) {
  const UniaxialStress law = bar();
  for (const History& start : {zero_history(law), pulled()})
    for (const double s : stretches)
      EXPECT_LT(gradient_error(law, along(s), start, bar_entry), 1.0) << "at " << s;
}

TEST_P(BarLaw, TangentIsCondensed) {
  const UniaxialStress law = bar();
  for (const History& start : {zero_history(law), pulled()})
    for (const double s : stretches) {
      EXPECT_LT(tangent_error(law, along(s), start, bar_entry), 1.0) << "at " << s;
      History h = start;
      const Tangent a = answer(law, along(s), h).tangent;
      for (const int normal : {4, 8}) {
        EXPECT_EQ(a.col(normal).cwiseAbs().maxCoeff(), 0.0);
        EXPECT_EQ(a.row(normal).cwiseAbs().maxCoeff(), 0.0);
      }
    }
}

TEST_P(BarLaw, NothingIsLeftAcross) {
  const UniaxialStress law = bar();
  const Material& space = *GetParam().law;
  if (space.is_linear()) return;  // keeps no stretch; its closed form is tested below
  for (const double s : stretches) {
    History h = zero_history(law), none = zero_history(space);
    const PointResponse r = answer(law, along(s), h, true);
    const Matrix3 whole = law.completed(along(s), h);
    EXPECT_EQ(whole(1, 1), 1.0 + h.back());
    EXPECT_EQ(whole(2, 2), 1.0 + h.back());
    const PointResponse in_space = answer(space, whole, none);
    EXPECT_LT((in_space.stress - r.stress).cwiseAbs().maxCoeff(), tolerance);
  }
}

TEST_P(BarLaw, SmallStrainsSeeYoungsModulus) {
  const UniaxialStress law = bar();
  History h = zero_history(law);
  EXPECT_NEAR(answer(law, Matrix3::Identity(), h).tangent(0, 0), young, roundoff(20.0, 2.0));
  EXPECT_EQ(law.density(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(All, BarLaw, testing::ValuesIn(all_laws()),
                         [](const auto& tested) { return tested.param.name; });

/// P11 of a law at a stretch, from rest.
double pull(const Material& law, double stretch) {
  const UniaxialStress bar = bar_of(law);
  History h = zero_history(bar);
  return answer(bar, along(stretch), h).stress(0, 0);
}

TEST(UniaxialStress, LinearElasticIsYoungsModulusTimesStrain) {
  const LinearElastic law(test_moduli, 1.0);
  EXPECT_TRUE(bar_of(law).is_linear());
  EXPECT_EQ(bar_of(law).history_size(), 0);
  for (const double s : stretches) EXPECT_NEAR(pull(law, s), young * (s - 1.0), tolerance);
}

TEST(UniaxialStress, SaintVenantKirchhoffIsItInGreensStrain) {
  const SaintVenantKirchhoff law(test_moduli, 1.0);  // S = E e, P = F S
  for (const double s : stretches)
    EXPECT_NEAR(pull(law, s), s * young * 0.5 * (s - 1.0) * (s + 1.0), tolerance);
}

TEST(UniaxialStress, HenckyIsItInLogarithmicStrain) {
  const Hencky law(test_moduli, 1.0);  // tau = E ln s, P = tau / s
  for (const double s : stretches) EXPECT_NEAR(pull(law, s), young * std::log(s) / s, tolerance);
}

TEST(UniaxialStress, RubberIsThatOfSpace) {
  const NeoHookean neo(test_moduli, 1.0);
  const MooneyRivlin mooney(MooneyRivlinParameters{0.15, 0.1, test_moduli.bulk, 1.0});
  for (const Material* law : std::initializer_list<const Material*>{&neo, &mooney}) {
    for (const double s : {0.3, 0.8, 1.5, 4.0}) {
      // Stretch t across by bisection: P22(s, t, t) rises with t.
      double low = 0.1, high = 3.0;
      PointResponse rod;
      History none;
      while (true) {
        const double t = 0.5 * (low + high);
        if (t == low || t == high) break;
        rod = answer(*law, Eigen::Vector3d(s, t, t).asDiagonal(), none);
        (rod.stress(1, 1) > 0.0 ? high : low) = t;
      }
      // strains are up to 3 and moduli there up to ten times those at rest
      EXPECT_NEAR(pull(*law, s), rod.stress(0, 0), 100.0 * tolerance) << "at " << s;
    }
  }
}

TEST(UniaxialStress, PlasticFlowFollowsTheHardeningCurve) {
  const J2Plasticity metal(test_moduli, test_hardening(), 1.0);
  const UniaxialStress law = bar_of(metal);
  History h = zero_history(law);
  for (const double a : {1.0e-4, 0.05, 0.1, 0.5}) {
    const double elastic = test_hardening().stress(a) / young;
    const double stretch = std::exp(elastic + a), across = std::exp(-poisson * elastic - 0.5 * a);
    const PointResponse r = answer(law, along(stretch), h, true);
    EXPECT_NEAR(r.stress(0, 0) * stretch, test_hardening().stress(a), tolerance);
    EXPECT_NEAR(h.back(), across - 1.0, tolerance);
    EXPECT_NEAR(h[6], a, tolerance);
  }
}

TEST(UniaxialStress, InvertedBarHasNoAnswer) {
  const NeoHookean rubber(test_moduli, 1.0);
  const UniaxialStress law = bar_of(rubber);
  const History before = zero_history(law);
  History after = before;
  PointResponse out;
  EXPECT_FALSE(law.evaluate(along(-1.0), before, after, Need::stress, out));
}

}  // namespace
}  // namespace abut::material_uniaxial_tests
