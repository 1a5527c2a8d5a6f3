// Goal: direct and iterative solvers of symmetric systems, definite, indefinite and singular; the
// same bits for every width of registers.
// Oracle: the equation itself.
#include "subdomain_solver/solve/linear_solver.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/solve/branches.hpp"
#include "subdomain_solver/solve/front_elimination.hpp"
#include "subdomain_solver/solve/front_substitution.hpp"
#include "subdomain_solver/solve/multifrontal_solver.hpp"
#include "subdomain_solver/time/problem.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solve_linear_tests {
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

/// The direct solver, which small matrices have of Eigen, and that of large ones.
class DirectSolver : public testing::TestWithParam<bool> {
 protected:
  static std::unique_ptr<LinearSolver> make(Pivots pivots = Pivots::with_digits) {
    return GetParam() ? make_multifrontal_solver(pivots) : make_direct_solver(pivots);
  }
};
INSTANTIATE_TEST_SUITE_P(Solve, DirectSolver, testing::Bool(), [](const auto& param) {
  return param.param ? std::string("ByFronts") : std::string("BySize");
});

TEST_P(DirectSolver, SolvesDefiniteAndIndefiniteSystemsOfOnePatternInTurn) {
  const std::unique_ptr<LinearSolver> solver = make();
  // Backward stable: round-off of a residual whose terms are 4 |x|; |x| is up to 500 |b| here.
  expect_solution(*solver, chain(50, 0.0), roundoff(1.0e4, 1.0));
  expect_solution(*solver, chain(50, 1.3), roundoff(1.0e4, 1.0));
  expect_solution(*solver, chain(50, 0.0), roundoff(1.0e4, 1.0));
}

TEST_P(DirectSolver, SaysThatASystemIsSingular) {
  SparseMatrix k = chain(4, 0.0);
  for (int i : {0, 3}) k.coeffRef(i, i) = 1.0;  // both ends free
  const std::unique_ptr<LinearSolver> solver = make();
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

TEST_P(DirectSolver, SaysThatAFreeBodyIsSingularHoweverItRounds) {
  for (const std::string element : {"tet4", "tet10", "hex8", "hex20"}) {
    for (const std::array<int, 3> cells : {std::array{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {40, 1, 1}}) {
      const std::unique_ptr<LinearSolver> solver = make();
      EXPECT_FALSE(solver->factor(free_stiffness(element, cells)))
          << element << " " << cells[0] << " " << cells[1];
    }
  }
}

TEST_P(DirectSolver, SolvesSlenderBodiesHeldAtOneEnd) {
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
  expect_solution(*make(), k, roundoff(1.0e10, 1.0));
}

TEST_P(DirectSolver, SaysThatAMatrixIsNotANumber) {
  SparseMatrix k = chain(4, 0.0);
  k.coeffRef(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const std::unique_ptr<LinearSolver> solver = make();
  Vector x;
  EXPECT_FALSE(solver->factor(k) && solver->solve(Vector::Ones(4), x));
}

TEST_P(DirectSolver, TakesDefiniteMatricesAloneWhereThatIsAsked) {
  const std::unique_ptr<LinearSolver> solver = make(Pivots::definite);
  EXPECT_TRUE(solver->factor(chain(50, 0.0)));
  EXPECT_FALSE(solver->factor(chain(50, 0.1)));  // above the lowest eigenvalues, 0.004 to 0.09
  EXPECT_TRUE(solver->factor(chain(50, 0.0)));
}

TEST_P(DirectSolver, SolvesSystemsThatFallApart) {
  SparseMatrix two(75, 75);  // two chains, and points that nothing joins
  for (const auto& [first, count] : {std::pair{0, 30}, {30, 40}}) {
    const SparseMatrix k = chain(count, 0.3);
    for (int j = 0; j < count; ++j)
      for (SparseMatrix::InnerIterator at(k, j); at; ++at)
        two.insert(first + static_cast<int>(at.row()), first + j) = at.value();
  }
  for (int j = 70; j < 75; ++j) two.insert(j, j) = 1.0 + j;
  two.makeCompressed();
  // |x| is below 100 |b|, as the eigenvalues are 0.01 and more from zero.
  expect_solution(*make(), two, roundoff(1.0e3, 1.0));
  SparseMatrix points = two.block(70, 70, 5, 5);
  points.makeCompressed();
  expect_solution(*make(), points, roundoff(10.0, 1.0));  // a division each
}

/// A square (edge, edge) of points, each joined to its eight neighbours, with numbers of all signs.
SparseMatrix grid_of_numbers(int edge) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto number = [](int i, int j) { return std::sin(1.0 + 7.0 * (i + j) + 0.1 * (i * j)); };
  for (int i = 0; i < edge * edge; ++i)
    for (int j = 0; j < edge * edge; ++j)
      if (std::abs(i / edge - j / edge) <= 1 && std::abs(i % edge - j % edge) <= 1)
        entries.emplace_back(i, j, number(i, j) + (i == j ? (i % 3 == 0 ? -19.0 : 19.0) : 0.0));
  SparseMatrix out(edge * edge, edge * edge);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

TEST(Fronts, SolveLargeIndefiniteSystemsToTheSameBitsEveryTime) {
  const SparseMatrix k = grid_of_numbers(60);
  const Vector b = Vector::LinSpaced(k.rows(), -1.0, 2.0);
  Vector first, again;
  const std::unique_ptr<LinearSolver> one = make_multifrontal_solver(Pivots::with_digits);
  ASSERT_TRUE(one->factor(k) && one->solve(b, first));
  // Backward stable but for growth: rows dominate, so that pivots stay above 10 and
  // |x| is below |b| / 10; sums of nine terms.
  EXPECT_LT((k * first - b).norm(), roundoff(100.0, 1.0) * b.norm());
  ASSERT_TRUE(one->factor(grid_of_numbers(60)) && one->solve(b, again));
  EXPECT_EQ(first, again);
  const std::unique_ptr<LinearSolver> other = make_multifrontal_solver(Pivots::every);
  ASSERT_TRUE(other->factor(k) && other->solve(b, again));
  EXPECT_EQ(first, again);
}

/// Some of the columns meet but a part of the fronts going down: those that have nothing there.
TEST(Fronts, SolveManyRightSidesToTheBitsOfEach) {
  const SparseMatrix k = grid_of_numbers(60);
  const std::unique_ptr<LinearSolver> solver = make_multifrontal_solver(Pivots::with_digits);
  ASSERT_TRUE(solver->factor(k));
  Eigen::MatrixXd columns(k.rows(), 19), answers;  // more than two passes of 8
  for (Eigen::Index c = 0; c < columns.cols(); ++c)
    columns.col(c) = c % 3 == 0 ? Vector(Vector::LinSpaced(k.rows(), -1.0, 3.0))
                                : Vector(Vector::Unit(k.rows(), 100 * c + c));
  ASSERT_TRUE(solver->solve_columns(columns, answers));
  Vector one;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    ASSERT_TRUE(solver->solve(columns.col(c), one));
    EXPECT_EQ(one, answers.col(c)) << c;
    EXPECT_LT((k * one - columns.col(c)).norm(), roundoff(100.0, 1.0) * columns.col(c).norm());
  }
}

/// A front whose columns dominate, with edges that no tile of any width fits.
struct TestFront {
  static constexpr std::ptrdiff_t rows = 421, columns = 303, rest = rows - columns;
  std::vector<double> block, left, space;
  explicit TestFront(std::size_t workers = 1)
      : block(rows * columns), left(rest * rest), space(elimination_space(rows, columns, workers)) {
    for (std::size_t k = 0; k < block.size(); ++k)
      block[k] = std::sin(0.7 * static_cast<double>(k));
    for (std::ptrdiff_t j = 0; j < columns; ++j)
      block[index(j * (rows + 1))] = j % 2 == 0 ? 500.0 : -500.0;
    for (std::size_t k = 0; k < left.size(); ++k) left[k] = std::cos(0.3 * static_cast<double>(k));
  }
  bool eliminate_by(Eliminate& by, const Team& team = {}) {
    return by({block.data(), rows, columns, rows}, {left.data(), rest, rest, rest}, space.data(),
              team);
  }
};

/// What a front becomes is the same.
void expect_same(const TestFront& one, const TestFront& other) {
  using Front = TestFront;
  for (std::ptrdiff_t j = 0; j < Front::columns; ++j)
    for (std::ptrdiff_t i = j; i < Front::rows; ++i)
      ASSERT_EQ(one.block[index(i + j * Front::rows)], other.block[index(i + j * Front::rows)]);
  for (std::ptrdiff_t j = 0; j < Front::rest; ++j)
    for (std::ptrdiff_t i = j; i < Front::rest; ++i)
      ASSERT_EQ(one.left[index(i + j * Front::rest)], other.left[index(i + j * Front::rest)]);
}

TEST(Fronts, HaveTheSameBitsForEveryWidthOfRegisters) {
  TestFront generic, here;
  ASSERT_TRUE(generic.eliminate_by(eliminate_generic));
  ASSERT_TRUE(here.eliminate_by(eliminate_here()));
  expect_same(generic, here);
}

/// Of a solid whose separators are fronts of some hundred columns, which threads share, above
/// branches of which each has its own.
TEST(Fronts, HaveTheSameBitsForEveryNumberOfThreads) {
  SparseMatrix k = free_stiffness("hex8", {15, 15, 15});
  k.diagonal().array() += 0.01;
  const Fronts fronts = find_fronts(k);
  ASSERT_GT(find_branches(fronts).list.size(), 6U);
  const Vector b = Vector::LinSpaced(k.rows(), -1.0, 2.0);
  Eigen::MatrixXd sides(k.rows(), 11), alone_of_sides, shared_of_sides;
  for (int c = 0; c < 11; ++c) sides.col(c) = b.array().pow(c);
  Vector alone, shared;
  const auto solver = make_multifrontal_solver(Pivots::definite);
  ASSERT_TRUE(solver->factor(k) && solver->solve(b, alone));
  ASSERT_TRUE(solver->solve_columns(sides, alone_of_sides));
  for (const int count : {2, 3}) {
    WorkerThreads threads(count);
    const auto other = make_multifrontal_solver(Pivots::definite, &threads);
    ASSERT_TRUE(other->factor(k) && other->solve(b, shared));
    EXPECT_EQ(alone, shared) << count;
    ASSERT_TRUE(other->factor(k) && other->solve_columns(sides, shared_of_sides));
    EXPECT_EQ(alone_of_sides, shared_of_sides) << count;
    EXPECT_EQ(shared_of_sides.col(1), shared) << count;
  }
  // Of forces of order 1, answers up to 100 by the softest mode of 0.01.
  EXPECT_LT((k * alone - b).lpNorm<Eigen::Infinity>(), roundoff(1.0e4, 1.0));
}

/// Every front is in one branch or above them all, and what a branch leaves is above.
TEST(Branches, DivideTheFronts) {
  const Fronts fronts = find_fronts(free_stiffness("hex8", {15, 15, 15}));
  const Branches branches = find_branches(fronts);
  std::vector<int> seen(fronts.list.size(), 0);
  for (const Front* front : branches.others) ++seen[index(front - fronts.list.data())];
  int columns = 0;
  for (const Branch& branch : branches.list) {
    std::size_t values = 0;
    for (std::size_t f = branch.first; f < branch.end; ++f) {
      const Front& front = fronts.list[f];
      ++seen[f];
      columns += front.columns;
      values += index(front.rows) * index(front.columns);
      for (int k = 0; k < front.rows; ++k) {
        const int at = branches.rows[front.list + index(k)],
                  row = fronts.rows[front.list + index(k)];
        ASSERT_LT(at, branch.size());
        const Front& root = fronts.list[branch.end - 1];
        const int left = at - branch.columns + root.columns;
        EXPECT_EQ(row, at < branch.columns ? branch.first_column + at
                                           : fronts.rows[root.list + index(left)]);
      }
    }
    EXPECT_LE(values, fronts.values / 8);
  }
  for (const Front* front : branches.others) columns += front->columns;
  EXPECT_EQ(columns, static_cast<int>(fronts.order.size()));
  EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }));
}

/// Widths differ in how many rows they pack, and all must be content with the same room.
TEST(Fronts, StayWithinTheSpaceThatIsTheirs) {
  constexpr double untouched = 0.123;
  for (Eliminate* by : {&eliminate_generic, &eliminate_here()}) {
    TestFront front;
    const std::size_t own = front.space.size();
    front.space.resize(own + 65'536, untouched);
    ASSERT_TRUE(front.eliminate_by(*by));
    for (std::size_t k = own; k < front.space.size(); ++k)
      ASSERT_EQ(front.space[k], untouched) << k - own;
  }
}

TEST(Fronts, SubstituteToTheSameBitsForEveryWidthOfRegisters) {
  TestFront front;
  ASSERT_TRUE(front.eliminate_by(eliminate_here()));
  const DenseView block{front.block.data(), TestFront::rows, TestFront::columns, TestFront::rows};
  std::vector<double> generic(3 * TestFront::rows), here;
  for (std::size_t i = 0; i < generic.size(); ++i)
    generic[i] = std::sin(0.9 * static_cast<double>(i));
  here = generic;
  const DenseView one{generic.data(), TestFront::rows, 3, TestFront::rows};
  const DenseView other{here.data(), TestFront::rows, 3, TestFront::rows};
  substitute_generic.forward(block, one);
  substitution_here().forward(block, other);
  EXPECT_EQ(generic, here);
  substitute_generic.backward(block, one);
  substitution_here().backward(block, other);
  EXPECT_EQ(generic, here);
}

TEST(Fronts, LeaveWhatEliminationLeaves) {
  TestFront front;
  const auto entry = [&front](std::ptrdiff_t i, std::ptrdiff_t j) {
    return front.block[index(i + j * TestFront::rows)];
  };
  const std::vector<double> before = front.block, rest = front.left;
  ASSERT_TRUE(front.eliminate_by(eliminate_here()));
  // L D L^T is the matrix again: sums of up to 303 products that add up to 500.
  for (const auto& [i, j] : {std::pair{0, 0}, {302, 302}, {420, 302}, {257, 256}, {420, 0}}) {
    double sum = 0.0;
    for (std::ptrdiff_t k = 0; k <= j; ++k)
      sum += (k == i ? 1.0 : entry(i, k)) * entry(k, k) * (k == j ? 1.0 : entry(j, k));
    EXPECT_NEAR(sum, before[index(i + j * TestFront::rows)], roundoff(500.0, 303.0));
  }
  double left = rest[index(TestFront::rest - 1)];  // last row, first column
  for (std::ptrdiff_t k = 0; k < TestFront::columns; ++k)
    left -= entry(420, k) * entry(k, k) * entry(303, k);
  EXPECT_NEAR(front.left[index(TestFront::rest - 1)], left, roundoff(500.0, 303.0));
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

// As of a modal basis whose ports move as rigid motions alone. What a matrix without columns has no
// memory for is read by nobody (preset asan).
TEST(LinearSolvers, AnswerNoRightHandSidesWithNone) {
  for (const bool direct : {true, false}) {
    const std::unique_ptr<LinearSolver> solver =
        direct ? make_direct_solver() : make_conjugate_gradients(1.0e-10);
    Eigen::MatrixXd x = Eigen::MatrixXd::Ones(1, 1);
    ASSERT_TRUE(solver->factor(chain(50, 0.0)) && solver->solve_columns(Eigen::MatrixXd(50, 0), x));
    EXPECT_EQ(x.rows(), 50);
    EXPECT_EQ(x.cols(), 0);
  }
}

}  // namespace
}  // namespace abut::solve_linear_tests
