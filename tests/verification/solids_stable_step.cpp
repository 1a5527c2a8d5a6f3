// Goal: the stable step is a bound on central differences that holds for every element, however
// slender, and that is no smaller than needed on a cube. Oracles: the model equation of central
// differences, whose amplitudes stay bounded below the limit and grow above it; eigenvalues.
#include <cmath>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_stable_step_tests {
namespace {

/// A unit mesh of `n` cells along each edge, stretched along x.
Mesh slender_mesh(const std::string& element, int n, double aspect) {
  Mesh mesh = unit_mesh(element, n);
  distort(mesh, 0.03);
  for (std::size_t i = 0; i < mesh.points.size(); i += index(mesh.dim)) mesh.points[i] *= aspect;
  return mesh;
}

/// Largest energy over the first one within some steps, from velocities in all modes.
double growth(FeModel& model, double dt, int steps) {
  Problem problem;
  problem.model = &model;
  ExplicitDynamics run(problem);
  Motion motion;
  motion.q.assign(index(model.dofs()), 0.0);
  motion.v = motion.q;
  DrawTensors draw;
  for (double& v : motion.v) v = draw.between(-1.0, 1.0);
  EXPECT_FALSE(run.begin(motion, 0.0));
  const double first = run.kinetic(motion);
  double most = first;
  for (int k = 0; k < steps && most < 1.0e6 * first; ++k) {
    EXPECT_FALSE(run.step(motion, k * dt, dt));
    if (k % 16 < 2) most = std::max(most, run.kinetic(motion) + motion.stored);
  }
  return most / first;
}

struct Case {
  std::string element;
  Formulation formulation;
  double aspect;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.element << " " << static_cast<int>(c.formulation) << " " << c.aspect;
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const std::string& element : solid_elements())
    for (Formulation formulation :
         {Formulation::full, Formulation::mean_dilatation, Formulation::one_point}) {
      if (formulation == Formulation::one_point && element_named(element).order > 1) continue;
      for (const double aspect : {1.0, 30.0, 1000.0}) out.push_back({element, formulation, aspect});
    }
  return out;
}

class StableStepOf : public testing::TestWithParam<Case> {};

/// In ten thousand steps a mode that is above the limit by 1e-6 of it grows a million times: one
/// that does not is below by all that the factor leaves.
TEST_P(StableStepOf, BoundsTenThousandSteps) {
  const Case& c = GetParam();
  FeModel model(slender_mesh(c.element, 2, c.aspect),
                std::make_unique<LinearElastic>(isotropic(1.0, 0.3), 1.0),
                {Plane::strain, c.formulation});
  // At omega dt/2 = 0.99 the conserved form of the energy holds 1 - 0.99^2 = 1/50 of the highest
  // mode's: no mode can show more than 50 times what it began with.
  EXPECT_LT(growth(model, 0.99 * stable_step(model), 10'000), 51.0);
}

INSTANTIATE_TEST_SUITE_P(Elements, StableStepOf, testing::ValuesIn(cases()));

TEST(StableStep, IsNoSmallerThanACubeNeeds) {
  for (const Formulation formulation :
       {Formulation::full, Formulation::mean_dilatation, Formulation::one_point}) {
    FeModel model(unit_mesh("hex8", 1), std::make_unique<LinearElastic>(isotropic(1.0, 0.3), 1.0),
                  {Plane::strain, formulation});
    EXPECT_LT(growth(model, 0.99 * stable_step(model), 1000), 51.0);
    // At 1.01 an amplitude grows by (1.01 + sqrt(1.01^2 - 1))^2 = 1.33 a step.
    EXPECT_GT(growth(model, 1.01 * stable_step(model), 1000), 1.0e6);
  }
}

TEST(StableStep, OfEqualCellsIsThatOfOne) {
  FeModel one(unit_mesh("hex8", 1), std::make_unique<NeoHookean>(test_moduli, 1.0), {});
  Mesh mesh = unit_mesh("hex8", 5);
  for (double& x : mesh.points) x *= 5.0;
  FeModel many(std::move(mesh), std::make_unique<NeoHookean>(test_moduli, 1.0), {});
  EXPECT_NEAR(stable_step(many), stable_step(one), roundoff(100.0, stable_step(one)));
}

TEST(StableStep, BoundsTheFrequenciesOfADeformedBody) {
  for (const Formulation formulation : {Formulation::full, Formulation::one_point}) {
    FeModel model(slender_mesh("hex8", 2, 3.0), std::make_unique<NeoHookean>(test_moduli, 1.0),
                  {Plane::strain, formulation});
    DrawTensors draw;
    std::vector<double> q(index(model.dofs()));
    for (double& x : q) x = draw.between(-0.08, 0.08);
    ModelResponse response;
    ASSERT_TRUE(model.evaluate(q, {}, Model::Want::tangent, response));
    const Vector root = model.lumped_mass().cwiseSqrt().cwiseInverse();
    const Vector squares = symmetric_eigenvalues(
        root.asDiagonal() * Eigen::MatrixXd(response.tangent) * root.asDiagonal());
    const double limit = 2.0 / std::sqrt(squares.tail(1)(0));
    const double bound = stable_step(model, q, {});
    EXPECT_LE(bound, limit);
    // Cells differ by random strains of up to 0.3: neighbours help by less than half.
    EXPECT_GT(bound, 0.5 * limit);
    EXPECT_NE(bound, stable_step(model));
  }
}

}  // namespace
}  // namespace abut::solids_stable_step_tests
