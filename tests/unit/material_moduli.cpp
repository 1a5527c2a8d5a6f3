// Goal: any two elastic constants give the same solid; what is no solid is refused with its reason.
// Oracle: the constants of a solid known by bulk and shear modulus; identities between them.

#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/mooney_rivlin.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_moduli_tests {
namespace {

constexpr std::optional<double> ElasticConstants::*const constants[] = {
    &ElasticConstants::youngs_modulus, &ElasticConstants::poissons_ratio,
    &ElasticConstants::bulk_modulus, &ElasticConstants::lame_modulus,
    &ElasticConstants::shear_modulus};

/// All five constants of a solid with Young's modulus E and Poisson's ratio nu, by the formulas of
/// the pair (E, nu), which every textbook has.
std::vector<double> constants_of(double e, double nu) {
  return {e, nu, e / (3.0 * (1.0 - 2.0 * nu)), e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
          e / (2.0 * (1.0 + nu))};
}

TEST(Moduli, AnyTwoConstantsGiveTheSameSolid) {
  for (const double nu : {-0.9, -0.2, 0.1, 0.3, 0.499}) {
    const std::vector<double> value = constants_of(210.0e9, nu);
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t k = i + 1; k < 5; ++k) {
        ElasticConstants given;
        given.*constants[i] = value[i];
        given.*constants[k] = value[k];
        const Moduli m = moduli_of(given);
        // Roundings of the given constants, amplified where two of them nearly coincide or nearly
        // vanish: by 1/(1 - 2 nu) at most, by 1/(1 + nu) at nu = -0.9 squared.
        const double condition = 1.0 / ((1.0 - 2.0 * nu) * std::pow(1.0 + nu, 2));
        const double tolerance = roundoff(40.0 * condition, 1.0);
        EXPECT_NEAR(m.bulk / value[2], 1.0, tolerance) << i << k << " nu " << nu;
        EXPECT_NEAR(m.shear / value[4], 1.0, tolerance) << i << k << " nu " << nu;
      }
  }
}

TEST(Moduli, ConstantsComeBack) {
  for (const double nu : {-0.5, 0.0, 0.25, 0.49}) {
    const std::vector<double> value = constants_of(1.0e9, nu);
    const Moduli m{value[2], value[4]};
    const double tolerance = roundoff(20.0 / (1.0 - 2.0 * nu), 1.0);  // of 1 - 2 nu in kappa
    EXPECT_NEAR(m.youngs() / value[0], 1.0, tolerance);
    EXPECT_NEAR(m.poissons_ratio(), nu, tolerance);
    EXPECT_NEAR(m.lame() / value[2], value[3] / value[2], tolerance);
    EXPECT_NEAR(m.p_wave() / (value[3] + 2.0 * value[4]), 1.0, tolerance);
  }
}

TEST(Moduli, LameModulusOfEitherSignWithYoungsModulus) {
  // 1 - 2 nu = 2e-9: the sum that gives mu cancels, its conjugate does not.
  ElasticConstants given;
  given.youngs_modulus = 3.0;
  given.lame_modulus = 1.0e9;
  // E = mu (3 lambda + 2 mu)/(lambda + mu), to first order in mu/lambda mu = E/3 (1 + mu/(3
  // lambda))
  EXPECT_NEAR(moduli_of(given).shear, 1.0 + 1.0 / 3.0e9, roundoff(10.0, 1.0));
  given.lame_modulus = -1.0e9;  // auxetic: nu near -1, mu near -3 lambda / 2
  const Moduli m = moduli_of(given);
  EXPECT_NEAR(m.youngs() / 3.0, 1.0, roundoff(10.0, 1.0));
  EXPECT_GT(m.bulk, 0.0);
}

TEST(Moduli, WhatIsNoSolidIsRefused) {
  const auto of = [](std::size_t i, double a, std::size_t k, double b) {
    ElasticConstants given;
    given.*constants[i] = a;
    given.*constants[k] = b;
    return refusal([&given] { (void)moduli_of(given); });
  };
  EXPECT_NE(of(0, 1.0e9, 1, 0.5).find("poissons_ratio = 0.5"), std::string::npos);
  EXPECT_NE(of(0, 1.0e9, 1, 0.7).find("bulk modulus of -"), std::string::npos);
  EXPECT_NE(of(0, 1.0e9, 1, -1.0), "");
  EXPECT_NE(of(0, -1.0e9, 1, 0.3), "");
  EXPECT_NE(of(1, 0.0, 3, 0.0), "");   // nu = 0 says nothing about lambda = 0
  EXPECT_NE(of(0, 10.0, 2, 1.0), "");  // E > 9 kappa: negative shear modulus
  EXPECT_NE(of(0, 3.1, 4, 1.0), "");   // E > 3 mu: negative bulk modulus
  EXPECT_NE(of(2, 1.0, 3, 1.0), "");   // kappa = lambda: a liquid
  EXPECT_NE(of(2, std::nan(""), 4, 1.0), "");
}

TEST(Moduli, OneConstantOrThreeAreRefusedByName) {
  ElasticConstants given;
  EXPECT_NE(refusal([&given] { (void)moduli_of(given); }).find("none"), std::string::npos);
  given.youngs_modulus = 1.0;
  given.poissons_ratio = 0.2;
  given.shear_modulus = 0.4;
  const std::string text = refusal([&given] { (void)moduli_of(given); });
  EXPECT_NE(text.find("shear_modulus = 0.4"), std::string::npos);
  EXPECT_NE(text.find("exactly two"), std::string::npos);
}

/// Whatever is not refused has all that is derived from it, as finite numbers.
TEST(Materials, NumbersAtTheEndOfTheirRangeAreRefusedOrHaveAllThatIsDerived) {
  const std::vector<double> values = {5e-324, 1e-310, 1e-160, 1e-100, 1.0, 1e100, 1e160, 1e308};
  int made = 0, refused = 0;
  for (std::size_t i = 0; i < std::size(constants); ++i) {
    for (std::size_t k = 0; k < std::size(constants); ++k) {
      for (const double a : values) {
        for (const double b : values) {
          if (i == k) continue;
          ElasticConstants given;
          given.*constants[i] = a;
          given.*constants[k] = b;
          const std::string said = refusal([&] {
            const LinearElastic law(moduli_of(given), a);
            const Moduli m = law.moduli();
            for (const double derived : {m.p_wave(), m.youngs(), m.lame(), m.poissons_ratio(),
                                         std::sqrt(m.p_wave() / law.density())})
              EXPECT_TRUE(std::isfinite(derived)) << i << " " << k << " " << a << " " << b;
          });
          ++(said == "not refused" ? made : refused);
        }
      }
    }
  }
  EXPECT_GT(made, 20);
  EXPECT_GT(refused, 100);
}

TEST(Materials, InadmissibleParametersAreRefusedByName) {
  const std::string density = refusal([] { LinearElastic({1.0, 1.0}, 0.0); });
  EXPECT_NE(density.find("density"), std::string::npos);
  EXPECT_NE(refusal([] {
              LinearElastic({1.0, -1.0}, 1.0);
            }).find("shear_modulus"),
            std::string::npos);
  MooneyRivlinParameters rubber{1.0, -1.0, 1.0, 1.0};
  EXPECT_NE(refusal([&rubber] { MooneyRivlin{rubber}; }).find("c10 + c01"), std::string::npos);
}

}  // namespace
}  // namespace abut::material_moduli_tests
