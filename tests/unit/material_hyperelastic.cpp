// Goal: each elastic law is the one that its name says.
// Oracle: closed forms in uniaxial strain, uniform expansion, principal stretches, simple shear.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_hyperelastic_tests {
namespace {

const double kappa = test_moduli.bulk, mu = test_moduli.shear;

PointResponse at(const Material& law, const Matrix3& f) {
  History none = zero_history(law);
  return answer(law, f, none);
}

Matrix3 stretches(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }

Matrix3 shear(double gamma) {
  Matrix3 f = Matrix3::Identity();
  f(0, 1) = gamma;
  return f;
}

// A few dozen roundings of numbers of order 1 to 10.
constexpr double tolerance = 1.0e-14;

TEST(LinearElastic, UniaxialStrainSeesThePWaveModulus) {
  const PointResponse r = at(LinearElastic(test_moduli, 1.0), stretches(1.25, 1.0, 1.0));
  EXPECT_NEAR(r.stress(0, 0), (kappa + 4.0 / 3.0 * mu) * 0.25, tolerance);
  EXPECT_NEAR(r.stress(1, 1), (kappa - 2.0 / 3.0 * mu) * 0.25, tolerance);
}

TEST(SaintVenantKirchhoff, UniaxialStrainIsCubic) {
  for (const double s : {0.4, 0.7, 1.5, 2.0}) {
    const PointResponse r = at(SaintVenantKirchhoff(test_moduli, 1.0), stretches(s, 1.0, 1.0));
    const double modulus = kappa + 4.0 / 3.0 * mu;
    EXPECT_NEAR(r.stress(0, 0), modulus * s * (s * s - 1.0) / 2.0, 4.0 * tolerance);
    EXPECT_NEAR(r.energy, modulus * std::pow(s * s - 1.0, 2) / 8.0, 4.0 * tolerance);
  }
}

TEST(NeoHookean, UniformExpansionSeesTheBulkModulusAlone) {
  for (const double s : {0.5, 0.9, 1.1, 2.0}) {
    const PointResponse r = at(NeoHookean(test_moduli, 1.0), stretches(s, s, s));
    const double j = s * s * s;
    EXPECT_NEAR(r.stress(1, 1), kappa / 2.0 * (j * j - 1.0) / s, 40.0 * tolerance);
    EXPECT_NEAR(r.energy, kappa / 4.0 * (j * j - std::log(j * j) - 1.0), 40.0 * tolerance);
  }
}

TEST(NeoHookean, PrincipalStretches) {
  const double s[3] = {1.7, 0.8, 0.9}, j = s[0] * s[1] * s[2];
  const PointResponse r = at(NeoHookean(test_moduli, 1.0), stretches(s[0], s[1], s[2]));
  const double i1 = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], part = std::pow(j, -2.0 / 3.0);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(r.stress(i, i),
                kappa / 2.0 * (j - 1.0 / j) * j / s[i] + mu * part * (s[i] - i1 / 3.0 / s[i]),
                tolerance);
  EXPECT_NEAR(r.energy,
              kappa / 4.0 * (j * j - std::log(j * j) - 1.0) + mu / 2.0 * (part * i1 - 3.0),
              tolerance);
}

TEST(MooneyRivlin, SimpleShearHasBothNormalStressDifferences) {
  const double c10 = 0.15, c01 = 0.1;
  const MooneyRivlin law({c10, c01, kappa, 1.0});
  EXPECT_DOUBLE_EQ(law.moduli().shear, 2.0 * (c10 + c01));
  for (const double g : {1.0e-3, 0.5, 2.0}) {
    const PointResponse r = at(law, shear(g));
    const Matrix3 cauchy = r.stress * shear(g).transpose();  // J = 1
    const double size = tolerance * (1.0 + g * g * g * g);
    EXPECT_NEAR(cauchy(0, 1), 2.0 * (c10 + c01) * g, size);
    EXPECT_NEAR(cauchy(0, 0) - cauchy(1, 1), 2.0 * (c10 + c01) * g * g, size);
    EXPECT_NEAR(cauchy(1, 1) - cauchy(2, 2), -2.0 * c01 * g * g, size);
    EXPECT_NEAR(cauchy.trace(), 0.0, size);
    EXPECT_NEAR(r.energy, (c10 + c01) * g * g, size);
  }
}

TEST(MooneyRivlin, WithoutSecondInvariantIsNeoHookean) {
  const MooneyRivlin rubber({mu / 2.0, 0.0, kappa, 1.0});
  const NeoHookean neo(test_moduli, 1.0);
  for (const Matrix3& f : sample_deformations()) {
    const PointResponse a = at(rubber, f), b = at(neo, f);
    EXPECT_EQ(a.stress, b.stress);
    EXPECT_EQ(a.energy, b.energy);
  }
}

TEST(Hencky, PrincipalStretchesAreHookeInLogarithms) {
  const double s[3] = {1.7, 0.8, 0.9};
  const PointResponse r = at(Hencky(test_moduli, 1.0), stretches(s[0], s[1], s[2]));
  const double volume = std::log(s[0] * s[1] * s[2]), lambda = test_moduli.lame();
  double energy = lambda / 2.0 * volume * volume;
  for (int i = 0; i < 3; ++i) {
    const double e = std::log(s[i]);
    EXPECT_NEAR(r.stress(i, i), (lambda * volume + 2.0 * mu * e) / s[i], tolerance);
    energy += mu * e * e;
  }
  EXPECT_NEAR(r.energy, energy, tolerance);
}

TEST(Hencky, SimpleShearByItsPrincipalStretch) {
  // Principal stretch s = g/2 + sqrt(1 + g^2/4), ln s = asinh(g/2); shear stress
  // tau_12 = 2 mu asinh(g/2)/sqrt(1 + g^2/4).
  for (const double g : {1.0e-6, 0.1, 1.0, 3.0}) {
    const PointResponse r = at(Hencky(test_moduli, 1.0), shear(g));
    const Matrix3 kirchhoff = r.stress * shear(g).transpose();
    const double e = std::asinh(g / 2.0);
    EXPECT_NEAR(kirchhoff(0, 1), 2.0 * mu * e / std::sqrt(1.0 + g * g / 4.0), 4.0 * tolerance);
    EXPECT_NEAR(r.energy, 2.0 * mu * e * e, 4.0 * tolerance);
  }
}

}  // namespace
}  // namespace abut::material_hyperelastic_tests
