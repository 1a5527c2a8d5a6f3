// Goal: the batched laws are the scalar laws, lane by lane and bit by bit on every machine.
// Oracles: the scalar laws; the cube root in extended precision; the same kernel for other
// registers.

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/materials/batched_tangents.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_batched_tests {
namespace {

template <int N>
TensorLanes<N> gather(const std::vector<Matrix3>& f, std::size_t first) {
  TensorLanes<N> lanes;
  for (int k = 0; k < 9; ++k)
    for (int l = 0; l < N; ++l) lanes.entry[k][l] = f[first + index(l)].reshaped()[k];
  return lanes;
}

/// 64 deformations from small strains to stretches of 0.4 and 2.5, in turned axes.
std::vector<Matrix3> many_deformations() {
  DrawTensors draw;
  std::vector<Matrix3> f;
  for (int i = 0; i < 32; ++i) f.push_back(Matrix3::Identity() + draw.matrix(1.0e-3 * i));
  for (int i = 0; i < 32; ++i) {
    const Eigen::Vector3d stretch =
        Eigen::Vector3d::NullaryExpr([&draw] { return draw.between(0.4, 2.5); });
    f.push_back(draw.rotation() * stretch.asDiagonal() * draw.rotation());
  }
  return f;
}

template <int N, class Batched>
void expect_agreement(const Batched& batched, const Material& law) {
  const std::vector<Matrix3> f = many_deformations();
  for (std::size_t i = 0; i < f.size(); i += N) {
    const TensorLanes<N> at = gather<N>(f, i);
    TensorLanes<N> p;
    typename Lanes<N>::Real valid;
    batched.stress(at, p, valid);
    EXPECT_TRUE(all_positive(valid));
    const typename Lanes<N>::Real energy = batched.energy(minus_identity(at));
    for (int l = 0; l < N; ++l) {
      History none;
      const PointResponse r = answer(law, f[i + index(l)], none);
      const double scale = r.tangent.cwiseAbs().maxCoeff();
      for (int k = 0; k < 9; ++k)
        // F rounds at 1e-16 of itself, P then at the modulus times that: some hundred of these.
        EXPECT_NEAR(p.entry[k][l], r.stress.reshaped()[k], 1.0e-13 * scale);
      // Strains of 1e-3 against F of 1: a rounding of F is 1e-13 of them.
      EXPECT_NEAR(energy[l], r.energy, 1.0e-13 * r.energy);
    }
  }
}

TEST(BatchedLaws, AreTheScalarLaws) {
  const LinearElastic linear(test_moduli, 1.0);
  const SaintVenantKirchhoff kirchhoff(test_moduli, 1.0);
  const NeoHookean rubber(test_moduli, 1.0);
  expect_agreement<4>(BatchedLinearElastic{test_moduli}, linear);
  expect_agreement<8>(BatchedLinearElastic{test_moduli}, linear);
  expect_agreement<4>(BatchedSaintVenantKirchhoff{test_moduli}, kirchhoff);
  expect_agreement<8>(BatchedSaintVenantKirchhoff{test_moduli}, kirchhoff);
  expect_agreement<4>(BatchedNeoHookean{test_moduli}, rubber);
  expect_agreement<8>(BatchedNeoHookean{test_moduli}, rubber);
}

template <int N, class Batched>
void expect_equal_tangents(const Batched& batched, const Material& law) {
  const std::vector<Matrix3> f = many_deformations();
  for (std::size_t i = 0; i < f.size(); i += N) {
    ElasticityLanes<N> moduli;
    typename Lanes<N>::Real valid;
    batched(minus_identity(gather<N>(f, i)), moduli, valid);
    EXPECT_TRUE(all_positive(valid));
    for (int lane = 0; lane < N; ++lane) {
      History none;
      const Tangent t = answer(law, f[i + index(lane)], none).tangent;
      const double scale = t.cwiseAbs().maxCoeff();
      for (int j = 0; j < 3; ++j)
        for (int l = j; l < 3; ++l)
          for (int r = 0; r < 9; ++r)
            // rounding as that of stresses
            EXPECT_NEAR(moduli.at[j][l][r / 3][r % 3][lane], t(r / 3 + 3 * j, r % 3 + 3 * l),
                        1.0e-13 * scale);
    }
  }
}

TEST(BatchedLaws, HaveTheTangentsOfTheScalarLaws) {
  const LinearElastic linear(test_moduli, 1.0);
  const SaintVenantKirchhoff kirchhoff(test_moduli, 1.0);
  const NeoHookean rubber(test_moduli, 1.0);
  expect_equal_tangents<4>(LinearElasticTangent{test_moduli}, linear);
  expect_equal_tangents<8>(LinearElasticTangent{test_moduli}, linear);
  expect_equal_tangents<4>(SaintVenantKirchhoffTangent{test_moduli}, kirchhoff);
  expect_equal_tangents<8>(SaintVenantKirchhoffTangent{test_moduli}, kirchhoff);
  expect_equal_tangents<4>(NeoHookeanTangent{test_moduli}, rubber);
  expect_equal_tangents<8>(NeoHookeanTangent{test_moduli}, rubber);
}

TEST(BatchedLaws, InverseCubeRootErrsByTwoRoundings) {
  DrawTensors draw;
  double worst = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    const double range = i % 2 == 0 ? 0.5 : 200.0;  // around 1, and across the exponents
    double x[4];
    for (double& lane : x) lane = std::exp(draw.between(-range, range));
    double y[4];
    store<4>(inverse_cube_root<4>(load<4>(x)), y);
    for (int l = 0; l < 4; ++l) {
      const long double exact = 1.0L / std::cbrt(static_cast<long double>(x[l]));
      worst = std::fmax(worst, static_cast<double>(std::abs((y[l] - exact) / exact)));
    }
  }
  EXPECT_LT(worst, roundoff(2.0, 0.5));
}

TEST(BatchedLaws, OneInvertedLaneIsSeenAndLeavesTheOthersAlone) {
  std::vector<Matrix3> f(4, Matrix3(1.1 * Matrix3::Identity()));
  f[2](0, 0) = -1.0;
  const auto check = [&f](const auto& law) {
    TensorLanes<4> p, alone;
    Lanes<4>::Real valid, all;
    law.stress(gather<4>(f, 0), p, valid);
    EXPECT_FALSE(all_positive(valid));
    EXPECT_LT(valid[2], 0.0);
    law.stress(gather<4>(std::vector<Matrix3>(4, f[0]), 0), alone, all);
    EXPECT_TRUE(all_positive(all));
    for (int k = 0; k < 9; ++k) EXPECT_EQ(p.entry[k][3], alone.entry[k][3]);
  };
  check(BatchedNeoHookean{test_moduli});
  check(BatchedSaintVenantKirchhoff{test_moduli});
  f[2](0, 0) = std::numeric_limits<double>::quiet_NaN();
  TensorLanes<4> p;
  Lanes<4>::Real valid;
  BatchedNeoHookean{test_moduli}.stress(gather<4>(f, 0), p, valid);
  EXPECT_FALSE(all_positive(valid));
}

#if defined(__x86_64__)
template <int N>
void plain(const TensorLanes<N>& f, TensorLanes<N>& p) {
  typename Lanes<N>::Real valid;
  BatchedNeoHookean{test_moduli}.stress(f, p, valid);
}
template <int N>
__attribute__((target("avx2,fma"))) void wide(const TensorLanes<N>& f, TensorLanes<N>& p) {
  typename Lanes<N>::Real valid;
  BatchedNeoHookean{test_moduli}.stress(f, p, valid);
}
template <int N>
__attribute__((target("avx512f,avx512dq,fma"))) void widest(const TensorLanes<N>& f,
                                                            TensorLanes<N>& p) {
  typename Lanes<N>::Real valid;
  BatchedNeoHookean{test_moduli}.stress(f, p, valid);
}

TEST(BatchedLaws, SameBitsWhateverTheRegisters) {
  if (!__builtin_cpu_supports("fma") || !__builtin_cpu_supports("avx2"))
    GTEST_SKIP() << "this machine has one kind of registers";
  const std::vector<Matrix3> f = many_deformations();
  for (std::size_t i = 0; i < f.size(); i += 8) {
    TensorLanes<8> a, b;
    plain<8>(gather<8>(f, i), a);
    wide<8>(gather<8>(f, i), b);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
      widest<8>(gather<8>(f, i), b);
      EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
    TensorLanes<4> low, high;
    plain<4>(gather<4>(f, i), low);
    plain<4>(gather<4>(f, i + 4), high);
    for (int k = 0; k < 9; ++k)
      for (int l = 0; l < 4; ++l) {
        EXPECT_EQ(low.entry[k][l], a.entry[k][l]);
        EXPECT_EQ(high.entry[k][l], a.entry[k][l + 4]);
      }
  }
}
#endif

}  // namespace
}  // namespace abut::material_batched_tests
