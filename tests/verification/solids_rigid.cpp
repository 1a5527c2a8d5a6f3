// Goal: rigid bodies move as mechanics has it. Oracles: conservation laws; the pendulum's elliptic
// function and a top's steady precession; observed orders; reversal of time; momenta of the same
// body in finite elements.
#include <array>
#include <cmath>
#include <numbers>

#include "base/index.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/rigid/rigid_map.hpp"
#include "subdomain_solver/rigid/rigid_motion.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_rigid_tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// A rigid body of a mesh, density 1, with loads on its nodes.
struct Rigid {
  explicit Rigid(Mesh mesh, MassForm form = MassForm::consistent)
      : solid(std::move(mesh), std::make_unique<NeoHookean>(isotropic(1.0, 0.3), 1.0)),
        body(solid.model, form),
        map(body, solid.model.mesh()),
        run(problem, body) {
    problem.model = &body;
    start({}, {});
  }
  void start(const Pose& pose, const Twist& twist) {
    motion.q = body.coordinates(pose);
    motion.v = body.rates(pose, twist);
  }
  void add(std::unique_ptr<const Load> load) {
    problem.loads.push_back(
        std::make_unique<LiftedLoad>(std::move(load), map, index(solid.model.dofs())));
  }
  void add_acceleration(VectorField field) {
    add(std::make_unique<BodyForce>(solid.model, std::move(field)));
  }
  void advance(int steps, double dt) {
    ASSERT_FALSE(run.begin(motion, 0.0));
    for (int k = 0; k < steps; ++k) ASSERT_FALSE(run.step(motion, k * dt, dt)) << "step " << k;
  }
  double energy() const { return run.kinetic(motion) - motion.external_work; }

  Solid solid;
  RigidModel body;
  RigidMap map;
  Problem problem;
  RigidMotion run;
  Motion motion;
};

Mesh box(std::array<double, 3> lengths) {
  BoxMesh mesh;
  mesh.origin_at = Origin::centre;
  mesh.lengths = lengths;
  mesh.elements = {1, 1, 1};
  return generate(mesh, "test");
}

/// A square of side 1 about the origin.
Mesh square() {
  RectangleMesh mesh;
  mesh.origin_at = Origin::centre;
  mesh.lengths = {1.0, 1.0};
  mesh.elements = {2, 2};
  return generate(mesh, "test");
}

TEST(FreeRigidBody, KeepsItsMomentaAndItsEnergyOver100000Steps) {
  // The same body and spin as of the elastic one (solids_dynamics.cpp), and a box about its
  // intermediate axis.
  for (const std::array<double, 3>& lengths : {std::array{1.0, 1.0, 1.0}, {0.2, 0.1, 0.05}}) {
    Rigid r(box(lengths));
    r.start({}, {{0.1, -0.2, 0.3}, {0.001, 0.05, 0.001}});
    const std::vector<double> before = r.motion.v;
    const double energy = r.energy();
    r.advance(100000, 0.1);
    EXPECT_EQ(r.motion.v, before);  // numbers that nothing touches
    // Attitudes round once or twice a step and tell the energy to the ratio of the inertias, 4.
    EXPECT_NEAR(r.energy(), energy, roundoff(8.0e5, energy));
    EXPECT_NEAR(r.body.pose(r.motion.q).displacement(0), 0.1 * 100000 * 0.1, roundoff(1e5, 1e3));
  }
}

TEST(FreeRigidBody, IsAsFarAfterOneStepAsAfterAThousand) {
  for (const char* element : {"quad4", "tet4"}) {
    Mesh mesh = unit_mesh(element, 2);
    distort(mesh, 0.1);
    Rigid once(mesh), often(mesh);
    const Twist twist = {{1.0, -0.5, 0.0}, {0.0, 0.0, 2.0}};
    for (Rigid* r : {&once, &often}) r->start({}, twist);
    once.advance(1, 10.0);
    often.advance(1000, 0.01);
    // A rounding or two a step of displacements of 10 and angles of 20.
    EXPECT_LT(largest_difference(once.motion.q, often.motion.q), roundoff(2000.0, 20.0)) << element;
  }
}

TEST(RigidBody, FallsAsItDoesInFiniteElementsUnderAnyLoad) {
  // Total momentum knows the loads alone: a block that is pulled, pushed and falls has the same in
  // both rungs, with the same rule in time, whatever the block does inside.
  const VectorField pull = {[](const std::array<double, 3>& x, double t) { return x[1] + t; },
                            [](const std::array<double, 3>& x, double) { return x[0] * x[1]; },
                            [](const std::array<double, 3>&, double t) { return std::sin(t); }};
  const VectorField fall = {nullptr, nullptr,
                            [](const std::array<double, 3>&, double) { return -0.1; }};
  Rigid r(unit_mesh("hex8", 2), MassForm::lumped);
  Solid fe(unit_mesh("hex8", 2), std::make_unique<NeoHookean>(isotropic(10.0, 0.3), 1.0));
  r.add(std::make_unique<Traction>(r.solid.model, "right", pull));
  r.add_acceleration(fall);
  fe.pull("right", pull);
  fe.problem.loads.push_back(std::make_unique<BodyForce>(fe.model, fall));
  ExplicitDynamics run(fe.problem);
  ASSERT_FALSE(run.begin(fe.motion, 0.0));
  const int steps = 200;
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(run.step(fe.motion, 0.01 * k, 0.01));
  r.advance(steps, 0.01);
  Vector3d momentum = Vector3d::Zero();
  for (int node = 0; node < fe.model.mesh().node_count(); ++node)
    momentum += fe.model.lumped_mass()(3 * node) * Vector3d(view(fe.motion.v).segment<3>(3 * node));
  const Vector3d rigid = r.body.total_mass() * r.body.twist(r.motion.q, r.motion.v).velocity;
  EXPECT_GT(rigid.norm(), 1.0);
  EXPECT_LT((momentum - rigid).norm(), roundoff(10.0 * steps, rigid.norm()));
}

/// Angle of a pendulum let go at angle0, u'' = -sin(u): 2 asin(k sn(K - t)) (Landau and Lifshitz,
/// section 11), here at a quarter of its period, where it is zero, and with its rate there, 2 k.
double pendulum_error(int steps) {
  const double angle0 = 2.0, k = std::sin(0.5 * angle0), quarter = std::comp_ellint_1(k);
  Rigid r(square());
  // A force (-g x, 0) on every point: moment -g S11 sin(u), with S11 half the inertia.
  r.add_acceleration(
      {[](const std::array<double, 3>& x, double) { return 2.0 * x[0]; }, nullptr, nullptr});
  Pose pose;
  pose.attitude = Quaterniond(Eigen::AngleAxisd(angle0, Vector3d::UnitZ()));
  r.start(pose, {});
  r.advance(steps, quarter / steps);
  EXPECT_NEAR(r.energy(), 0.0, roundoff(10.0 * steps, 1.0));  // the work is that of the kicks
  return std::max(std::abs(r.motion.q[2]), std::abs(r.motion.v[2] + 2.0 * k));
}

TEST(RigidBody, SwingsAsAPendulumToSecondOrder) {
  const double coarse = pendulum_error(50), fine = pendulum_error(100);
  // Terms of next order are (dt)^2 = 1e-3 of these, with factors of a few units.
  EXPECT_NEAR(observed_order(coarse, fine), 2.0, 0.01);
  EXPECT_LT(fine, 1.0e-3);  // dt = K/100 = 0.02, and twice the square of it
}

/// A top about its centre in steady precession under a force (0, 0, -g z) on its points, whose
/// moment is that of a weight on its axis: I3 w3 W - I1 W^2 cos = g S33, for inclination cos = 0.6.
struct HeavyTop {
  static constexpr double precession = 1.5, spin = 6.0;  // W, w3
  Rigid r;

  HeavyTop() : r(box({1.0, 1.0, 0.5})) {
    const Eigen::Matrix3d inertia = r.body.inertia(Quaterniond::Identity());
    const double s33 = 0.5 * (inertia(0, 0) + inertia(1, 1) - inertia(2, 2));
    const double g =
        (inertia(2, 2) * spin * precession - inertia(0, 0) * precession * precession * 0.6) / s33;
    r.add_acceleration(
        {nullptr, nullptr, [g](const std::array<double, 3>& x, double) { return -g * x[2]; }});
    Pose pose;
    pose.attitude = Quaterniond(Eigen::AngleAxisd(std::atan2(0.8, 0.6), Vector3d::UnitY()));
    const Vector3d axis(0.8, 0.0, 0.6);
    r.start(pose,
            {Vector3d::Zero(), precession * Vector3d::UnitZ() + (spin - precession * 0.6) * axis});
  }
  /// Distance of the axis from where it must be at a time.
  double error(double time) const {
    const Vector3d exact(0.8 * std::cos(precession * time), 0.8 * std::sin(precession * time), 0.6);
    return (r.body.pose(r.motion.q).attitude * Vector3d::UnitZ() - exact).norm();
  }
};

TEST(RigidBody, PrecessesAsAHeavyTopToSecondOrder) {
  std::array<double, 2> errors{};
  for (std::size_t k : {0u, 1u}) {
    HeavyTop top;
    const double momentum = top.r.motion.v[5];
    const int steps = k == 0 ? 200 : 400;
    top.r.advance(steps, 3.0 / steps);
    errors[k] = top.error(3.0);
    // No moment acts about z: a rounding of moments of order 1 in every step.
    EXPECT_NEAR(top.r.motion.v[5], momentum, roundoff(steps, 1.0));
  }
  // The body turns by 0.09 in a coarse step, and terms of next order are the square of it.
  EXPECT_NEAR(observed_order(errors[0], errors[1]), 2.0, 0.01);
  EXPECT_LT(errors[1], 1.0e-3);  // half the square of 0.045
}

TEST(RigidBody, KeepsTheEnergyOfATopForLong) {
  // Kicks and free motions are those of Hamiltonians: no drift over 1e5 steps, where the energy
  // with that of the load, g S33 cos/2 a unit of axis, stays within its oscillation (dt^2).
  HeavyTop top;
  const double start = top.r.run.kinetic(top.r.motion);
  ASSERT_FALSE(top.r.run.begin(top.r.motion, 0.0));
  double early = 0.0, late = 0.0;
  const int steps = 100000;
  const double dt = 0.02;
  for (int k = 0; k < steps; ++k) {
    ASSERT_FALSE(top.r.run.step(top.r.motion, k * dt, dt));
    const double change = std::abs(top.r.run.kinetic(top.r.motion) - start);
    (k < steps / 2 ? early : late) = std::max(k < steps / 2 ? early : late, change);
  }
  // In steady precession the kinetic energy stays; what is left is the rule's nutation, as large in
  // the second half as in the first.
  EXPECT_LT(early, 1.0e-2 * start);
  EXPECT_LT(late, 1.02 * early);
}

TEST(RigidBody, GoesBackWithTime) {
  HeavyTop top;
  const std::vector<double> q = top.r.motion.q, v = top.r.motion.v;
  top.r.advance(100, 0.02);
  EXPECT_GT(largest_difference(top.r.motion.q, q), 0.1);
  for (int k = 0; k < 100; ++k) ASSERT_FALSE(top.r.run.step(top.r.motion, 0.0, -0.02));
  // Two hundred steps that round a few times each.
  EXPECT_LT(largest_difference(top.r.motion.q, q), roundoff(2000.0, 1.0));
  EXPECT_LT(largest_difference(top.r.motion.v, v), roundoff(2000.0, 1.0));
}

TEST(RigidBody, IsSentSpinningByAPressureThatFollowsIt) {
  // A pressure p on one side of a square turns with it: a constant moment p A b/2 about the centre
  // where it acts on half the side only. Here on the right side with p y: moment p/12, u = t^2/2 of
  // it over the inertia, exactly; the centre feels no force.
  Rigid r(square());
  r.add(std::make_unique<Pressure>(
      r.solid.model, "right", [](const std::array<double, 3>& x, double) { return 0.1 * x[1]; },
      true));
  const int steps = 100;
  r.advance(steps, 0.2);
  const double moment = 0.1 / 12.0, inertia = 1.0 / 6.0, time = 0.2 * steps;
  EXPECT_NEAR(r.motion.q[2], 0.5 * moment / inertia * time * time, roundoff(100.0 * steps, 10.0));
  EXPECT_NEAR(r.motion.external_work, 0.5 * moment * moment / inertia * time * time,
              roundoff(100.0 * steps, 0.1));
  EXPECT_NEAR(r.motion.q[0], 0.0, roundoff(100.0 * steps, 1.0));
}

TEST(RigidBody, RefusesAStepOfTooManyTurns) {
  Rigid r(box({1.0, 1.0, 1.0}));
  r.start({}, {Vector3d::Zero(), {0.0, 0.0, 1.0e6}});
  ASSERT_FALSE(r.run.begin(r.motion, 0.0));
  const std::optional<Failed> failed = r.run.step(r.motion, 0.0, 1.0);
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->cause, Failed::Cause::step_too_small);
  EXPECT_NE(failed->detail.find("smaller step"), std::string::npos);
  EXPECT_FALSE(r.run.step(r.motion, 0.0, 1.0e-3));
}

}  // namespace
}  // namespace abut::solids_rigid_tests
