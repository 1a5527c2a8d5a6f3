// Goal: the port line and the port kernel say how a contact force moves a port, exactly.
// Oracles: the reaction to an obstacle, handed back as a force, reproduces the obstacle's motion;
// the reaction is the solution of the kernel's triangular system; wave speeds of closed form.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "base/index.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_ports_tests {
namespace {

constexpr int window_steps = 50;
constexpr double window_length = window_steps * case_step;
constexpr double depth = 0.5;  // [m] of push
/// Sizes in a window: displacements of `depth`; every substep rounds a handful of operations per
/// node, and the wave carries them on.
const double rounding = roundoff(100.0 * window_steps, 1.0);

class PortLine : public testing::TestWithParam<SolverCase> {};
INSTANTIATE_TEST_SUITE_P(Solver, PortLine, testing::ValuesIn(complete_cases()), case_name);

TEST_P(PortLine, ReactionHandedBackAsForceReproducesTheObstacle) {
  const std::unique_ptr<Subdomain> pushed = build(case_bar(GetParam()));
  const std::unique_ptr<Subdomain> forced = build(case_bar(GetParam()));
  const std::vector<double> times = substep_times(0.0, window_length, case_step);
  Advance obstacle = free_request(*pushed, 0.0, window_length);
  for (std::size_t p = 0; p < obstacle.boundary.size(); ++p) {
    meet_point(*pushed, p, true);
    obstacle.boundary[p].obstacles = {
        pushing_surface(*pushed, p, times, p == 0 ? depth : 0.5 * depth)};
  }
  Response answer, reply;
  step(*pushed, obstacle, answer);
  Advance force = free_request(*forced, 0.0, window_length);
  for (std::size_t p = 0; p < force.boundary.size(); ++p) {
    Waveform handed(1);
    handed.support = answer.ports[p].trace.support;
    handed.time = answer.ports[p].trace.time;
    handed.f = answer.ports[p].trace.f;
    force.boundary[p].forces = {handed};
  }
  step(*forced, force, reply);
  for (std::size_t p = 0; p < force.boundary.size(); ++p) {
    EXPECT_LT(
        largest_difference(answer.ports[p].trace.u, obstacle.boundary[p].obstacles[0].motion.u),
        rounding);
    EXPECT_LT(largest_difference(reply.ports[p].trace.u, answer.ports[p].trace.u), rounding);
    EXPECT_GT(largest_size(answer.ports[p].trace.f), 1e-3);  // there was contact to speak of
  }
  EXPECT_NEAR(reply.records[0].energy.total(), answer.records[0].energy.total(), rounding);
}

TEST_P(PortLine, KernelIsTheInverseOfTheReactionToAnObstacle) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam()));
  const std::vector<double> times = substep_times(0.0, window_length, case_step);
  const PortKernel kernel = normal_kernel(*body, 0, case_step, window_steps);
  ASSERT_EQ(kernel.displacement.size(), index(window_steps));
  Advance request = free_request(*body, 0.0, window_length);
  meet_point(*body, 0, true);
  request.boundary[0].obstacles = {pushing_surface(*body, 0, times, depth)};
  Response answer;
  step(*body, request, answer);
  Eigen::VectorXd moved(window_steps), reaction(window_steps);
  Eigen::MatrixXd responses = Eigen::MatrixXd::Zero(window_steps, window_steps);
  for (int i = 0; i < window_steps; ++i) {
    moved[i] = request.boundary[0].obstacles[0].motion.u[index(i) + 1];
    reaction[i] = answer.ports[0].trace.f[index(i) + 1];
    for (int j = 0; j <= i; ++j) responses(i, j) = kernel.displacement[i - j];
  }
  const Eigen::VectorXd expected = responses.triangularView<Eigen::Lower>().solve(moved);
  // Differences of neighbouring displacements are divided by the first compliance; in the
  // implicit cases the triangular system's condition is of the order of the steps.
  const double scale = largest_size(answer.ports[0].trace.f) + depth / kernel.displacement[0];
  EXPECT_LT((expected - reaction).lpNorm<Eigen::Infinity>(), roundoff(100.0 * window_steps, scale));
}

TEST_P(PortLine, KernelLeavesTheStateUntouched) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam(), 0.3));
  Advance request = free_request(*body, 0.0, 3.0);
  request.boundary[0].impulse = {0.01};  // some state
  Response response;
  step(*body, request, response);
  const std::uint64_t before = body->state_hash();
  normal_kernel(*body, 0, case_step, 20);
  EXPECT_EQ(body->state_hash(), before);
  Response first, second;
  body->save();
  step(*body, free_request(*body, 3.0, 9.0), first);
  body->restore();
  normal_kernel(*body, 0, case_step, 20);
  step(*body, free_request(*body, 3.0, 9.0), second);
  EXPECT_EQ(first.ports[0].trace.u, second.ports[0].trace.u);
}

TEST_P(PortLine, KernelDoesNotKnowTheBodyForce) {
  BarText heavy = case_bar(GetParam());
  heavy.body_force = -0.01;
  const PortKernel with = normal_kernel(*build(heavy), 0, case_step, window_steps);
  const PortKernel without =
      normal_kernel(*build(case_bar(GetParam())), 0, case_step, window_steps);
  // both are differences of displacements of up to b t^2 / 2 = 4.5 m
  EXPECT_LT(largest_difference(with.displacement, without.displacement), rounding * 5.0);
  EXPECT_LT(largest_difference(with.begin, without.begin), rounding * 5.0);
}

TEST_P(PortLine, AUnilateralObstacleThatStaysAwayDoesNothing) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam()));
  Advance request = free_request(*body, 0.0, 6.0);
  meet_point(*body, 0, false, 1.0);
  Obstacle& obstacle = request.boundary[0].obstacles.emplace_back();
  obstacle.motion.time = {0.0, 6.0};
  obstacle.motion.u = {0.0, 0.0};
  Response response;
  step(*body, request, response);
  EXPECT_EQ(largest_size(response.ports[0].trace.f), 0.0);
  EXPECT_EQ(largest_size(response.ports[0].trace.u), 0.0);
}

TEST_P(PortLine, ReactionPushesInwards) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam()));
  const double n = outward(*body, 0);
  const double velocity = 0.01 * n;
  BarText moving = case_bar(GetParam(), velocity);
  const std::unique_ptr<Subdomain> flying = build(moving);
  Advance request = free_request(*flying, 0.0, 12.0);
  meet_point(*flying, 0, false);
  Obstacle& obstacle = request.boundary[0].obstacles.emplace_back();
  obstacle.motion.time = {0.0, 12.0};
  obstacle.motion.u = {0.0, 0.0};
  Response response;
  step(*flying, request, response);
  for (double f : response.ports[0].trace.f) EXPECT_LE(f * n, 0.0);
  // Z v for 12 s; the first front and the dispersion of 20 steps leave a few per cent
  EXPECT_NEAR((response.records[0].momentum[0] - 40.0 * velocity) * n, -0.12, 0.12 * 0.1);
}

/// Modulus 200, Poisson's ratio 0.25 and density 3: speeds of sqrt(240 / 3) in the bulk and of
/// sqrt(200 / 3) along a bar.
std::string solid_text(const std::string& model, const std::string& integrator) {
  return fmt::format(
      "bodies:\n  solid:\n    model: {{{}}}\n    material: {{neo_hookean: {{youngs_modulus: 200.0, "
      "poissons_ratio: 0.25, density: 3.0}}}}\n    integrator: {{{}}}\n"
      "    ports: {{end: {{side: right}}}}\n",
      model, integrator);
}

double transit_of(const std::string& text) {
  return make_body(Document::from_text("test", text), "bodies.solid")
      ->describe()
      .ports.at(0)
      .geometry.transit;
}

TEST(PortGeometry, TransitIsTheTimeOfAWaveThroughTheSpacing) {
  const double few = roundoff(10.0, 1.0);
  for (const SolverCase& c : complete_cases(0.5 * case_step)) {
    BarText bar = case_bar(c);
    bar.modulus = 4.0;  // twice as fast as the cases' bar, whose h / c is 1
    const std::unique_ptr<Subdomain> body = build(bar);
    for (const Port& port : body->describe().ports)
      EXPECT_NEAR(port.geometry.transit, 0.5, few) << c.name;
  }
  const std::string newmark = "newmark: {step: 0.1}";
  const std::string along = "{dimension: 1, mesh: {bar: {length: 6.0, elements: 3, area: 1.0}}";
  const std::string bulk =
      "{dimension: 3, mesh: {box: {lengths: [6.0, 2.0, 2.0], elements: [3, 1, 1]}}";
  EXPECT_NEAR(transit_of(solid_text("fe: " + along + "}", newmark)), 2.0 / std::sqrt(200.0 / 3.0),
              few);
  EXPECT_NEAR(transit_of(solid_text("fe: " + bulk + "}", newmark)), 2.0 / std::sqrt(240.0 / 3.0),
              few);
  for (const std::string& mesh : {along, bulk})  // infinitely fast
    EXPECT_EQ(transit_of(solid_text("rigid: " + mesh + "}", "rigid_motion: {step: 0.1}")), 0.0);
  EXPECT_EQ(build_wall(0.5, "left")->describe().ports[0].geometry.transit, 0.0);
}

TEST(RigidWall, TakesAnyForceAndStays) {
  const std::unique_ptr<Subdomain> wall = build_wall(0.5, "left");
  const Description& d = wall->describe();
  EXPECT_TRUE(std::isinf(d.mass));
  EXPECT_FALSE(d.can.obstacle);
  EXPECT_EQ(d.ports[0].geometry.points[0], 0.5);
  EXPECT_EQ(d.ports[0].geometry.normals[0], -1.0);
  Advance request = free_request(*wall, 0.0, 1.0, 4);
  Waveform& force = request.boundary[0].forces.emplace_back();
  force.time = {0.0, 1.0};
  force.f = {3.0, 5.0};
  Response response;
  step(*wall, request, response);
  EXPECT_EQ(response.records.size(), 4u);
  EXPECT_EQ(response.ports[0].upper.size(), 4u);
  EXPECT_EQ(response.ports[0].trace.time.back(), 1.0);
  EXPECT_EQ(response.ports[0].trace.f.back(), 5.0);
  EXPECT_EQ(largest_size(response.ports[0].trace.u), 0.0);
  EXPECT_EQ(largest_size(normal_kernel(*wall, 0, 0.1, 7).displacement), 0.0);
  step(*wall, free_request(*wall, 1.0, 1.0), response);
  EXPECT_EQ(response.steps, 0);
  EXPECT_EQ(response.ports[0].trace.size(), 1u);
}

}  // namespace
}  // namespace abut::solver_ports_tests
