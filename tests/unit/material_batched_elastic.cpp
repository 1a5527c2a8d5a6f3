// Goal: the batched Mooney-Rivlin and Hencky laws are the scalar ones at every strain, in the plane
// and in space; what bounds Hencky's tangents does. Oracles: the scalar laws, the same points in
// another company and in registers of another width.

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/batched_responses.hpp"
#include "subdomain_solver/materials/batched_j2_bound.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::material_batched_elastic_tests {
namespace {

const MooneyRivlinNumbers numbers{0.15, 0.1};

template <int N>
TensorLanes<N> gradients(const std::vector<Matrix3>& f, std::size_t first) {
  TensorLanes<N> h;
  for (int k = 0; k < 9; ++k)
    for (int l = 0; l < N; ++l)
      h.entry[k][l] = f[first + index(l)].reshaped()[k] - (k % 4 == 0 ? 1.0 : 0.0);
  return h;
}

/// Small and large strains and turns; two and three stretches that coincide or nearly do, on both
/// sides of the strain at which logarithms are found in another way; all of it in the plane, too.
std::vector<Matrix3> deformations() {
  std::vector<Matrix3> f = sample_deformations();
  DrawTensors draw;
  for (const double size : {1.0e-10, 1.0e-6, 1.0e-3, 0.01, 0.03, 0.06, 0.1, 0.2})
    for (int i = 0; i < 4; ++i) f.push_back(Matrix3::Identity() + draw.matrix(size));
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d stretch =
        Eigen::Vector3d::NullaryExpr([&draw] { return draw.between(0.4, 2.5); });
    f.push_back(draw.rotation() * stretch.asDiagonal() * draw.rotation());
  }
  for (const double apart : {0.0, 1.0e-15, 1.0e-12, 1.0e-8, 1.0e-4})
    for (const double pair : {0.5, 0.97, 1.04, 2.0})
      for (const double third : {0.4, 1.0, 2.5})
        f.push_back(draw.rotation() *
                    Eigen::Vector3d(pair, third, pair * (1.0 + apart)).asDiagonal() *
                    draw.rotation());
  for (const double stretch : {0.6, 1.05, 1.9})
    f.push_back(Eigen::Vector3d(1.0, stretch, 1.0).asDiagonal());
  const std::size_t count = f.size();
  for (std::size_t i = 0; i < count; ++i) {
    Matrix3 flat = f[i];
    flat.row(2).setZero();
    flat.col(2).setZero();
    flat(2, 2) = 1.0;
    if (flat.determinant() < 0.0) flat.col(0) *= -1.0;
    if (flat.determinant() > 0.1) f.push_back(flat);  // a cut through turned axes may be flat
  }
  while (f.size() % 8 != 0) f.push_back(Matrix3::Identity());
  return f;
}

/// F rounds at 1e-16 of itself, P then at the modulus times that; a principal value of b rounds as
/// the largest does, which is up to 40 times it.
constexpr double roundings = 500.0;

template <int N, class Response>
void expect_responses(const Response& lanes, const Material& law) {
  const std::vector<Matrix3> f = deformations();
  for (std::size_t i = 0; i < f.size(); i += N) {
    LaneResponse<N> found;
    lanes(gradients<N>(f, i), found);
    EXPECT_TRUE(all_positive(found.valid));
    for (int l = 0; l < N; ++l) {
      History none;
      SCOPED_TRACE(i + index(l));
      const PointResponse r = answer(law, f[i + index(l)], none);
      const double scale = r.tangent.cwiseAbs().maxCoeff();
      for (int k = 0; k < 9; ++k)
        EXPECT_NEAR(found.stress.entry[k][l], r.stress.reshaped()[k], roundoff(roundings, scale));
      // Strains, of which energies are squares, round as F does.
      EXPECT_NEAR(found.energy[l], r.energy, roundoff(roundings, r.energy + std::sqrt(r.energy)));
    }
  }
}

TEST(BatchedElastic, RespondsAsTheScalarLaws) {
  const MooneyRivlin rubber({numbers.c10, numbers.c01, test_moduli.bulk, 1.0});
  const Hencky hencky(test_moduli, 1.0);
  const MooneyRivlinResponse rubber_lanes{test_moduli, numbers};
  expect_responses<2>(rubber_lanes, rubber);
  expect_responses<4>(rubber_lanes, rubber);
  expect_responses<8>(rubber_lanes, rubber);
  expect_responses<2>(HenckyResponse{test_moduli}, hencky);
  expect_responses<4>(HenckyResponse{test_moduli}, hencky);
  expect_responses<8>(HenckyResponse{test_moduli}, hencky);
}

/// Energies keep the digits of small strains: no difference of invariants near 3 is left.
TEST(BatchedElastic, EnergiesOfSmallStrainsAreThoseOfLinearElasticity) {
  DrawTensors draw;
  for (const double size : {1.0e-4, 1.0e-6, 1.0e-8}) {
    std::vector<Matrix3> f;
    for (int l = 0; l < 4; ++l) f.push_back(Matrix3::Identity() + draw.matrix(size));
    const TensorLanes<4> h = gradients<4>(f, 0);
    LaneResponse<4> linear, found;
    LinearElasticResponse{test_moduli}(h, linear);
    const auto check = [&](const auto& law) {
      law(h, found);
      // Terms of third order, some tens of the strain of those of second; first-order terms, which
      // cancel, round as F does.
      for (int l = 0; l < 4; ++l)
        EXPECT_NEAR(found.energy[l], linear.energy[l],
                    (100.0 * size + roundoff(100.0, 1.0) / size) * linear.energy[l]);
    };
    check(HenckyResponse{test_moduli});
    check(MooneyRivlinResponse{test_moduli, numbers});
  }
}

template <int N>
void expect_tangents() {
  const MooneyRivlin law({numbers.c10, numbers.c01, test_moduli.bulk, 1.0});
  const std::vector<Matrix3> f = deformations();
  for (std::size_t i = 0; i < f.size(); i += N) {
    ElasticityLanes<N> moduli;
    typename Lanes<N>::Real valid;
    MooneyRivlinTangent{test_moduli, numbers}(gradients<N>(f, i), moduli, valid);
    EXPECT_TRUE(all_positive(valid));
    for (int lane = 0; lane < N; ++lane) {
      History none;
      const Tangent t = answer(law, f[i + index(lane)], none).tangent;
      const double scale = t.cwiseAbs().maxCoeff();
      for (int j = 0; j < 3; ++j)
        for (int l = j; l < 3; ++l)
          for (int r = 0; r < 9; ++r)
            EXPECT_NEAR(moduli.at[j][l][r / 3][r % 3][lane], t(r / 3 + 3 * j, r % 3 + 3 * l),
                        roundoff(roundings, scale));
    }
  }
}

TEST(BatchedElastic, HasTheTangentsOfMooneyRivlin) {
  expect_tangents<2>();
  expect_tangents<4>();
  expect_tangents<8>();
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

TEST(BatchedElastic, NoTangentOfHenckyExceedsItsBound) {
  const Hencky law(test_moduli, 1.0);
  const std::vector<Matrix3> f = deformations();
  DrawTensors draw;
  for (std::size_t i = 0; i < f.size(); i += 4) {
    ElasticityLanes<4> bound;
    Lanes<4>::Real valid;
    HenckyBound{test_moduli}(gradients<4>(f, i), bound, valid);
    ASSERT_TRUE(all_positive(valid));
    for (int l = 0; l < 4; ++l) {
      History none;
      const Matrix3& at = f[i + index(l)];
      const Tangent tangent = answer(law, at, none).tangent;
      const double scale = tangent.cwiseAbs().maxCoeff();
      for (int k = 0; k < 50; ++k) {
        const Matrix3 h = draw.matrix(1.0);
        EXPECT_LE(form(tangent, h), form(bound, l, h) + roundoff(roundings, scale));
      }
      // At rest the bound is the moduli themselves, twice mu across.
      if ((at - Matrix3::Identity()).norm() < 1.0e-6) {
        const Matrix3 h = Matrix3::Identity();
        EXPECT_LE(form(bound, l, h), 1.0001 * form(tangent, h));
      }
    }
  }
}

/// The laws in lanes; `check` takes one that answers.
template <class Check>
void for_each_law(const Check& check) {
  check(MooneyRivlinResponse{test_moduli, numbers});
  check(HenckyResponse{test_moduli});
}

TEST(BatchedElastic, ALaneHasItsBitsInEveryCompanyAndWidth) {
  const std::vector<Matrix3> f = deformations();
  for_each_law([&f](const auto& law) {
    LaneResponse<8> wide, company;
    LaneResponse<4> half;
    LaneResponse<2> narrow;
    for (std::size_t i = 0; i < f.size(); i += 8) {
      law(gradients<8>(f, i), wide);
      law(gradients<4>(f, i + 4), half);
      law(gradients<2>(f, i + 6), narrow);
      std::vector<Matrix3> others(8, Matrix3(-Matrix3::Identity()));
      others[1] = Eigen::Vector3d(3.0, 0.5, 1.0).asDiagonal();
      others[7] = f[i + 7];
      law(gradients<8>(others, 0), company);
      for (int k = 0; k < 9; ++k) {
        EXPECT_EQ(wide.stress.entry[k][7], half.stress.entry[k][3]);
        EXPECT_EQ(wide.stress.entry[k][7], narrow.stress.entry[k][1]);
        EXPECT_EQ(wide.stress.entry[k][7], company.stress.entry[k][7]);
      }
      EXPECT_EQ(wide.energy[7], half.energy[3]);
      EXPECT_EQ(wide.energy[7], narrow.energy[1]);
      EXPECT_EQ(wide.energy[7], company.energy[7]);
    }
  });
}

TEST(BatchedElastic, TellsWhereItHasNoAnswer) {
  std::vector<Matrix3> f(8, Matrix3(1.1 * Matrix3::Identity()));
  f[1] = -Matrix3::Identity();
  f[2](0, 0) = std::numeric_limits<double>::quiet_NaN();
  f[3](0, 1) = std::numeric_limits<double>::quiet_NaN();
  f[4](2, 2) = 0.0;
  f[5](1, 1) = -0.1;
  f[6](0, 0) = std::numeric_limits<double>::infinity();
  for_each_law([&f](const auto& law) {
    LaneResponse<8> found;
    law(gradients<8>(f, 0), found);
    for (int l = 0; l < 8; ++l) {
      SCOPED_TRACE(l);
      // Infinite numbers are for the sums of the cells to find, as those of every batched law.
      const bool answers = found.valid[l] > 0.0 && std::isfinite(found.energy[l]);
      EXPECT_EQ(answers, l == 0 || l == 7);
    }
  });
}

}  // namespace
}  // namespace abut::material_batched_elastic_tests
