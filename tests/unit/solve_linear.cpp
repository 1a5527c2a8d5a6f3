// Goal: direct and iterative solvers of symmetric systems, definite, indefinite and singular.
// Oracle: the equation itself.
#include "subdomain_solver/solve/linear_solver.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/time/problem.hpp"
#include "tests/support/tolerance.hpp"

namespace abut {
namespace {

/// Second differences of n points, clamped at both ends, with `shift` taken from the diagonal. The
/// eigenvalues are 2 - 2 cos(k pi/(n+1)) - shift.
SparseMatrix chain(int n, double shift) {
  SparseMatrix k(n, n);
  for (int i = 0; i < n; ++i) {
    k.insert(i, i) = 2.0 - shift;
    if (i > 0) k.insert(i - 1, i) = -1.0;
    if (i + 1 < n) k.insert(i + 1, i) = -1.0;
  }
  k.makeCompressed();
  return k;
}

void expect_solution(LinearSolver& solver, const SparseMatrix& k, double tolerance) {
  const Vector b = Vector::LinSpaced(k.rows(), -1.0, 2.0);
  Vector x;
  ASSERT_TRUE(solver.factor(k));
  ASSERT_TRUE(solver.solve(b, x));
  EXPECT_LT((k * x - b).norm(), tolerance * b.norm());
}

TEST(DirectSolver, SolvesDefiniteAndIndefiniteSystemsOfOnePatternInTurn) {
  const std::unique_ptr<LinearSolver> solver = make_direct_solver();
  // Backward stable: round-off of a residual whose terms are 4 |x|; |x| is up to 500 |b| here.
  expect_solution(*solver, chain(50, 0.0), roundoff(1.0e4, 1.0));
  expect_solution(*solver, chain(50, 1.3), roundoff(1.0e4, 1.0));
  expect_solution(*solver, chain(50, 0.0), roundoff(1.0e4, 1.0));
}

TEST(DirectSolver, SaysThatASystemIsSingular) {
  SparseMatrix k = chain(4, 0.0);
  for (int i : {0, 3}) k.coeffRef(i, i) = 1.0;  // both ends free
  const std::unique_ptr<LinearSolver> solver = make_direct_solver();
  Vector x;
  EXPECT_FALSE(solver->factor(k) && solver->solve(Vector::Ones(4), x));
}

/// Stiffness of a body of cubes in a row (n, 1, 1) or of a cube of n^3, with nothing held.
SparseMatrix free_stiffness(const std::string& element, const std::array<int, 3>& cells) {
  BoxMesh box;
  for (std::size_t i = 0; i < 3; ++i) box.lengths[i] = cells[i];
  box.elements = cells;
  box.element = element;
  FeModel model(generate(box, "test"), std::make_unique<LinearElastic>(Moduli{1.25, 0.5}, 1.0), {});
  ModelResponse at_rest;
  const std::vector<double> rest(index(model.dofs()), 0.0);
  EXPECT_TRUE(model.evaluate(rest, {}, Model::Want::tangent, at_rest));
  return at_rest.tangent;
}

TEST(DirectSolver, SaysThatAFreeBodyIsSingularHoweverItRounds) {
  for (const std::string element : {"tet4", "tet10", "hex8", "hex20"}) {
    for (const std::array<int, 3> cells : {std::array{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {40, 1, 1}}) {
      const std::unique_ptr<LinearSolver> solver = make_direct_solver();
      EXPECT_FALSE(solver->factor(free_stiffness(element, cells)))
          << element << " " << cells[0] << " " << cells[1];
    }
  }
}

TEST(DirectSolver, SolvesSlenderBodiesHeldAtOneEnd) {
  // Five hundred cubes in a row: a stiffness of 0.25/500^3 of a cell's at the tip.
  const SparseMatrix all = free_stiffness("hex8", {500, 1, 1});
  std::vector<Prescribed> held;
  for (int node = 0; node < all.rows() / 3; node += 501) {  // the first of each row of nodes
    for (int i = 0; i < 3; ++i) held.push_back({3 * node + i, {}});
  }
  FreeCoordinates free(static_cast<int>(all.rows()), held);
  SparseMatrix k;
  free.extract(all, k);
  // Backward stable: round-off of a residual whose terms are k |x|, |x| up to 4 . 500^3 here.
  expect_solution(*make_direct_solver(), k, roundoff(1.0e10, 1.0));
}

TEST(DirectSolver, SaysThatAMatrixIsNotANumber) {
  SparseMatrix k = chain(4, 0.0);
  k.coeffRef(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const std::unique_ptr<LinearSolver> solver = make_direct_solver();
  Vector x;
  EXPECT_FALSE(solver->factor(k) && solver->solve(Vector::Ones(4), x));
}

TEST(LinearSolvers, SolveManyRightHandSidesAtOnce) {
  const SparseMatrix k = chain(50, 0.0);
  Eigen::MatrixXd b(50, 3);
  b << Vector::Ones(50), Vector::LinSpaced(50, -1.0, 2.0), Vector::Unit(50, 7);
  for (const bool direct : {true, false}) {
    const std::unique_ptr<LinearSolver> solver =
        direct ? make_direct_solver() : make_conjugate_gradients(1.0e-13);
    Eigen::MatrixXd x;
    ASSERT_TRUE(solver->factor(k) && solver->solve_columns(b, x));
    EXPECT_LT((k * x - b).norm(), 1.0e-12 * b.norm());  // round-off as above; the iteration's 1e-13
  }
}

TEST(ConjugateGradients, SolveToTheirTolerance) {
  const std::unique_ptr<LinearSolver> solver = make_conjugate_gradients(1.0e-10);
  expect_solution(*solver, chain(200, 0.0), 1.0e-9);  // recurred and true residual drift apart
}

TEST(LinearSolvers, AnswerNoEquationsWithNothing) {  // a body all of whose coordinates are given
  for (const bool direct : {true, false}) {
    const std::unique_ptr<LinearSolver> solver =
        direct ? make_direct_solver() : make_conjugate_gradients(1.0e-10);
    Vector x = Vector::Ones(1);
    ASSERT_TRUE(solver->factor(SparseMatrix(0, 0)));
    ASSERT_TRUE(solver->solve(Vector(), x));
    EXPECT_EQ(x.size(), 0);
  }
}

}  // namespace
}  // namespace abut
