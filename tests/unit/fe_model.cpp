// Goal: a cell's force is the gradient of its energy and its tangent the derivative of the force,
// for every element, formulation, plane and law. Oracles: differences; identities of rigid motion.
#include "subdomain_solver/fe/fe_model.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "base/error.hpp"
#include "base/index.hpp"
#include "tests/support/cell_models.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_model_tests {
namespace {

struct Case : ElementCase {
  std::string law;
};

void PrintTo(const Case& c, std::ostream* out) {
  PrintTo(static_cast<const ElementCase&>(c), out);
  *out << " " << c.law;
}

std::vector<Case> cases(const std::vector<std::string>& laws) {
  std::vector<Case> out;
  for (const ElementCase& c : element_cases()) {
    for (const std::string& law : laws) out.push_back({c, law});
  }
  return out;
}

/// One distorted cell, away from the axis of an axisymmetric one.
FeModel one_cell(const Case& c) {
  Mesh mesh = unit_mesh(c.element, 1);
  DrawTensors draw;
  for (double& x : mesh.points) x += 1.0 + 0.05 * draw.between(-1.0, 1.0);
  FeOptions options{c.plane, c.formulation, 0.7};
  options.area = 0.6;
  return FeModel(std::move(mesh), law_named(c.law), options);
}

class Cells : public testing::TestWithParam<Case> {};

// Steps of 1e-6 at values of order 1: the error of central differences is 1e-12 of third
// derivatives of order 1 to 100, plus round-off 1e-16 / 1e-6.
constexpr double step = 1.0e-6, tolerance = 2.0e-8;

TEST_P(Cells, TangentIsTheDerivativeOfTheForce) {
  FeModel model = one_cell(GetParam());
  std::vector<double> q = displaced(model, 0.04);
  const std::vector<double> history(model.history_size(), 0.0);
  ModelResponse here, there;
  ASSERT_TRUE(model.evaluate(q, history, Model::Want::tangent, here));
  const double scale = Eigen::MatrixXd(here.tangent).cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double kept = q[k];
    q[k] = kept + step;
    ASSERT_TRUE(model.evaluate(q, history, Model::Want::force, there));
    Vector slope = there.force;
    q[k] = kept - step;
    ASSERT_TRUE(model.evaluate(q, history, Model::Want::force, there));
    slope = (slope - there.force) / (2.0 * step);
    q[k] = kept;
    const Vector column = Eigen::MatrixXd(here.tangent).col(static_cast<Eigen::Index>(k));
    EXPECT_LT((slope - column).cwiseAbs().maxCoeff(), tolerance * 10.0 * scale) << "column " << k;
  }
}

class ElasticCells : public Cells {};  // plasticity has no potential

TEST_P(ElasticCells, ForceIsTheGradientOfTheEnergy) {
  FeModel model = one_cell(GetParam());
  std::vector<double> q = displaced(model, 0.04);
  const std::vector<double> history(model.history_size(), 0.0);
  ModelResponse here, there;
  ASSERT_TRUE(model.evaluate(q, history, Model::Want::force, here));
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double kept = q[k];
    q[k] = kept + step;
    ASSERT_TRUE(model.evaluate(q, history, Model::Want::force, there));
    double slope = there.stored;
    q[k] = kept - step;
    ASSERT_TRUE(model.evaluate(q, history, Model::Want::force, there));
    slope = (slope - there.stored) / (2.0 * step);
    q[k] = kept;
    EXPECT_NEAR(slope, here.force(static_cast<Eigen::Index>(k)), tolerance) << "coordinate " << k;
  }
}

TEST_P(Cells, TranslationCostsNothing) {
  const Case& c = GetParam();
  FeModel model = one_cell(c);
  const int dim = model.mesh().dim;
  std::vector<double> q(index(model.dofs()));
  // Axisymmetric bodies are free to move along their axis alone.
  for (std::size_t i = 0; i < q.size(); ++i) {
    const bool along = c.plane != Plane::axisymmetric || i % index(dim) == 1;
    q[i] = along ? 0.3 : 0.0;
  }
  const std::vector<double> history(model.history_size(), 0.0);
  ModelResponse response;
  ASSERT_TRUE(model.evaluate(q, history, Model::Want::force, response));
  // Sums over at most 20 nodes of gradients of order 10 leave round-off of F - I.
  EXPECT_LT(response.force.cwiseAbs().maxCoeff(), roundoff(1000.0, 1.0));
}

const std::vector<std::string> elastic = {"linear_elastic", "neo_hookean"};
INSTANTIATE_TEST_SUITE_P(Elastic, Cells, testing::ValuesIn(cases(elastic)));
INSTANTIATE_TEST_SUITE_P(Plastic, Cells, testing::ValuesIn(cases({"j2_plasticity"})));
INSTANTIATE_TEST_SUITE_P(Elastic, ElasticCells, testing::ValuesIn(cases(elastic)));

TEST(FeModel, MassesAreThoseOfTheVolume) {
  for (const std::string& element : fe_elements()) {
    Mesh mesh = unit_mesh(element, 3);
    distort(mesh, 0.05);
    const FeModel model(std::move(mesh), std::make_unique<NeoHookean>(test_moduli, 2.0), {});
    const int dim = model.mesh().dim;
    const double total = 2.0 * dim;  // density x unit volume, in every direction
    EXPECT_NEAR(model.lumped_mass().sum(), total, roundoff(1e4, total)) << element;
    EXPECT_NEAR(model.mass().sum(), total, roundoff(1e4, total)) << element;
    EXPECT_GT(model.lumped_mass().minCoeff(), 0.0) << element;
  }
}

TEST(FeModel, RotationCostsNothingAtFiniteStrain) {
  for (const std::string& element : solid_elements()) {
    for (Formulation formulation : {Formulation::full, Formulation::mean_dilatation}) {
      Mesh mesh = unit_mesh(element, 2);
      distort(mesh, 0.05);
      FeModel model(std::move(mesh), std::make_unique<NeoHookean>(test_moduli, 1.0),
                    {Plane::strain, formulation, 1.0});
      const std::size_t dim = index(model.mesh().dim);
      std::vector<double> q(index(model.dofs()), 0.0);
      const double cosine = std::cos(1.0), sine = std::sin(1.0);
      for (std::size_t n = 0; n < q.size(); n += dim) {
        const double x = model.mesh().points[n], y = model.mesh().points[n + 1];
        q[n] = cosine * x - sine * y - x;
        q[n + 1] = sine * x + cosine * y - y;
      }
      ModelResponse response;
      ASSERT_TRUE(model.evaluate(q, {}, Model::Want::force, response));
      EXPECT_LT(response.force.cwiseAbs().maxCoeff(), roundoff(1000.0, 1.0)) << element;
      EXPECT_LT(response.stored, roundoff(1000.0, 1.0)) << element;
    }
  }
}

TEST(FeModel, RefusesOneVolumeChangePerCellWhereVolumeIsFree) {
  for (const std::string element : {"quad4", "bar2"}) {
    const FeOptions options{Plane::stress, Formulation::mean_dilatation};
    EXPECT_THROW(FeModel(unit_mesh(element, 1), law_named("neo_hookean"), options), InputError)
        << element;
  }
}

/// Mean of P F^T / J over the points.
Matrix3 mean_stress(FeModel& model, const std::vector<double>& q,
                    const std::vector<double>& history) {
  Matrix3 sum = Matrix3::Zero();
  int points = 0;
  EXPECT_TRUE(model.visit(q, history, [&](const FeModel::PointState& point) {
    sum += point.stress * point.deformation.transpose() / point.deformation.determinant();
    ++points;
  }));
  return sum / points;
}

TEST(FeModel, TellsTheStressOfThePresentAreaWhereCellsThin) {
  // Hencky's law under uniaxial stress: tau = E ln s, J = s^(1 - 2 nu), sigma = tau / J.
  const double s = 1.3, e = test_moduli.youngs(), nu = test_moduli.poissons_ratio();
  const double exact = e * std::log(s) / std::pow(s, 1.0 - 2.0 * nu);
  for (const std::string element : {"quad4", "bar2"}) {
    FeModel model(unit_mesh(element, 1), std::make_unique<Hencky>(test_moduli, 1.0),
                  {Plane::stress, Formulation::full});
    const std::size_t dim = index(model.mesh().dim);
    std::vector<double> q = model.mesh().points;
    for (std::size_t k = 0; k < q.size(); ++k)
      q[k] *= k % dim == 0 ? s - 1.0 : std::pow(s, -nu) - 1.0;
    ModelResponse response;
    const std::vector<double> start(model.history_size(), 0.0);
    ASSERT_TRUE(model.evaluate(q, start, Model::Want::force, response));
    // What the search across the thickness leaves: 1e-13 of the strain, times moduli of order 1.
    EXPECT_NEAR(mean_stress(model, q, response.history)(0, 0), exact, 1.0e-12) << element;
  }
}

}  // namespace
}  // namespace abut::fe_model_tests
