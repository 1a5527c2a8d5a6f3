// Goal: a rigid body is the rigid motion of its mesh. Oracles: moments of a box in closed form; the
// momenta and energy of the same velocities in finite elements; differences in time; the power of
// forces on the nodes.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/rigid/rigid_fit.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::rigid_model_tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double density = 3.0;

FeModel mesh_model(Mesh mesh) {
  return FeModel(std::move(mesh), std::make_unique<LinearElastic>(isotropic(1.0, 0.3), density),
                 {});
}

Mesh distorted(const std::string& element) {
  Mesh mesh = unit_mesh(element, 2);
  distort(mesh, 0.1);
  return mesh;
}

/// A motion that is nothing special, as far as the dimension has it.
Pose some_pose(int dim) {
  Pose pose;
  pose.displacement = dim == 3 ? Vector3d(0.3, -0.7, 0.2) : Vector3d(0.3, -0.7, 0.0);
  const Vector3d axis = dim == 3 ? Vector3d(0.2, -0.5, 0.7).normalized() : Vector3d::UnitZ();
  pose.attitude = Quaterniond(Eigen::AngleAxisd(1.1, axis));
  return pose;
}

Twist some_twist(int dim) {
  if (dim == 3) return {{1.0, 0.5, -2.0}, {0.4, -1.3, 0.8}};
  return {{1.0, 0.5, 0.0}, {0.0, 0.0, -1.3}};
}

struct Moved {
  FeModel mesh;
  RigidModel body;
  RigidMap map;
  std::vector<double> q, v, u, velocity;

  explicit Moved(const std::string& element, MassForm form = MassForm::consistent)
      : mesh(mesh_model(distorted(element))), body(mesh, form), map(body, mesh.mesh()) {
    const Pose pose = some_pose(body.dim());
    q = body.coordinates(pose);
    v = body.rates(pose, some_twist(body.dim()));
    u.resize(index(mesh.dofs()));
    velocity = u;
    map.displacement(q, u);
    map.velocity(q, v, velocity);
  }
};

TEST(RigidModel, HasTheMomentsOfItsBox) {
  BoxMesh box;
  box.lengths = {0.3, 0.2, 0.5};
  box.elements = {2, 1, 3};
  const double mass = density * 0.03;
  for (const char* element : {"hex8", "tet4", "hex20", "tet10"}) {
    box.element = element;
    const FeModel mesh = mesh_model(generate(box, "test"));
    const RigidModel body(mesh, MassForm::consistent);
    // Sums over some dozens of nodes.
    EXPECT_NEAR(body.total_mass(), mass, roundoff(100.0, mass)) << element;
    EXPECT_LT((body.centre() - Vector3d(0.15, 0.1, 0.25)).norm(), roundoff(100.0, 0.25)) << element;
    const Eigen::Matrix3d inertia = body.inertia(Quaterniond::Identity());
    const Vector3d exact = mass / 12.0 * Vector3d(0.04 + 0.25, 0.25 + 0.09, 0.09 + 0.04);
    EXPECT_LT((inertia - Eigen::Matrix3d(exact.asDiagonal())).norm(),
              roundoff(1000.0, exact.norm()))
        << element;
  }
  RectangleMesh rectangle;
  rectangle.lengths = {0.3, 0.2};
  rectangle.elements = {3, 2};
  const FeModel mesh = mesh_model(generate(rectangle, "test"));
  const RigidModel body(mesh, MassForm::consistent);
  const double flat = density * 0.06;
  EXPECT_NEAR(body.inertia(Quaterniond::Identity())(2, 2), flat / 12.0 * (0.09 + 0.04),
              roundoff(100.0, flat));
  EXPECT_EQ(body.dofs(), 3);
}

TEST(RigidModel, HasTheMomentaOfItsFiniteElements) {
  for (const std::string& element : solid_elements()) {
    for (MassForm form : {MassForm::lumped, MassForm::averaged, MassForm::consistent}) {
      const Moved m(element, form);
      const int dim = m.body.dim();
      const Vector momentum = mass_matrix(m.mesh, form) * view(m.velocity);
      Vector3d linear = Vector3d::Zero(), angular = linear;
      for (int node = 0; node < m.mesh.mesh().node_count(); ++node) {
        Vector3d x = position(m.mesh.mesh(), node), p = Vector3d::Zero();
        for (int i = 0; i < dim; ++i) {
          x(i) += m.u[node * dim + i];
          p(i) = momentum(node * dim + i);
        }
        linear += p;
        angular += x.cross(p);
      }
      const Vector3d centre = m.body.centre() + some_pose(dim).displacement;
      const Vector3d about_origin = centre.cross(linear) + m.body.angular_momentum(m.v);
      const Twist twist = m.body.twist(m.q, m.v);
      // Sums over up to a hundred nodes with numbers of order 10.
      EXPECT_LT((linear - m.body.total_mass() * twist.velocity).norm(), roundoff(1000.0, 10.0))
          << element;
      EXPECT_LT((angular - about_origin).norm(), roundoff(1000.0, 10.0)) << element;
      EXPECT_NEAR(m.body.kinetic(m.q, m.v), 0.5 * view(m.velocity).dot(momentum),
                  roundoff(1000.0, 10.0))
          << element;
    }
  }
}

TEST(RigidMap, HasRatesThatAreThoseOfItsDisplacements) {
  for (const char* element : {"quad4", "hex8"}) {
    const Moved m(element);
    const double h = 1.0e-4;
    std::vector<double> before = m.q, after = m.q, u0 = m.u, u1 = m.u, a = m.u;
    m.body.drift(before, m.v, -h);
    m.body.drift(after, m.v, h);
    m.map.displacement(before, u0);
    m.map.displacement(after, u1);
    m.map.acceleration(m.q, m.v, std::vector<double>(m.v.size(), 0.0), a);
    // Central differences: h^2/6 of third and h^2/12 of fourth derivatives, at most 1.6^4 times an
    // arm below 1; round-off of 1 over h and h^2.
    for (std::size_t k = 0; k < m.u.size(); ++k) {
      EXPECT_NEAR((u1[k] - u0[k]) / (2.0 * h), m.velocity[k], 7.0 * h * h) << element;
      EXPECT_NEAR((u1[k] - 2.0 * m.u[k] + u0[k]) / (h * h), a[k],
                  7.0 * h * h + roundoff(8.0, 1.0) / (h * h))
          << element;
    }
  }
}

TEST(RigidMap, AddsTheRatesThatAForceMakes) {
  for (const char* element : {"quad4", "hex8"}) {
    const Moved m(element);
    // Velocities at one place after a short kick: linear in the rates of momentum, exactly.
    std::vector<double> rate(m.v.size(), 0.7), kicked = m.v, free = m.u, pushed = m.u, after = m.u;
    for (std::size_t i = 0; i < kicked.size(); ++i) kicked[i] += 1.0e-3 * rate[i];
    m.map.velocity(m.q, kicked, after);
    m.map.acceleration(m.q, m.v, std::vector<double>(m.v.size(), 0.0), free);
    m.map.acceleration(m.q, m.v, rate, pushed);
    for (std::size_t k = 0; k < m.u.size(); ++k)
      EXPECT_NEAR((after[k] - m.velocity[k]) / 1.0e-3, pushed[k] - free[k],
                  roundoff(100.0, 10.0) / 1.0e-3)
          << element;
  }
}

TEST(RigidMap, LiftsForcesSoThatTheirPowerStays) {
  for (const char* element : {"quad4", "tri6", "hex8", "tet10"}) {
    const Moved m(element);
    std::vector<double> nodal(m.u.size());
    for (std::size_t k = 0; k < nodal.size(); ++k) nodal[k] = std::sin(double(k));
    Vector force = Vector::Zero(m.body.dofs());
    m.map.lift(m.q, nodal, force);
    const double power = view(nodal).dot(view(m.velocity));
    EXPECT_NEAR(m.body.power(m.q, m.v, force), power, roundoff(1000.0, 10.0)) << element;
  }
}

TEST(RigidFit, FindsTheMotionThatAFieldIs) {
  for (const char* element : {"quad4", "hex8", "tet10"}) {
    const Moved m(element);
    const PoseFit pose = fit_pose(m.body, m.mesh, m.u);
    EXPECT_LT(pose.distance, roundoff(100.0, 1.0)) << element;
    EXPECT_LT(largest_difference(m.body.coordinates(pose.pose), m.q), roundoff(100.0, 1.0));
    const TwistFit twist = fit_twist(m.body, m.mesh, m.mesh.mass(), pose.pose, m.velocity);
    EXPECT_LT(twist.distance, roundoff(100.0, 3.0)) << element;
    EXPECT_LT(largest_difference(m.body.rates(pose.pose, twist.twist), m.v), roundoff(100.0, 3.0));
  }
}

TEST(RigidFit, SaysHowFarAFieldIsFromARigidOne) {
  // Stretched by e along x: the nearest rigid motion leaves e/2 at the ends of an edge of length 1.
  const double e = 1.0e-3;
  for (const char* element : {"quad4", "hex8"}) {
    const FeModel mesh = mesh_model(unit_mesh(element, 1));
    const RigidModel body(mesh, MassForm::consistent);
    const std::vector<double> field =
        nodal(mesh.mesh(), [e](const Position& x) { return Position(e * x.x(), 0.0, 0.0); });
    EXPECT_NEAR(fit_pose(body, mesh, field).distance, 0.5 * e, roundoff(100.0, 1.0));
    EXPECT_NEAR(fit_twist(body, mesh, mesh.mass(), {}, field).distance, 0.5 * e,
                roundoff(100.0, 1.0));
    // A mirror image is no turn, in the plane either: corners stay 1 away at least.
    const std::vector<double> mirror =
        nodal(mesh.mesh(), [](const Position& x) { return Position(-2.0 * x.x(), 0.0, 0.0); });
    EXPECT_GT(fit_pose(body, mesh, mirror).distance, 0.5);
  }
}

}  // namespace
}  // namespace abut::rigid_model_tests
