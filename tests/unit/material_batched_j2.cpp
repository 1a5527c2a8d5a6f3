// Goal: batched J2 plasticity is the scalar law, point by point, through histories; what bounds its
// tangents does. Oracles: the scalar law, the exponential in extended precision, the same points
// in another company.

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/materials/batched_j2_bound.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_batched_j2_tests {
namespace {

/// F rounds at 1e-16 of itself, P then at the modulus times that, and C_p^-1 too; large stretches
/// and turns multiply it: some hundred of these.
constexpr double roundings = 500.0;

/// Hardening of the tests, `higher` times as high: points stay elastic up to larger strains.
Hardening hardening_of(double higher, bool saturates) {
  Hardening h = test_hardening();
  h.yield_stress *= higher;
  h.modulus *= higher;
  h.saturation->stress *= higher;
  if (!saturates) h.saturation.reset();
  return h;
}

HardeningNumbers numbers_of(const Hardening& h) {
  if (!h.saturation) return {h.yield_stress, h.modulus, 0.0, 0.0};
  return {h.yield_stress, h.modulus, h.saturation->stress - h.yield_stress, h.saturation->rate};
}

template <int N>
TensorLanes<N> gradients(const std::vector<Matrix3>& f) {
  TensorLanes<N> h;
  for (int k = 0; k < 9; ++k)
    for (int l = 0; l < N; ++l)
      h.entry[k][l] = f[index(l)].reshaped()[k] - (k % 4 == 0 ? 1.0 : 0.0);
  return h;
}

template <int N>
J2HistoryLanes<N> histories(const std::vector<History>& list) {
  J2HistoryLanes<N> out;
  for (int k = 0; k < 7; ++k)
    for (int l = 0; l < N; ++l) out.at[k][l] = list[index(l)][index(k)];
  return out;
}

/// How often points yielded, and how often they did not though they had before.
struct Seen {
  int yielded = 0, unloaded = 0;
};

template <int N>
void expect_agreement(const Hardening& hardening, const std::vector<Matrix3>& f,
                      std::vector<History>& at, Seen& seen) {
  const J2Plasticity law(test_moduli, hardening, 1.0);
  const HardeningNumbers numbers = numbers_of(hardening);
  const J2HistoryLanes<N> before = histories<N>(at);
  const J2Lanes<N> lanes(test_moduli, numbers, gradients<N>(f), before);
  TensorLanes<N> p;
  J2HistoryLanes<N> after;
  lanes.stress(test_moduli, p);
  lanes.advance(before, after);
  const typename Lanes<N>::Real energy = lanes.energy(test_moduli, numbers, after);
  for (int l = 0; l < N; ++l) {
    History& own = at[index(l)];
    const double a = own[6];
    const PointResponse r = answer(law, f[index(l)], own, true);
    ASSERT_TRUE(lanes.valid[l] != 0);
    seen.yielded += own[6] > a;
    seen.unloaded += own[6] == a && a > 0.0;
    const double scale = r.tangent.cwiseAbs().maxCoeff();
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(p.entry[k][l], r.stress.reshaped()[k], roundoff(roundings, scale));
    double largest = 1.0;  // C_p^-1 - I rounds as C_p^-1 does
    for (int k = 0; k < 6; ++k) largest = std::max(largest, std::abs(own[index(k)]));
    for (int k = 0; k < 7; ++k)
      EXPECT_NEAR(after.at[k][l], own[index(k)], roundoff(roundings, largest));
    // Elastic strains, of which energies are squares, round as F does.
    EXPECT_NEAR(energy[l], r.energy, roundoff(roundings, r.energy + std::sqrt(r.energy)));
    EXPECT_NEAR(hardening.yield_stress * lanes.flow[l], r.dissipation, roundoff(roundings, scale));
  }
}

/// Every other lane rests in the second half of its way, and its neighbours go on.
template <int N>
Seen walk(const Hardening& hardening, double size, int steps) {
  DrawTensors draw;
  std::vector<Matrix3> f(N);
  for (Matrix3& at : f) at = draw.rotation();
  std::vector<History> history(N, History(7, 0.0));
  Seen seen;
  for (int s = 0; s < steps; ++s) {
    for (std::size_t l = 0; l < f.size(); ++l)
      if (l % 2 == 0 || s < steps / 2) f[l] += draw.matrix(size) * f[l];
    expect_agreement<N>(hardening, f, history, seen);
  }
  return seen;
}

TEST(BatchedJ2, IsTheScalarLawThroughLoadingAndUnloading) {
  for (const bool saturates : {false, true}) {
    for (const double size : {1.0e-8, 1.0e-3, 5.0e-3, 0.05, 0.2}) {
      SCOPED_TRACE(size);
      for (const Seen& seen : {walk<2>(hardening_of(1.0, saturates), size, 40),
                               walk<4>(hardening_of(1.0, saturates), size, 40),
                               walk<8>(hardening_of(1.0, saturates), size, 40)}) {
        EXPECT_EQ(seen.yielded > 0, size > 2.0e-3);
        EXPECT_EQ(seen.unloaded > 0, size > 2.0e-3);
      }
    }
  }
}

/// Elastic strains of 20 % and more, of which logarithms are found in principal axes.
TEST(BatchedJ2, IsTheScalarLawAtLargeElasticStrains) {
  for (const double higher : {5.0, 15.0, 1000.0}) {
    for (const double size : {0.05, 0.2}) {
      const Seen seen = walk<4>(hardening_of(higher, true), size, 30);
      EXPECT_EQ(seen.yielded > 0, higher < 100.0);
    }
  }
}

TEST(BatchedJ2, IsTheScalarLawWhereStretchesCoincide) {
  const std::vector<Matrix3> samples = sample_deformations();
  for (const double higher : {1.0, 10.0, 1000.0}) {
    Seen seen;
    for (std::size_t i = 0; i + 4 <= samples.size(); ++i) {
      std::vector<History> history(4, History(7, 0.0));
      const std::vector<Matrix3> f(samples.begin() + static_cast<std::ptrdiff_t>(i),
                                   samples.begin() + static_cast<std::ptrdiff_t>(i + 4));
      expect_agreement<4>(hardening_of(higher, true), f, history, seen);
    }
    EXPECT_EQ(seen.yielded > 0, higher < 100.0);
  }
}

/// Lanes that yield, or are far from a sphere, beside one that does neither.
TEST(BatchedJ2, ALaneHasItsBitsInEveryCompany) {
  DrawTensors draw;
  const HardeningNumbers numbers = numbers_of(hardening_of(10.0, true));
  const Matrix3 still = Matrix3::Identity() + draw.matrix(1.0e-3);
  std::vector<Matrix3> f(4, still);
  const std::vector<History> history(4, History(7, 0.0));
  const auto stress = [&] {
    const J2Lanes<4> lanes(test_moduli, numbers, gradients<4>(f), histories<4>(history));
    TensorLanes<4> p;
    lanes.stress(test_moduli, p);
    return p;
  };
  const TensorLanes<4> alone = stress();
  f[0] = Matrix3::Identity() + draw.matrix(0.1);
  f[1] = draw.rotation() * Eigen::Vector3d(3.0, 0.5, 1.0).asDiagonal();
  f[3] = -Matrix3::Identity();
  const TensorLanes<4> beside = stress();
  for (int k = 0; k < 9; ++k) EXPECT_EQ(alone.entry[k][2], beside.entry[k][2]);
}

TEST(BatchedJ2, TellsWhereItHasNoAnswer) {
  std::vector<Matrix3> f(4, Matrix3(1.1 * Matrix3::Identity()));
  f[1] = Matrix3(-1.0 * Matrix3::Identity());
  f[2](0, 0) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<History> history(4, History(7, 0.0));
  const J2Lanes<4> lanes(test_moduli, numbers_of(hardening_of(1.0, true)), gradients<4>(f),
                         histories<4>(history));
  EXPECT_TRUE(lanes.valid[0] != 0);
  EXPECT_FALSE(lanes.valid[1] != 0);
  EXPECT_FALSE(lanes.valid[2] != 0);
  EXPECT_TRUE(lanes.valid[3] != 0);
}

/// H : A : H of a tangent, and of moduli block by block.
double form(const Tangent& t, const Matrix3& h) { return h.reshaped().dot(t * h.reshaped()); }
double form(const ElasticityLanes<4>& m, int lane, const Matrix3& h) {
  double sum = 0.0;
  for (int j = 0; j < 3; ++j)
    for (int l = j; l < 3; ++l)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          sum += (j == l ? 1.0 : 2.0) * h(i, j) * m.at[j][l][i][k][lane] * h(k, l);
  return sum;
}

TEST(BatchedJ2, NoTangentExceedsItsBound) {
  for (const double higher : {1.0, 5.0, 1000.0}) {
    const Hardening hardening = hardening_of(higher, true);
    const J2Plasticity law(test_moduli, hardening, 1.0);
    const HardeningNumbers numbers = numbers_of(hardening);
    DrawTensors draw;
    std::vector<History> history(4, History(7, 0.0));
    std::vector<Matrix3> f(4, Matrix3::Identity());
    for (int s = 0; s < 60; ++s) {
      for (Matrix3& at : f) at += draw.matrix(0.02) * at;
      ElasticityLanes<4> bound;
      Lanes<4>::Real valid;
      J2Bound{test_moduli, numbers}(gradients<4>(f), histories<4>(history), bound, valid);
      ASSERT_TRUE(all_positive(valid));
      for (int l = 0; l < 4; ++l) {
        const Tangent tangent = answer(law, f[index(l)], history[index(l)], true).tangent;
        const double scale = tangent.cwiseAbs().maxCoeff();
        for (int k = 0; k < 50; ++k) {
          const Matrix3 h = draw.matrix(1.0);
          EXPECT_LE(form(tangent, h), form(bound, l, h) + roundoff(roundings, scale));
        }
        // Small strains from rest: beside the moduli themselves, stresses of 2 % of them, once
        // each in both.
        if (s == 0 && higher > 100.0) {
          const Matrix3 h = Matrix3::Identity();
          EXPECT_LE(form(bound, l, h), 1.15 * form(tangent, h));
        }
      }
    }
  }
}

TEST(BatchedJ2, ExponentialsErrByTwoRoundings) {
  DrawTensors draw;
  double worst = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    double x[4], y[4];
    for (double& lane : x) lane = -std::exp(draw.between(-40.0, 4.0));
    x[3] = draw.between(-1.0, 20.0);
    store<4>(expm1_lanes<4>(load<4>(x)), y);
    for (int l = 0; l < 4; ++l) {
      const long double exact = std::expm1(static_cast<long double>(x[l]));
      worst = std::fmax(worst, static_cast<double>(std::abs((y[l] - exact) / exact)));
    }
  }
  EXPECT_LT(worst, roundoff(2.0, 1.0));
}

}  // namespace
}  // namespace abut::material_batched_j2_tests
