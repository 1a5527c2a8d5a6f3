// Goal: conjugate gradients with multigrid solve what no factors can, in iterations that do not
// grow with the body.
// Oracles: the equation itself, the direct solver, and what a preconditioner must be: symmetric,
// positive definite.
#include "subdomain_solver/solve/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/make/linear_choice.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut::solve_multigrid_tests {
namespace {

/// Stiffness, with a share of the lumped mass, of a body one side of which is held.
struct System {
  std::unique_ptr<FeModel> model;
  std::vector<int> held;
  SparseMatrix matrix;
  Vector b;

  CoarseMotions motions() const { return coarse_motions(*model, held); }
};

System system_of(Mesh mesh, FeOptions options, const char* side, double mass = 0.0,
                 Moduli moduli = {1.25, 0.5}) {
  System out;
  out.model = std::make_unique<FeModel>(std::move(mesh),
                                        std::make_unique<LinearElastic>(moduli, 1.0), options);
  FeModel& model = *out.model;
  ModelResponse response;
  const std::vector<double> rest(static_cast<std::size_t>(model.dofs()), 0.0);
  EXPECT_TRUE(model.evaluate(rest, {}, Model::Want::tangent, response));
  SparseMatrix whole = response.tangent;
  if (mass > 0.0) whole += mass * mass_matrix(model, MassForm::lumped);
  std::vector<Prescribed> supports;
  if (side != nullptr)
    for (const std::int32_t node : model.mesh().nodes_of(side))
      for (int i = 0; i < model.mesh().dim; ++i)
        supports.push_back({model.mesh().dim * node + i, [](double) { return 0.0; }});
  std::ranges::sort(supports, {}, &Prescribed::dof);
  for (const Prescribed& p : supports) out.held.push_back(p.dof);
  FreeCoordinates(model.dofs(), supports).extract(whole, out.matrix);
  out.b.resize(out.matrix.rows());
  for (Eigen::Index i = 0; i < out.b.size(); ++i)
    out.b(i) = std::sin(0.3 * static_cast<double>(i) + 1.0);
  return out;
}

Mesh box(std::array<int, 3> cells, std::array<double, 3> lengths) {
  BoxMesh out;
  out.elements = cells;
  out.lengths = lengths;
  return generate(out, "test");
}

Mesh cube(int edge) { return box({edge, edge, edge}, {1.0, 1.0, 1.0}); }

Mesh sheet(int edge) {
  RectangleMesh out;
  out.elements = {edge, edge};
  out.lengths = {1.0, 1.0};
  return generate(out, "test");
}

/// Of conjugate gradients with a cycle, until the residual is 1e-8 of b.
int iterations(const System& system) {
  Multigrid cycle(system.motions());
  EXPECT_TRUE(cycle.factor(system.matrix));
  Vector x = Vector::Zero(system.b.size()), r = system.b, z, p;
  double before = 0.0;
  for (int k = 0; k < 500; ++k) {
    if (r.norm() <= 1.0e-8 * system.b.norm()) return k;
    cycle.apply(r, z);
    const double now = r.dot(z);
    p = k == 0 ? z : Vector(z + (now / before) * p);
    before = now;
    const Vector q = system.matrix * p;
    x += (now / p.dot(q)) * p;
    r -= (now / p.dot(q)) * q;
  }
  return 500;
}

/// Against the direct solver.
void expect_the_direct_answer(const System& system) {
  const auto iterated = make_conjugate_gradients(1.0e-12, system.motions());
  const auto direct = make_direct_solver(Pivots::every);
  Vector x, y;
  ASSERT_TRUE(iterated->factor(system.matrix) && iterated->solve(system.b, x));
  ASSERT_TRUE(direct->factor(system.matrix) && direct->solve(system.b, y));
  // Residuals of 1e-12 leave errors of the condition of the matrix, up to 1e5 here, times as much.
  EXPECT_LT((x - y).norm(), 1.0e-7 * y.norm());
}

TEST(Multigrid, TakesAsManyIterationsForLargeBodiesAsForSmallOnes) {
  const int small = iterations(system_of(cube(10), {}, "left"));
  const int large = iterations(system_of(cube(24), {}, "left"));
  EXPECT_LE(small, 25);
  EXPECT_LE(large, small + 6);  // by incomplete factors they grow with the cells along an edge
}

TEST(Multigrid, HasAFewTimesTheUnknownsOfTheBody) {
  const System system = system_of(cube(24), {}, "left");
  Multigrid cycle(system.motions());
  ASSERT_TRUE(cycle.factor(system.matrix));
  const std::vector<Eigen::Index> sizes = cycle.sizes();
  ASSERT_GE(sizes.size(), 2u);
  for (std::size_t k = 1; k < sizes.size(); ++k) EXPECT_LT(4 * sizes[k], sizes[k - 1]);
}

TEST(Multigrid, IsSymmetricAndDefinite) {
  const System system = system_of(cube(9), {}, "left");
  Multigrid cycle(system.motions());
  ASSERT_TRUE(cycle.factor(system.matrix));
  const Vector a = system.b;
  const Vector b = a.reverse().cwiseAbs2();
  Vector of_a, of_b;
  cycle.apply(a, of_a);
  cycle.apply(b, of_b);
  // Of sums of some thousand products, each rounded by 1e-16: 1e-13, and as much again of cycles.
  EXPECT_NEAR(of_a.dot(b), of_b.dot(a), 1.0e-12 * std::sqrt(of_a.dot(a) * of_b.dot(b)));
  EXPECT_GT(of_a.dot(a), 0.0);
}

TEST(Multigrid, SolvesBodiesOfAllPlanesAndShapes) {
  expect_the_direct_answer(system_of(cube(9), {}, "left"));
  expect_the_direct_answer(system_of(cube(9), {}, nullptr, 1.0e-2));  // free, in a long step
  expect_the_direct_answer(system_of(box({60, 3, 3}, {20.0, 1.0, 1.0}), {}, "left"));
  expect_the_direct_answer(system_of(box({24, 24, 1}, {1.0, 1.0, 0.05}), {}, "left"));
  for (const Plane plane : {Plane::strain, Plane::stress, Plane::axisymmetric})
    expect_the_direct_answer(system_of(sheet(40), {plane, Formulation::full}, "bottom"));
}

TEST(Multigrid, SolvesNearlyIncompressibleBodies) {
  expect_the_direct_answer(system_of(cube(9), {Plane::strain, Formulation::mean_dilatation}, "left",
                                     0.0, Moduli{50.0, 0.5}));
}

TEST(Multigrid, RefusesWhatIsNotDefinite) {
  System system = system_of(cube(9), {}, "left");
  system.matrix.coeffRef(7, 7) = -1.0;
  const auto solver = make_conjugate_gradients(1.0e-10, system.motions());
  Vector x;
  EXPECT_FALSE(solver->factor(system.matrix) && solver->solve(system.b, x));
}

TEST(LinearChoice, IteratesWhereFactorsWouldFillTheMemory) {
  const EquationsSpec automatic;
  const System small = system_of(sheet(3), {}, "left");
  EXPECT_EQ(linear_choice(automatic, *small.model, small.held, {}).words, "");
  FeModel large(cube(47), std::make_unique<LinearElastic>(Moduli{1.25, 0.5}, 1.0), {});
  EXPECT_EQ(linear_choice(automatic, large, {}, {}).words, ", by conjugate gradients");
  SolidInterior::PortNodes port;
  port.touched = true;
  EXPECT_EQ(linear_choice(automatic, large, {}, {port}).words, "");
  EquationsSpec direct;
  direct.linear = DirectSpec();
  EXPECT_EQ(linear_choice(direct, large, {}, {}).words, "");
}

}  // namespace
}  // namespace abut::solve_multigrid_tests
