// Goal: no element under any formulation has a motion without stiffness beside the rigid ones, and
// all bend as beams do. Oracles: the number of rigid motions; the deflection of a cantilever.
#include <cmath>
#include <random>
#include <string>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_formulations_tests {
namespace {

class Formulations : public testing::TestWithParam<ElementCase> {};

int rigid_motions_of(const ElementCase& c) {
  const int dim = element_named(c.element).dim;
  if (dim == 1 || (dim == 2 && c.plane == Plane::axisymmetric)) return 1;  // along the axis
  return dim == 2 ? 3 : 6;
}

/// Eigenvalues of one cell's tangent at rest, ascending, in parts of the largest.
Vector stiffnesses(FeModel& model) {
  const std::vector<double> rest(index(model.dofs()), 0.0);
  const std::vector<double> history(model.history_size(), 0.0);
  Eigen::MatrixXd tangent;
  EXPECT_TRUE(model.cell_tangent(0, 0, rest, history, tangent));
  EXPECT_LT((tangent - tangent.transpose()).norm(), roundoff(40.0, tangent.norm())) << "symmetric";
  const Vector all = symmetric_eigenvalues(tangent);
  return all / all.tail(1)(0);
}

TEST_P(Formulations, LeaveOneCellNoFreeMotionBesideTheRigidOnes) {
  const ElementCase& c = GetParam();
  const int rigid = rigid_motions_of(c);
  for (const double size : {0.0, 0.05}) {  // of the distortion
    for (const bool linear : {true, false}) {
      Mesh mesh = unit_mesh(c.element, 1);
      std::mt19937_64 engine(11);
      for (double& x : mesh.points)
        x += 1.0 + 2.0 * size * (static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5);
      std::unique_ptr<const Material> law =
          std::make_unique<LinearElastic>(isotropic(1.0, 0.3), 1.0);
      if (!linear) law = std::make_unique<NeoHookean>(isotropic(1.0, 0.3), 1.0);
      FeModel model(std::move(mesh), std::move(law), {c.plane, c.formulation, 0.7});
      const Vector found = stiffnesses(model);
      // Round-off, against the softest motions: hourglasses, and a ring that turns in its section.
      for (int k = 0; k < rigid; ++k) EXPECT_LT(std::abs(found(k)), 1.0e-13) << k;
      EXPECT_GT(found(rigid), 1.0e-4) << "distorted by " << size;
    }
  }
}

/// Deflection of the end of a clamped beam, length 10 and a unit section, under a unit end force,
/// in parts of that of beams that shear (Timoshenko, shear correction 5/6).
double deflection_of_beam(const ElementCase& c, int over_height) {
  const double length = 10.0, young = 1.0, nu = 0.3;
  const int along = element_named(c.element).order == 2 ? 10 : 10 * over_height;
  const bool flat = element_named(c.element).dim == 2;
  Mesh mesh;
  if (flat) {
    RectangleMesh m;
    m.lengths = {length, 1.0};
    m.elements = {along, over_height};
    m.element = c.element;
    mesh = generate(m, "test");
  } else {
    BoxMesh m;
    m.lengths = {length, 1.0, 1.0};
    m.elements = {along, over_height, over_height};
    m.element = c.element;
    mesh = generate(m, "test");
  }
  Solid s(std::move(mesh), std::make_unique<LinearElastic>(isotropic(young, nu), 1.0),
          {c.plane, c.formulation});
  for (int i = 0; i < s.model.mesh().dim; ++i) s.fix("left", i);
  s.pull("right", {ScalarField(), [](const auto&, double) { return 1.0; }, ScalarField()});
  s.settle();
  const double bending = flat && c.plane == Plane::strain ? young / (1.0 - nu * nu) : young;
  const double shear = young / (2.0 * (1.0 + nu));
  const double exact =
      length * length * length / (3.0 * bending / 12.0) + length / (5.0 / 6.0 * shear);
  return s.mean_displacement("right").y() / exact;
}

/// Deflection of the middle of a clamped round plate, radius 10 and thickness 1, under a unit
/// pressure, in parts of that of plates that shear: p a^4/(64 D) + p a^2/(4 . 5/6 G).
double deflection_of_plate(const ElementCase& c, int over_height) {
  const double radius = 10.0, young = 1.0, nu = 0.3;
  RectangleMesh m;
  m.lengths = {radius, 1.0};
  m.elements = {element_named(c.element).order == 2 ? 10 : 10 * over_height, over_height};
  m.element = c.element;
  Solid s(generate(m, "test"), std::make_unique<LinearElastic>(isotropic(young, nu), 1.0),
          {Plane::axisymmetric, c.formulation});
  s.fix("left", 0);
  for (int i = 0; i < 2; ++i) s.fix("right", i);
  s.press(
      "bottom", [](const auto&, double) { return 1.0; }, false);
  s.settle();
  const double stiffness = young / (12.0 * (1.0 - nu * nu)), shear = young / (2.0 * (1.0 + nu));
  const double exact =
      std::pow(radius, 4) / (64.0 * stiffness) + radius * radius / (4.0 * 5.0 / 6.0 * shear);
  return s.mean_displacement("left").y() / exact;
}

/// What a cell may take of the deflection, over the height of four linear cells or one quadratic.
struct Share {
  double least, most;
};
Share expected_share(const ElementCase& c) {
  const Element& element = element_named(c.element);
  // Quadratic cells hold the moments exactly, one over the height the shear and the clamp, of which
  // beams know nothing, to some parts in a hundred of this deflection.
  if (element.order == 2) return {0.965, 1.0};
  // Linear shear over a cell: (1/4 of the height)^2 of the bending stiffness, and far more without
  // a field of four corners. Steps of strain over the height hold 1 - 1/16 of the moment.
  const bool corners = element.shape == Shape::quadrilateral || element.shape == Shape::hexahedron;
  if (!corners) return {0.75, 0.9};
  return c.formulation == Formulation::one_point ? Share{0.97, 1.08} : Share{0.95, 1.02};
}

TEST_P(Formulations, BendAsBeamsAndPlatesDo) {
  const ElementCase& c = GetParam();
  if (element_named(c.element).dim == 1) return;
  const int over_height = element_named(c.element).order == 2 ? 1 : 4;
  const double share = c.plane == Plane::axisymmetric ? deflection_of_plate(c, over_height)
                                                      : deflection_of_beam(c, over_height);
  RecordProperty("deflection", std::to_string(share));
  EXPECT_GT(share, expected_share(c).least);
  EXPECT_LT(share, expected_share(c).most);
}

INSTANTIATE_TEST_SUITE_P(All, Formulations, testing::ValuesIn(element_cases()));

}  // namespace
}  // namespace abut::solids_formulations_tests
