// Goal: stress at nodes is what the stresses at quadrature points say there, and means count
// volume. Oracles: polynomials that both must hold; integrals of linear fields.
#include "subdomain_solver/nodal_stress.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/solid_measures.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::nodal_stress_tests {
namespace {

/// Linear in every coordinate, with all products on squares and cubes.
double polynomial(const Element& element, std::span<const double> xi) {
  double sum = 0.7, product = 1.0;
  for (std::size_t i = 0; i < xi.size(); ++i) {
    sum += (1.0 + static_cast<double>(i)) * xi[i];
    product *= 0.4 + xi[i];
  }
  return element.corner_count() == element.dim + 1 ? sum : sum + product;
}

TEST(Extrapolation, CarriesPolynomialsOfFirstOrderToEveryNodeFromEveryRule) {
  for (const std::string& name : fe_elements()) {
    const Element& element = element_named(name);
    const std::size_t dim = index(element.dim);
    for (int degree = 0; degree <= 5; ++degree) {
      SCOPED_TRACE(fmt::format("{} with a rule of degree {}", name, degree));
      const Quadrature points = quadrature(element.shape, degree);
      const Eigen::MatrixXd carry =
          extrapolation(element, tabulate(element, points), points.count());
      ASSERT_EQ(carry.rows(), element.nodes);
      ASSERT_EQ(carry.cols(), points.count());
      const bool enough = points.count() >= element.corner_count();
      Vector values(points.count());
      for (int p = 0; p < points.count(); ++p)
        values(p) = polynomial(element, std::span(points.points).subspan(index(p) * dim, dim));
      const Vector at_nodes = carry * values;
      for (int a = 0; a < element.nodes; ++a) {
        const double exact =
            polynomial(element, std::span(element.corners).subspan(index(a) * dim, dim));
        EXPECT_NEAR(at_nodes(a), enough ? exact : values.mean(), roundoff(1.0e3, 10.0)) << a;
      }
    }
  }
}

/// A solid of linear material whose displacement is a quadratic polynomial: its stress is linear in
/// the position.
struct Bent {
  FeModel model;
  std::vector<double> u;

  explicit Bent(Mesh mesh, Plane plane = Plane::strain)
      : model(std::move(mesh), std::make_unique<LinearElastic>(test_moduli, 1.0), {plane}) {
    const Mesh& m = model.mesh();
    for (int node = 0; node < m.node_count(); ++node) {
      const double* x = m.points.data() + node * m.dim;
      const double z = m.dim == 3 ? x[2] : 0.0;
      u.push_back(0.02 * x[0] * x[0] + (plane == Plane::axisymmetric ? 0.0 : 0.01 * x[1] * z));
      u.push_back(0.03 * x[0] * x[1] - 0.01 * z * z);
      if (m.dim == 3) u.push_back(0.02 * z * x[1]);
    }
  }
  /// [Pa] by hand, from the gradient there.
  Matrix3 exact(const double* x) const {
    const bool round = model.round(), solid = model.mesh().dim == 3;
    const double z = solid ? x[2] : 0.0;
    Matrix3 h = Matrix3::Zero();
    h(0, 0) = 0.04 * x[0];
    h(0, 1) = round ? 0.0 : 0.01 * z;
    h(1, 0) = 0.03 * x[1];
    h(1, 1) = 0.03 * x[0];
    if (round) h(2, 2) = 0.02 * x[0];
    if (solid) {
      h(0, 2) = 0.01 * x[1];
      h(1, 2) = -0.02 * z;
      h(2, 1) = 0.02 * z;
      h(2, 2) = 0.02 * x[1];
    }
    const Matrix3 strain = 0.5 * (h + h.transpose());
    const double lambda = test_moduli.bulk - 2.0 / 3.0 * test_moduli.shear;
    return lambda * strain.trace() * Matrix3::Identity() + 2.0 * test_moduli.shear * strain;
  }
};

TEST(NodalStress, IsExactWhereItIsLinearInQuadraticCells) {
  for (const char* element : {"tri6", "quad8", "tet10", "hex20"}) {
    for (const Plane plane : {Plane::strain, Plane::axisymmetric}) {
      if (element_named(element).dim == 3 && plane == Plane::axisymmetric) continue;
      SCOPED_TRACE(element);
      Bent bent(unit_mesh(element, 2), plane);
      const Mesh& mesh = bent.model.mesh();
      const std::vector<StressEntries> found = nodal_stress(bent.model, bent.u, {}).nodes;
      ASSERT_EQ(static_cast<int>(found.size()), mesh.node_count());
      for (int node = 0; node < mesh.node_count(); ++node) {
        const Matrix3 exact = bent.exact(mesh.points.data() + node * mesh.dim);
        EXPECT_LT((stress_of(found[node]) - exact).norm(), roundoff(1.0e4, 0.1)) << node;
      }
    }
  }
}

TEST(NodalStress, OfTwoCellsIsTheMeanOfWhatEachSays) {
  // Bars of different strain: 0.1 in the first cell, 0.3 in the second, of thrice its length.
  Mesh mesh = generate(BarMesh{0.0, 4.0, 2}, "test");
  mesh.points = {0.0, 1.0, 4.0};
  FeModel model(std::move(mesh), std::make_unique<LinearElastic>(test_moduli, 1.0), {});
  const std::vector<double> u = {0.0, 0.1, 1.0};
  const std::vector<StressEntries> found = nodal_stress(model, u, {}).nodes;
  const double youngs =
      9.0 * test_moduli.bulk * test_moduli.shear / (3.0 * test_moduli.bulk + test_moduli.shear);
  EXPECT_NEAR(found[0][0], 0.1 * youngs, roundoff(100.0, youngs));
  EXPECT_NEAR(found[1][0], 0.2 * youngs, roundoff(100.0, youngs));
  EXPECT_NEAR(found[2][0], 0.3 * youngs, roundoff(100.0, youngs));
  EXPECT_NEAR(nodal_stress(model, u, {}).most_of_cells, 0.3 * youngs, roundoff(100.0, youngs));
}

double measured(FeModel& model, const std::vector<double>& u, const std::vector<NamedNodes>& ports,
                const std::string& name) {
  const std::vector<std::string> names = solid_measure_names(model.mesh().dim, true, ports);
  const std::vector<double> zero(u.size(), 0.0);
  const std::vector<double> values = solid_measures(
      model, {true, u, zero, {}, {}, Vector::Zero(static_cast<Eigen::Index>(u.size()))}, ports);
  EXPECT_EQ(names.size(), values.size());
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return values[k];
  ADD_FAILURE() << "no measure " << name;
  return 0.0;
}

TEST(StressMeasures, MeansCountTheVolumeOfCells) {
  // Linear stress: its mean is that of the middle, however the cells are graded. Cells that count
  // once each give that of a third of the length.
  RectangleMesh rectangle;
  rectangle.lengths = {1.0, 1.0};
  rectangle.elements = {6, 3};
  rectangle.grading = {5.0, 1.0};
  rectangle.element = "quad8";
  Bent bent(generate(rectangle, "test"));
  const double middle[] = {0.5, 0.5};
  const Matrix3 exact = bent.exact(middle);
  const double bound = roundoff(1.0e4, 0.1);
  EXPECT_NEAR(measured(bent.model, bent.u, {}, "stress.xx.mean"), exact(0, 0), bound);
  EXPECT_NEAR(measured(bent.model, bent.u, {}, "stress.yy.mean"), exact(1, 1), bound);
  EXPECT_NEAR(measured(bent.model, bent.u, {}, "stress.xy.mean"), exact(0, 1), bound);
}

TEST(StressMeasures, OfAPortAndOfNodesAreThoseOfThePlace) {
  Bent bent(unit_mesh("quad8", 3));
  const Mesh& mesh = bent.model.mesh();
  const std::vector<NamedNodes> ports = {{"corner", mesh.nodes_of("right_top")},
                                         {"end", mesh.nodes_of("right")}};
  const double corner[] = {1.0, 1.0}, middle[] = {1.0, 0.5}, origin[] = {0.0, 0.0};
  const double bound = roundoff(1.0e4, 0.1);
  const Matrix3 there = bent.exact(corner);
  EXPECT_NEAR(measured(bent.model, bent.u, ports, "corner.stress.yy"), there(1, 1), bound);
  EXPECT_NEAR(measured(bent.model, bent.u, ports, "corner.von_mises"), von_mises(there), bound);
  // The nodes of the side lie evenly about its middle, where a linear field has its mean.
  EXPECT_NEAR(measured(bent.model, bent.u, ports, "end.stress.xx"), bent.exact(middle)(0, 0),
              bound);
  // All grow along x, and the shear along y.
  EXPECT_NEAR(measured(bent.model, bent.u, ports, "nodal_stress.xx.max"), there(0, 0), bound);
  EXPECT_NEAR(measured(bent.model, bent.u, ports, "nodal_stress.xx.min"), bent.exact(origin)(0, 0),
              bound);
  EXPECT_NEAR(measured(bent.model, bent.u, ports, "nodal_von_mises.max"), von_mises(there), bound);
}

}  // namespace
}  // namespace abut::nodal_stress_tests
