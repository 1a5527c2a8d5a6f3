// Goal: dead and follower pressure. Oracles: the volume change of a pressurised cube in closed
// form; balance of a uniform pressure on a closed surface, however deformed; differences.
#include <cmath>

#include <Eigen/Dense>

#include "subdomain_solver/materials/neo_hookean.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_pressure_tests {
namespace {

constexpr double bulk = 1.25, shear = 0.5;

std::unique_ptr<const Material> rubber() {
  return std::make_unique<NeoHookean>(Moduli{bulk, shear}, 1.0);
}

/// Stretch of a unit cube pressed on all sides, resting on three planes of symmetry.
double stretch_of_cube(const std::string& element, Formulation formulation, double pressure,
                       bool follows) {
  Solid s(unit_mesh(element, 2), rubber(), {Plane::strain, formulation, 1.0});
  s.fix("left", 0);
  s.fix("bottom", 1);
  s.fix("back", 2);
  s.press(
      "boundary", [pressure](const auto&, double time) { return pressure * time; }, follows);
  NewtonOptions newton;
  newton.tolerance = 1.0e-12;
  s.settle(4, newton);
  for (int node = 0; node < s.model.mesh().node_count(); ++node) {
    const Position x = position(s.model.mesh(), node);
    const Position u = s.displacement(node), first = s.mean_displacement("right");
    EXPECT_LT((u - first.x() * x).norm(), 10.0 * newton.tolerance) << "the cube stays a cube";
  }
  return 1.0 + s.mean_displacement("right").x();
}

TEST(PressedCube, FollowerPressureIsTheCauchyStress) {
  // kappa/2 (J - 1/J) = -p
  const double p = 0.4;
  const double j = -p / bulk + std::sqrt(1.0 + p * p / (bulk * bulk));
  for (const std::string element : {"tet4", "tet10", "hex8", "hex20"}) {
    for (Formulation formulation : {Formulation::full, Formulation::mean_dilatation}) {
      // Newton's tolerance of 1e-12 of the forces, over a stiffness of the order of the modulus.
      EXPECT_NEAR(stretch_of_cube(element, formulation, p, true), std::cbrt(j), 1.0e-11) << element;
    }
  }
}

TEST(PressedCube, DeadPressureIsTheNominalStress) {
  // kappa/2 (l^5 - 1/l) = -p, by Newton's method
  const double p = 0.4;
  double l = 1.0;
  for (int i = 0; i < 50; ++i)
    l -= (0.5 * bulk * (std::pow(l, 5) - 1.0 / l) + p) /
         (0.5 * bulk * (5.0 * std::pow(l, 4) + 1.0 / (l * l)));
  for (const std::string element : {"tet4", "tet10", "hex8", "hex20"})
    EXPECT_NEAR(stretch_of_cube(element, Formulation::full, p, false), l, 1.0e-11)
        << element;  // ten of Newton's tolerances
}

/// A body turned, stretched and made irregular.
std::vector<double> deformed(const Mesh& mesh) {
  DrawTensors draw;
  const Matrix3 f = Matrix3::Identity() + draw.matrix(0.3);
  const Matrix3 turned = mesh.dim == 3 ? Matrix3(draw.rotation() * f) : f;
  std::vector<double> q =
      nodal(mesh, [&turned](const Position& x) { return Position(turned * x - x); });
  for (double& u : q) u += draw.between(-0.05, 0.05);
  return q;
}

TEST(FollowerPressure, OnAClosedSurfaceHasNoForceAndNoMoment) {
  for (const std::string& element : solid_elements()) {
    FeModel model(unit_mesh(element, 2), rubber(), {});
    const Pressure pressure(
        model, "boundary", [](const auto&, double) { return 2.0; }, true);
    const std::vector<double> q = deformed(model.mesh());
    Vector nodal_force = Vector::Zero(model.dofs());
    pressure.add(0.0, q, nodal_force);
    const int dim = model.mesh().dim;
    Position force = Position::Zero(), moment = Position::Zero();
    for (int node = 0; node < model.mesh().node_count(); ++node) {
      Position f = Position::Zero(), x = position(model.mesh(), node);
      for (int i = 0; i < dim; ++i) {
        f(i) = nodal_force(node * dim + i);
        x(i) += q[node * dim + i];
      }
      force += f;
      moment += x.cross(f);
    }
    // Sums of about a hundred terms of order 1, integrated exactly.
    EXPECT_LT(force.norm(), roundoff(100.0, 2.0)) << element;
    EXPECT_LT(moment.norm(), roundoff(100.0, 2.0)) << element;
    EXPECT_GT(nodal_force.norm(), 0.1) << element;
  }
}

TEST(FollowerPressure, TangentIsTheDerivativeOnAClosedSurface) {
  for (const std::string& element : solid_elements()) {
    FeModel model(unit_mesh(element, 1), rubber(), {});
    const Pressure pressure(
        model, "boundary", [](const auto&, double) { return 2.0; }, true);
    std::vector<double> q = deformed(model.mesh());
    ModelResponse pattern;
    ASSERT_TRUE(
        model.evaluate(std::vector<double>(q.size(), 0.0), {}, Model::Want::tangent, pattern));
    SparseMatrix tangent = 0.0 * pattern.tangent;
    pressure.add_tangent(0.0, q, tangent);
    // The force is a polynomial of degree two in q: central differences err by round-off alone.
    const double step = 1.0e-3;
    for (std::size_t k = 0; k < q.size(); ++k) {
      const double kept = q[k];
      Vector slope = Vector::Zero(model.dofs()), back = slope;
      q[k] = kept + step;
      pressure.add(0.0, q, slope);
      q[k] = kept - step;
      pressure.add(0.0, q, back);
      q[k] = kept;
      slope = (slope - back) / (2.0 * step);
      const Vector column = -Eigen::MatrixXd(tangent).col(static_cast<Eigen::Index>(k));
      EXPECT_LT((slope - column).norm(), roundoff(100.0, 2.0 / step)) << element << " " << k;
    }
  }
}

TEST(FollowerPressure, TurnsWithTheBody) {
  // A neo-Hookean block under pressure, then turned: forces turn with it, and nothing else happens.
  FeModel model(unit_mesh("hex8", 2), rubber(), {});
  const Pressure pressure(
      model, "right", [](const auto&, double) { return 2.0; }, true);
  const std::vector<double> q = deformed(model.mesh());
  const Matrix3 turn = DrawTensors().rotation();
  std::vector<double> turned(q.size());
  Vector force = Vector::Zero(model.dofs()), after = force;
  for (int node = 0; node < model.mesh().node_count(); ++node) {
    const Position x = position(model.mesh(), node);
    const Position u(view(q).segment<3>(3 * node));
    view(turned).segment<3>(3 * node) = turn * (x + u) - x;
  }
  pressure.add(0.0, q, force);
  pressure.add(0.0, turned, after);
  for (int node = 0; node < model.mesh().node_count(); ++node) {
    EXPECT_LT((after.segment<3>(3 * node) - turn * force.segment<3>(3 * node)).norm(),
              roundoff(100.0, 2.0));
  }
}

}  // namespace
}  // namespace abut::solids_pressure_tests
