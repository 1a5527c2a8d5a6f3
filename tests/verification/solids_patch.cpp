// Goal: an affine displacement of the boundary makes an affine displacement of the body, and a
// uniform stress on the boundary a uniform stress in it, for every element, formulation and plane
// on cells of irregular shape (the patch test: no order of convergence without it). Oracle: the
// affine field itself; the law at its F; Hooke's law solved for the strain.
#include <cmath>

#include <Eigen/Dense>

#include "base/index.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_patch_tests {
namespace {

using Case = ElementCase;

/// Irregular cells. Those of quadrilaterals and hexahedra have curved edges too; simplices keep
/// straight ones, because their rules are exact on affine cells only (element.hpp).
Mesh patch(const Case& c) {
  Mesh mesh = unit_mesh(c.element, 3);
  distort(mesh, 0.05);
  const Shape shape = element_named(c.element).shape;
  if (shape == Shape::triangle || shape == Shape::tetrahedron) straighten(mesh);
  return mesh;
}

/// Gradients of displacement; of an axisymmetric body only these are in equilibrium: the same
/// strain along the radius and the circle, another along the axis.
Matrix3 gradient(const Case& c, double size) {
  Matrix3 h;
  h << 0.3, -0.7, 0.4, 0.8, -0.5, 0.6, -0.2, 0.5, 0.9;
  if (c.plane == Plane::axisymmetric) h = Eigen::Vector3d(0.3, -0.5, 0.3).asDiagonal();
  return size * h;
}

/// F of the affine displacement: three axes in space, the plane's two and the circle's otherwise.
Matrix3 deformation(const Case& c, const Matrix3& h) {
  if (element_named(c.element).dim == 3) return Matrix3::Identity() + h;
  Matrix3 f = Matrix3::Identity();
  const int dim = element_named(c.element).dim;
  f.topLeftCorner(dim, dim) += h.topLeftCorner(dim, dim);
  if (c.plane == Plane::axisymmetric) f(2, 2) += h(2, 2);
  return f;
}

class Patch : public testing::TestWithParam<Case> {
 protected:
  /// Prescribes H x on the boundary, solves, and compares the rest with H x, stresses with the law.
  void check(std::unique_ptr<const Material> law, const Matrix3& h, int steps, double tolerance) {
    Solid s(patch(GetParam()), std::move(law), {GetParam().plane, GetParam().formulation, 0.7});
    for (int i = 0; i < s.model.mesh().dim; ++i) {
      s.prescribe("boundary", i,
                  [&h, i](const Position& x, double time) { return time * h.row(i).dot(x); });
    }
    NewtonOptions newton;
    newton.tolerance = 1.0e-12;
    s.settle(steps, newton);
    double most = 0.0;
    for (int node = 0; node < s.model.mesh().node_count(); ++node) {
      Position exact = h * position(s.model.mesh(), node);
      exact.tail(3 - s.model.mesh().dim).setZero();
      most = std::max(most, (s.displacement(node) - exact).norm());
    }
    EXPECT_LT(most, tolerance * h.norm());
    PointResponse exact;
    std::vector<double> before(index(s.model.material().history_size()), 0.0);
    std::vector<double> after = before;
    const Matrix3 f = deformation(GetParam(), h);
    ASSERT_TRUE(s.model.material().evaluate(f, before, after, Need::stress, exact));
    double worst = 0.0;
    ASSERT_TRUE(s.model.visit(s.motion.q, s.motion.history, [&](const FeModel::PointState& point) {
      worst = std::max(worst, (point.stress - exact.stress).norm());
    }));
    // Strains are differences of displacements over a node distance of 0.1.
    EXPECT_LT(worst, 10.0 * tolerance * exact.stress.norm());
  }
};

TEST_P(Patch, LinearFieldIsExact) {
  // Round-off of a direct solution: the stiffness of 27 cells has a condition below 1e3.
  check(std::make_unique<LinearElastic>(isotropic(2.0, 0.3), 1.0), gradient(GetParam(), 0.01), 1,
        roundoff(1.0e3, 1.0));
}

TEST_P(Patch, FiniteAffineDeformationIsExact) {
  // Newton's tolerance of 1e-12 of the forces, times the spread of stiffness between the modes of
  // the patch, below 100.
  check(std::make_unique<NeoHookean>(isotropic(2.0, 0.3), 1.0), gradient(GetParam(), 0.3), 4,
        1.0e-10);
}

TEST_P(Patch, UniformTractionMakesUniformStress) {
  const Case& c = GetParam();
  const double young = 2.0, nu = 0.3, pull = 0.01;
  Solid s(patch(c), std::make_unique<LinearElastic>(isotropic(young, nu), 1.0),
          {c.plane, c.formulation, 0.7});
  const int dim = s.model.mesh().dim;
  // Along the second axis, which is the axis of revolution of an axisymmetric body; a bar has one.
  const auto uniform = [pull](const auto&, double) { return pull; };
  if (dim == 1) s.pull("right", {uniform, ScalarField(), ScalarField()});
  if (dim > 1) s.pull("top", {ScalarField(), uniform, ScalarField()});
  s.fix("left", 0);
  if (dim > 1) s.fix("bottom", 1);
  if (dim == 3) s.fix("back", 2);
  s.settle();
  const bool strain = dim == 2 && c.plane == Plane::strain;
  const double along = pull / young * (strain ? 1.0 - nu * nu : 1.0);
  const double across = -pull / young * (strain ? nu * (1.0 + nu) : nu);
  for (int node = 0; node < s.model.mesh().node_count(); ++node) {
    const Position x = position(s.model.mesh(), node);
    Position exact(across * x.x(), along * x.y(), across * x.z());
    if (dim == 1) exact.x() = along * x.x();
    EXPECT_LT((s.displacement(node) - exact).norm(), roundoff(1.0e4, along)) << "node " << node;
  }
}

TEST_P(Patch, PressureAllAroundMakesTheSamePressureInside) {
  // Around the circle too, where the mean of N/R over a cell of revolution decides; across a plane
  // that cannot thicken it is 2 nu times as much.
  const Case& c = GetParam();
  const double young = 2.0, nu = 0.3, p = 0.01;
  Solid s(patch(c), std::make_unique<LinearElastic>(isotropic(young, nu), 1.0),
          {c.plane, c.formulation, 0.7});
  const int dim = s.model.mesh().dim;
  s.fix("left", 0);
  if (dim > 1) s.fix("bottom", 1);
  if (dim == 3) s.fix("back", 2);
  const char* pressed = dim == 1 ? "right" : "boundary";
  s.press(
      pressed, [p](const auto&, double) { return p; }, false);
  s.settle();
  Matrix3 exact = -p * Matrix3::Identity();
  if (dim == 1) exact.diagonal().tail<2>().setZero();
  if (dim == 2 && c.plane == Plane::stress) exact(2, 2) = 0.0;
  if (dim == 2 && c.plane == Plane::strain) exact(2, 2) = -2.0 * nu * p;
  double worst = 0.0;
  ASSERT_TRUE(s.model.visit(s.motion.q, s.motion.history, [&](const FeModel::PointState& point) {
    worst = std::max(worst, (point.stress - exact).norm());
  }));
  EXPECT_LT(worst, roundoff(1.0e4, p));
}

INSTANTIATE_TEST_SUITE_P(All, Patch, testing::ValuesIn(element_cases()));

}  // namespace
}  // namespace abut::solids_patch_tests
