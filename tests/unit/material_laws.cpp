// Goal: every law is what a law must be: stress the gradient of an energy, tangent the gradient of
// the stress, objective, isotropic, stress-free at rest, linear elastic for small strains, and
// without an answer rather than with a wrong one where it is not defined.
// Oracles: central differences, identities.

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/material_gradients.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_laws_tests {
namespace {

class MaterialLaw : public testing::TestWithParam<Law> {
 protected:
  const Material& law() const { return *GetParam().law; }

  /// Histories to start from: none, and that after a large shear.
  std::vector<History> histories() const {
    std::vector<History> list = {zero_history(law())};
    if (law().history_size() == 0) return list;
    History sheared = list.front();
    Matrix3 f = Matrix3::Identity();
    f(0, 1) = 0.3;
    f(2, 0) = -0.1;
    answer(law(), f, sheared, true);
    list.push_back(sheared);
    return list;
  }
};

constexpr std::array<int, 9> every_entry = {0, 1, 2, 3, 4, 5, 6, 7, 8};

TEST_P(MaterialLaw, StressIsTheGradientOfStoredAndDissipatedEnergy) {
  for (const History& start : histories())
    for (const Matrix3& f : sample_deformations())
      EXPECT_LT(gradient_error(law(), f, start, every_entry), 1.0) << "at\n" << f;
}

TEST_P(MaterialLaw, TangentIsTheGradientOfTheStress) {
  for (const History& start : histories())
    for (const Matrix3& f : sample_deformations())
      EXPECT_LT(tangent_error(law(), f, start, every_entry), 1.0) << "at\n" << f;
}

TEST_P(MaterialLaw, TangentIsSymmetric) {
  for (History& start : histories())
    for (const Matrix3& f : sample_deformations()) {
      const Tangent a = answer(law(), f, start).tangent;
      EXPECT_LT((a - a.transpose()).cwiseAbs().maxCoeff(),
                roundoff(100.0, a.cwiseAbs().maxCoeff()));
    }
}

TEST_P(MaterialLaw, ObjectiveUnlessSmallStrain) {
  DrawTensors draw;
  for (History& start : histories())
    for (const Matrix3& f : sample_deformations()) {
      const Matrix3 q = draw.rotation();
      History turned_history = start, history = start;
      const PointResponse turned = answer(law(), q * f, turned_history, true);
      const PointResponse at = answer(law(), f, history, true);
      const double error = (turned.stress - q * at.stress).cwiseAbs().maxCoeff();
      const double scale = at.tangent.cwiseAbs().maxCoeff();
      if (GetParam().objective) {
        EXPECT_LT(error, roundoff(100.0, scale));  // strains of a turned F round at its size 1
        EXPECT_NEAR(turned.energy, at.energy, roundoff(100.0, scale));
        EXPECT_LT(largest_difference(turned_history, history), roundoff(100.0, 1.0));
      } else {
        EXPECT_GT(error, 1.0e-3 * scale);  // linear_elastic: a rotation strains it, by its nature
      }
    }
}

TEST_P(MaterialLaw, Isotropic) {
  DrawTensors draw;
  for (const Matrix3& f : sample_deformations()) {
    // A material turned by Q in the reference and space, under the turned deformation.
    const Matrix3 q = draw.rotation();
    History none = zero_history(law());
    const PointResponse turned = answer(law(), q.transpose() * f * q, none);
    const PointResponse at = answer(law(), f, none);
    const Matrix3 expected = q.transpose() * at.stress * q;
    const double scale = at.tangent.cwiseAbs().maxCoeff();
    EXPECT_LT((turned.stress - expected).cwiseAbs().maxCoeff(), roundoff(100.0, scale));
    EXPECT_NEAR(turned.energy, at.energy, roundoff(100.0, scale));
  }
}

TEST_P(MaterialLaw, RestIsFreeOfStressAndEnergyAndHasTheModuli) {
  History none = zero_history(law());
  const PointResponse rest = answer(law(), Matrix3::Identity(), none, true);
  EXPECT_EQ(rest.stress.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(rest.energy, 0.0);
  EXPECT_EQ(rest.dissipation, 0.0);
  EXPECT_EQ(none, zero_history(law()));
  const LinearElastic hooke(law().moduli(), 1.0);
  const Tangent expected = answer(hooke, Matrix3::Identity(), none).tangent;
  EXPECT_LT((rest.tangent - expected).cwiseAbs().maxCoeff(), roundoff(10.0, 2.0));
  EXPECT_EQ(law().is_linear(), GetParam().name == "linear_elastic");
}

TEST_P(MaterialLaw, SmallStrainsKeepTheirDigits) {
  // Against linear elasticity the difference is of the order of the strain, down to strains where
  // F F^T - I computed from F F^T would hold half a dozen digits or none.
  DrawTensors draw;
  const LinearElastic hooke(law().moduli(), 1.0);
  for (const double size : {1.0e-4, 1.0e-7, 1.0e-10}) {
    Matrix3 h = draw.matrix(size);
    h = 0.5 * (h + h.transpose()).eval();
    const Matrix3 f = Matrix3::Identity() + h;
    History none = zero_history(law()), empty;
    const PointResponse at = answer(law(), f, none), linear = answer(hooke, f, empty);
    // Products of two strains with coefficients up to 10, and H itself rounds at 1e-16.
    const double tolerance = 10.0 * size + 1.0e-15 / size;
    EXPECT_LT((at.stress - linear.stress).cwiseAbs().maxCoeff(),
              tolerance * linear.stress.cwiseAbs().maxCoeff());
    EXPECT_NEAR(at.energy / linear.energy, 1.0, 3.0 * tolerance);
  }
}

TEST_P(MaterialLaw, StressAloneIsTheSameStress) {
  for (const Matrix3& f : sample_deformations()) {
    History none = zero_history(law());
    const PointResponse both = answer(law(), f, none);
    const PointResponse stress = answer(law(), f, none, false, Need::stress);
    EXPECT_EQ(both.stress, stress.stress);
    EXPECT_EQ(both.energy, stress.energy);
  }
}

TEST_P(MaterialLaw, InadmissibleDeformationHasNoAnswer) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const History before = zero_history(law());
  History after = before;
  PointResponse out;
  const auto answers = [&](const Matrix3& f) {
    return law().evaluate(f, before, after, Need::tangent, out);
  };
  const Matrix3 identity = Matrix3::Identity();
  Matrix3 mirrored = identity, flat = identity, broken = identity, endless = identity;
  mirrored(1, 1) = -0.5;
  flat(2, 2) = 0.0;
  broken(0, 2) = nan;
  endless(1, 1) = inf;
  if (GetParam().objective) {
    EXPECT_FALSE(answers(mirrored));
    EXPECT_FALSE(answers(flat));
    EXPECT_FALSE(answers(Matrix3::Zero()));
  }
  EXPECT_FALSE(answers(broken));
  EXPECT_FALSE(answers(endless));
  for (const double size : {1.0e-120, 1.0e-40, 1.0e40, 1.0e120}) {
    if (!answers(size * identity)) continue;
    EXPECT_TRUE(out.stress.allFinite() && out.tangent.allFinite() && std::isfinite(out.energy));
  }
}

INSTANTIATE_TEST_SUITE_P(All, MaterialLaw, testing::ValuesIn(all_laws()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace abut::material_laws_tests
