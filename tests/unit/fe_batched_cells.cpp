// Goal: batched cells give the forces and energies of the cell-by-cell ones, on every instruction
// set and with any number of threads the same bits; identities of mechanics hold for them alone.
#include "base/dense.hpp"
#include "subdomain_solver/fe/batched_cells.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "tests/support/cell_models.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_batched_cells_tests {
namespace {

std::vector<BatchCase> cases(const std::vector<std::string>& laws) {
  std::vector<BatchCase> out;
  for (const std::string element : {"hex8", "quad4", "tet4", "tri3", "tet10", "hex20"})
    for (const Formulation formulation :
         {Formulation::full, Formulation::one_point, Formulation::mean_dilatation})
      for (const std::string& law : laws) {
        // The volume change of linear laws is another one, which has no batched form.
        if (element_named(element).order > 1 && formulation != Formulation::full) continue;
        const bool several = element == "hex8" || element == "quad4";
        if (several && formulation == Formulation::mean_dilatation && law == "linear_elastic")
          continue;
        out.push_back({element, formulation, law});
      }
  return out;
}
const std::vector<std::string> objective = {"saint_venant_kirchhoff", "neo_hookean",
                                            "mooney_rivlin", "hencky", "j2_plasticity"};
const std::vector<std::string> laws = {"linear_elastic", "saint_venant_kirchhoff",
                                       "neo_hookean",    "mooney_rivlin",
                                       "hencky",         "j2_plasticity"};

/// 9 cells along each edge: several patches in space, batches that are not full.
constexpr int cells = 9;
constexpr double thickness = 0.7;

Mesh distorted_mesh(const BatchCase& c) {
  const bool many = c.element == "quad4";
  Mesh mesh = unit_mesh(c.element, many ? 3 * cells : cells);
  distort(mesh, 0.02 / (many ? 3.0 : 1.0) / mesh.blocks[0].element->order);
  return mesh;
}

FeModel model_of(const BatchCase& c) {
  return FeModel(distorted_mesh(c), law_named(c.law),
                 {Plane::strain, c.formulation, thickness, 0.05});
}

struct Answer {
  bool admissible = false;
  double stored = 0.0, dissipated = 0.0;
  std::vector<double> force, history;
};

Answer batched(const BatchCase& c, const Mesh& mesh, std::span<const double> q,
               const KernelTable* kernels = nullptr, int threads = 1) {
  const std::unique_ptr<const Material> law = law_named(c.law);
  BatchedCells all(mesh, *law, {c.formulation, 0.05, thickness, threads, kernels});
  Answer out;
  out.force.resize(q.size());
  // As many numbers as the most points of a cell could have.
  const std::vector<double> before(index(mesh.cell_count() * 27 * law->history_size()), 0.0);
  out.history = before;
  CellEnergies energies;
  out.admissible = all.evaluate(q, {before, out.history}, out.force, energies);
  out.stored = energies.stored;
  out.dissipated = energies.dissipated;
  return out;
}

std::vector<double> displaced(const Mesh& mesh, double size) {
  DrawTensors draw;
  std::vector<double> q(mesh.points.size());
  size /= mesh.blocks[0].element->order;  // as the nodes are nearer to each other
  for (double& x : q) x = size * draw.between(-1.0, 1.0);
  return q;
}

/// u = H x.
std::vector<double> affine(const Mesh& mesh, const Matrix3& h) {
  const std::size_t dim = index(mesh.dim);
  std::vector<double> q(mesh.points.size());
  for (std::size_t n = 0; n < q.size(); n += dim) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < dim; ++i) x(static_cast<int>(i)) = mesh.points[n + i];
    const Eigen::Vector3d u = h * x;
    for (std::size_t i = 0; i < dim; ++i) q[n + i] = u(static_cast<int>(i));
  }
  return q;
}

class BatchedCellsOf : public testing::TestWithParam<BatchCase> {};

// Sums of a few hundred terms of the size of a force each, in different orders.
constexpr double operations = 1000.0;

TEST_P(BatchedCellsOf, AreTheCellByCellOnes) {
  FeModel model = model_of(GetParam());
  // Strains of about 1e-9 ... 0.3 of an edge, where energies lose digits by cancellation or not.
  for (const double size : {1.0e-10, 1.0e-4, 1.0e-2}) {
    const std::vector<double> q = displaced(model.mesh(), size);
    ModelResponse expected;
    const std::vector<double> before(model.history_size(), 0.0);
    ASSERT_TRUE(model.evaluate(q, before, Model::Want::force, expected));
    for (const KernelTable* kernels : batched_kernels()) {
      const Answer found = batched(GetParam(), model.mesh(), q, kernels);
      ASSERT_TRUE(found.admissible) << kernels->instructions;
      const std::span<const double> wanted(expected.force.data(), found.force.size());
      // The law's stress is exact to rounding of a modulus, not of itself [M.31 to M.33].
      const double scale = std::max(largest_size(wanted), 0.01);
      EXPECT_LT(largest_difference(found.force, wanted), roundoff(operations, scale))
          << kernels->instructions << " " << size;
      // J - 1 and the invariants of strains of 1e-9 keep seven digits of their second order.
      const double digits = 1.0e-12 + 1.0e-16 / size;
      EXPECT_NEAR(found.stored, expected.stored, digits * expected.stored)
          << kernels->instructions << " " << size;
      EXPECT_NEAR(found.dissipated, expected.dissipation,
                  digits * std::max(expected.dissipation, expected.stored));
      // C_p^-1, a number near 1, by two products with F^-1 of cells pressed to half their size.
      const std::span<const double> history(found.history.data(), expected.history.size());
      EXPECT_LT(largest_difference(history, expected.history), roundoff(operations, 1.0));
    }
  }
}

TEST_P(BatchedCellsOf, AreTheSameBitsForAllThreadsAndInstructions) {
  const Mesh mesh = distorted_mesh(GetParam());
  const std::vector<double> q = displaced(mesh, 1.0e-2);
  const Answer first = batched(GetParam(), mesh, q);
  for (const KernelTable* kernels : batched_kernels()) {
    for (const int threads : {1, 3}) {
      const Answer other = batched(GetParam(), mesh, q, kernels, threads);
      EXPECT_EQ(first.force, other.force) << kernels->instructions << " " << threads;
      EXPECT_EQ(first.stored, other.stored) << kernels->instructions << " " << threads;
      EXPECT_EQ(first.dissipated, other.dissipated) << kernels->instructions << " " << threads;
      EXPECT_EQ(first.history, other.history) << kernels->instructions << " " << threads;
    }
  }
}

TEST_P(BatchedCellsOf, PassThePatchTest) {
  Mesh mesh = distorted_mesh(GetParam());
  straighten(mesh);  // the rule of tetrahedra is exact for straight edges alone
  Matrix3 h;
  h << 0.02, 0.03, -0.01, -0.02, 0.01, 0.02, 0.015, -0.01, -0.03;
  if (mesh.dim == 2) h.row(2).setZero(), h.col(2).setZero();
  const Answer found = batched(GetParam(), mesh, affine(mesh, h));
  ASSERT_TRUE(found.admissible);
  const std::size_t dim = index(mesh.dim);
  for (std::size_t i = 0; i < found.force.size(); ++i) {
    const double* x = mesh.points.data() + i / dim * dim;
    const bool inside = std::all_of(x, x + dim, [](double c) { return c > 1e-9 && c < 1 - 1e-9; });
    if (!inside) continue;
    EXPECT_LT(std::abs(found.force[i]), roundoff(operations, 1.0)) << "node " << i / dim;
  }
  const std::unique_ptr<const Material> law = law_named(GetParam().law);
  History none = zero_history(*law);
  const double energy = answer(*law, Matrix3::Identity() + h, none).energy;
  const double volume = mesh.dim == 2 ? thickness : 1.0;
  EXPECT_NEAR(found.stored, energy * volume, roundoff(operations, energy) / h.norm());
}

TEST_P(BatchedCellsOf, BalanceForces) {
  const Mesh mesh = distorted_mesh(GetParam());
  const Answer found = batched(GetParam(), mesh, displaced(mesh, 1.0e-2));
  const std::size_t dim = index(mesh.dim);
  for (std::size_t i = 0; i < dim; ++i) {
    double sum = 0.0;
    for (std::size_t n = i; n < found.force.size(); n += dim) sum += found.force[n];
    EXPECT_LT(std::abs(sum), roundoff(operations, largest_size(found.force)));
  }
}

TEST_P(BatchedCellsOf, RefuseNumbersThatAreNotFinite) {
  const Mesh mesh = distorted_mesh(GetParam());
  std::vector<double> q = displaced(mesh, 1.0e-2);
  q.back() = std::nan("");
  EXPECT_FALSE(batched(GetParam(), mesh, q).admissible);
}

INSTANTIATE_TEST_SUITE_P(All, BatchedCellsOf, testing::ValuesIn(cases(laws)));

class ObjectiveBatchedCells : public testing::TestWithParam<BatchCase> {};

TEST_P(ObjectiveBatchedCells, RotationCostsNothing) {
  const Mesh mesh = distorted_mesh(GetParam());
  const Matrix3 turn = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Answer found = batched(GetParam(), mesh, affine(mesh, turn - Matrix3::Identity()));
  ASSERT_TRUE(found.admissible);
  EXPECT_LT(largest_size(found.force), roundoff(operations, 1.0));
  EXPECT_LT(std::abs(found.stored), roundoff(operations, 1.0));
}

TEST_P(ObjectiveBatchedCells, ForcesHaveNoMoment) {
  const Mesh mesh = distorted_mesh(GetParam());
  const std::vector<double> q = displaced(mesh, 1.0e-2);
  const Answer found = batched(GetParam(), mesh, q);
  const std::size_t dim = index(mesh.dim);
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < q.size(); n += dim) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), f = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < dim; ++i) {
      x(static_cast<int>(i)) = mesh.points[n + i] + q[n + i];
      f(static_cast<int>(i)) = found.force[n + i];
    }
    moment += x.cross(f);
  }
  EXPECT_LT(moment.norm(), roundoff(operations, largest_size(found.force)));
}

TEST_P(ObjectiveBatchedCells, RefuseAnInvertedCell) {
  const Mesh mesh = distorted_mesh(GetParam());
  Matrix3 mirror = Matrix3::Zero();
  mirror(0, 0) = -2.0;
  EXPECT_FALSE(batched(GetParam(), mesh, affine(mesh, mirror)).admissible);
}

INSTANTIATE_TEST_SUITE_P(All, ObjectiveBatchedCells, testing::ValuesIn(cases(objective)));

TEST(Hourglass, EveryFieldButRigidMotionHasEnergy) {
  for (const std::string element : {"hex8", "quad4"}) {
    Mesh mesh = unit_mesh(element, 1);
    DrawTensors draw;
    for (double& x : mesh.points) x += 0.1 * draw.between(-1.0, 1.0);
    const int size = static_cast<int>(mesh.points.size()), rigid = mesh.dim == 3 ? 6 : 3;
    const int hourglasses = mesh.dim == 3 ? 12 : 2;
    for (const double coefficient : {0.0, 0.05}) {
      FeModel model(Mesh(mesh), law_named("linear_elastic"),
                    {Plane::strain, Formulation::one_point, 1.0, coefficient});
      ModelResponse response;
      const std::vector<double> rest(index(size), 0.0);
      ASSERT_TRUE(model.evaluate(rest, {}, Model::Want::tangent, response));
      const Vector squares = symmetric_eigenvalues(response.tangent);
      // Moduli and edges of order 1: stiffnesses of 0.01 and more, or round-off.
      const auto zeros = (squares.array() < 1.0e-10).count();
      EXPECT_EQ(zeros, rigid + (coefficient == 0.0 ? hourglasses : 0)) << element;
      EXPECT_GT(squares(0), -roundoff(operations, 1.0)) << element;
    }
  }
}

}  // namespace
}  // namespace abut::fe_batched_cells_tests
