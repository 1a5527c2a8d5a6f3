// Goal: what solids tell all over themselves is their state, in VTK's terms. Oracles: VTK's tables
// of edges, laws evaluated directly, integrals of linear fields over cells.
#include "subdomain_solver/solid_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/vtk_cells.hpp"
#include "subdomain_solver/solid_measures.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solid_fields_tests {
namespace {

using Edges = std::vector<std::vector<int>>;

/// Corners between which VTK puts the nodes that follow the corners (the figures of VTK's user
/// guide, and vtkQuadraticTetra.h, vtkQuadraticHexahedron.h).
const std::map<int, Edges>& vtk_edges() {
  static const std::map<int, Edges> edges = {{21, {{0, 1}}},
                                             {22, {{0, 1}, {1, 2}, {2, 0}}},
                                             {23, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
                                             {28, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}}},
                                             {24, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
                                             {25,
                                              {{0, 1},
                                               {1, 2},
                                               {2, 3},
                                               {3, 0},
                                               {4, 5},
                                               {5, 6},
                                               {6, 7},
                                               {7, 4},
                                               {0, 4},
                                               {1, 5},
                                               {2, 6},
                                               {3, 7}}}};
  return edges;
}

/// Corners of linear cells and of quadratic ones, by VTK's number of the type.
int vtk_corners(int type) {
  static const std::map<int, int> corners = {{1, 1},  {3, 2},  {5, 3},  {9, 4},  {10, 4}, {12, 8},
                                             {21, 2}, {22, 3}, {23, 4}, {24, 4}, {25, 8},
                                             {28, 4}};
  return corners.at(type);
}

TEST(VtkCells, HoldEveryNodeOnceWithCornersFirstAndEveryOtherNodeBetweenItsCorners) {
  for (const Element& element : all_elements()) {
    SCOPED_TRACE(std::string(element.name));
    const VtkCell cell = vtk_cell(element);
    std::vector<int> sorted = cell.nodes;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(static_cast<int>(sorted.size()), element.nodes);
    for (int i = 0; i < element.nodes; ++i) EXPECT_EQ(sorted[i], i);
    const int corners = vtk_corners(cell.type);
    EXPECT_EQ(corners, element.corner_count());
    // Both go around the base first, so that corners agree; their orientation is the Jacobian's.
    for (int i = 0; i < corners; ++i) EXPECT_EQ(cell.nodes[i], i);
    if (element.order == 1) {
      EXPECT_EQ(element.nodes, corners);
      continue;
    }
    const Edges& edges = vtk_edges().at(cell.type);
    ASSERT_EQ(static_cast<int>(edges.size()), element.nodes - corners);
    const auto at = [&](int vtk_node, int axis) {
      const int ours = cell.nodes[vtk_node];
      return element.corners[ours * element.dim + axis];
    };
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (int axis = 0; axis < element.dim; ++axis) {
        double sum = 0.0;
        for (const int corner : edges[e]) sum += at(corner, axis);
        EXPECT_EQ(at(corners + static_cast<int>(e), axis),
                  sum / static_cast<double>(edges[e].size()))
            << "edge " << e;
      }
    }
  }
}

TEST(SolidGrid, IsTheMeshInSpace) {
  for (const std::string& element : solid_elements()) {
    SCOPED_TRACE(element);
    const Mesh mesh = unit_mesh(element, 2);
    const Grid grid = grid_of(mesh);
    EXPECT_EQ(unsound(grid), "");
    ASSERT_EQ(static_cast<int>(grid.nodes()), mesh.node_count());
    EXPECT_EQ(static_cast<int>(grid.cells()), mesh.cell_count());
    EXPECT_EQ(grid.connectivity.size(), mesh.blocks[0].nodes.size());
    const std::size_t dim = index(mesh.dim);
    for (std::size_t node = 0; node < grid.nodes(); ++node) {
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(grid.points[3 * node + i], i < dim ? mesh.points[dim * node + i] : 0.0);
    }
  }
}

/// Displacements (nodes, dim) of a homogeneous deformation.
std::vector<double> homogeneous(const Mesh& mesh, const Matrix3& f) {
  std::vector<double> u(mesh.points.size(), 0.0);
  for (int node = 0; node < mesh.node_count(); ++node) {
    for (int i = 0; i < mesh.dim; ++i) {
      for (int j = 0; j < mesh.dim; ++j)
        u[node * mesh.dim + i] +=
            (f(i, j) - (i == j ? 1.0 : 0.0)) * mesh.points[node * mesh.dim + j];
    }
  }
  return u;
}

/// Values by name, in the state of these displacements and velocities.
std::map<std::string, FieldValues> told(FeModel& model, const std::vector<double>& u,
                                        const std::vector<double>& v,
                                        std::vector<double> history = {}) {
  history.resize(model.history_size(), 0.0);
  const std::vector<FieldInfo> fields = solid_fields(model.material(), true);
  const Grid grid = grid_of(model.mesh());
  const std::vector<FieldValues> values = solid_field_values(model, {u, u, v, history}, true);
  EXPECT_EQ(unsound(fields), "");
  EXPECT_EQ(unsound(values, fields, grid.nodes(), grid.cells()), "");
  std::map<std::string, FieldValues> by_name;
  for (std::size_t k = 0; k < fields.size(); ++k) by_name[fields[k].name] = values[k];
  return by_name;
}

void expect_stress(const FieldValues& stress, const FieldValues& mises, const Matrix3& exact) {
  const double entries[] = {exact(0, 0), exact(1, 1), exact(2, 2),
                            exact(0, 1), exact(1, 2), exact(2, 0)};
  for (std::size_t k = 0; k < stress.size(); ++k)
    EXPECT_NEAR(stress[k], entries[k % 6], roundoff(1.0e4, 1.0)) << k;
  for (const double value : mises) EXPECT_NEAR(value, von_mises(exact), roundoff(1.0e4, 1.0));
}

TEST(SolidFields, HomogeneousStressIsThatOfTheLawInEveryCellOfEveryElement) {
  const NeoHookean law(test_moduli, 1.0);
  for (const std::string& element : solid_elements()) {
    SCOPED_TRACE(element);
    Mesh mesh = unit_mesh(element, 2);
    distort(mesh, 0.08);
    Matrix3 f = Matrix3::Identity();
    f(0, 0) = 1.2;
    f(0, 1) = 0.15;
    f(1, 0) = -0.1;
    if (mesh.dim == 3) f.col(2) = Eigen::Vector3d(0.05, -0.2, 0.9);
    const std::vector<double> u = homogeneous(mesh, f);
    FeModel model(std::move(mesh), std::make_unique<NeoHookean>(test_moduli, 1.0), {});
    PointResponse point;
    ASSERT_TRUE(law.evaluate(f, {}, {}, Need::stress, point));
    const Matrix3 exact = point.stress * f.transpose() / f.determinant();
    std::vector<double> v = u;
    for (double& value : v) value *= 3.0;
    std::map<std::string, FieldValues> fields = told(model, u, v);
    EXPECT_EQ(fields.size(), 6U);
    expect_stress(fields["stress"], fields["von_mises"], exact);
    expect_stress(fields["nodal_stress"], fields["nodal_von_mises"], exact);
    const std::size_t dim = index(model.mesh().dim);
    for (std::size_t k = 0; k < fields["displacement"].size(); ++k) {
      const bool there = k % 3 < dim;
      const std::size_t ours = there ? k / 3 * dim + k % 3 : 0;
      EXPECT_EQ(fields["displacement"][k], there ? u[ours] : 0.0);
      EXPECT_EQ(fields["velocity"][k], there ? v[ours] : 0.0);
    }
  }
}

TEST(SolidFields, StressOfASheetIsPerAreaOfTheThinnerSheet) {
  // F33 from P33 = 0, here by bisection; J holds it.
  const NeoHookean law(test_moduli, 1.0);
  Matrix3 f = Matrix3::Identity();
  f(0, 0) = 1.5;
  f(0, 1) = 0.2;
  PointResponse point;
  double low = 0.3, high = 1.5;
  for (int i = 0; i < 100; ++i) {
    f(2, 2) = 0.5 * (low + high);
    ASSERT_TRUE(law.evaluate(f, {}, {}, Need::stress, point));
    (point.stress(2, 2) > 0.0 ? high : low) = f(2, 2);
  }
  ASSERT_LT(f(2, 2), 0.95) << "the sheet gets thinner";
  const Matrix3 exact = point.stress * f.transpose() / f.determinant();
  Mesh mesh = unit_mesh("quad4", 2);
  const std::vector<double> u = homogeneous(mesh, f), v(u.size(), 0.0);
  FeModel model(std::move(mesh), std::make_unique<NeoHookean>(test_moduli, 1.0), {Plane::stress});
  std::map<std::string, FieldValues> fields = told(model, u, v);
  expect_stress(fields["stress"], fields["von_mises"], exact);
}

TEST(SolidFields, CellsHoldMeansWeightedByVolume) {
  // A body of revolution with u_r = r^2: hoop strain r, radial strain 2 r, so the axial stress is
  // 3 lambda r; its mean over the ring from a to b is 3 lambda (2/3) (b^3 - a^3) / (b^2 - a^2).
  const double lambda = test_moduli.bulk - 2.0 / 3.0 * test_moduli.shear;
  RectangleMesh rectangle;
  rectangle.origin = {1.0, 0.0};
  rectangle.lengths = {1.0, 0.5};
  rectangle.elements = {2, 1};
  rectangle.element = "quad8";
  Mesh mesh = generate(rectangle, "test");
  std::vector<double> u(mesh.points.size(), 0.0);
  for (std::size_t k = 0; k < u.size(); k += 2) u[k] = mesh.points[k] * mesh.points[k];
  const std::vector<double> v(u.size(), 0.0);
  FeModel model(std::move(mesh), std::make_unique<LinearElastic>(test_moduli, 1.0),
                {Plane::axisymmetric});
  std::map<std::string, FieldValues> fields = told(model, u, v);
  for (std::size_t cell = 0; cell < 2; ++cell) {
    const double a = 1.0 + 0.5 * static_cast<double>(cell), b = a + 0.5;
    const double mean = 2.0 * lambda * (b * b * b - a * a * a) / (b * b - a * a);
    EXPECT_NEAR(fields["stress"][6 * cell + 1], mean, roundoff(1.0e3, mean));
  }
}

TEST(SolidFields, InternalVariablesHaveTheNamesOfTheLaw) {
  Mesh mesh = unit_mesh("quad4", 1);
  const std::vector<double> u(mesh.points.size(), 0.0);
  for (const Plane plane : {Plane::strain, Plane::stress}) {
    FeModel model(mesh, std::make_unique<J2Plasticity>(test_moduli, test_hardening(), 1.0),
                  {plane});
    // Four points; the seventh number of each is the equivalent plastic strain.
    const std::size_t each = model.history_size() / 4;
    std::vector<double> history(model.history_size(), 0.0);
    for (std::size_t p = 0; p < 4; ++p) history[p * each + 6] = 0.01 * static_cast<double>(p + 1);
    std::map<std::string, FieldValues> fields = told(model, u, u, history);
    ASSERT_TRUE(fields.contains("equivalent_plastic_strain"));
    EXPECT_NEAR(fields["equivalent_plastic_strain"].at(0), 0.025, roundoff(10, 0.025));
  }
}

TEST(SolidFields, AnInadmissibleStateHasNoStressButAPlace) {
  Mesh mesh = unit_mesh("hex8", 1);
  Matrix3 f = Matrix3::Identity();
  f(0, 0) = -1.0;
  const std::vector<double> u = homogeneous(mesh, f);
  FeModel model(std::move(mesh), std::make_unique<NeoHookean>(test_moduli, 1.0), {});
  std::map<std::string, FieldValues> fields = told(model, u, u);
  for (const char* name : {"stress", "nodal_stress", "nodal_von_mises"})
    for (const double value : fields[name]) EXPECT_TRUE(std::isnan(value)) << name;
  for (const double value : fields["displacement"]) EXPECT_TRUE(std::isfinite(value));
}

TEST(SolidFields, ABodyThatDoesNotDeformHasNone) {
  const NeoHookean law(test_moduli, 1.0);
  EXPECT_EQ(solid_fields(law, false).size(), 2U);
  FeModel model(unit_mesh("hex8", 1), std::make_unique<NeoHookean>(test_moduli, 1.0), {});
  const std::vector<double> u(24, 0.5);
  EXPECT_EQ(solid_field_values(model, {{}, u, u, {}}, false), std::vector<FieldValues>(2, u));
}

}  // namespace
}  // namespace abut::solid_fields_tests
