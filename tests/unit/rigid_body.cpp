// Goal: a rigid body keeps the contract of bodies: rewinds, resumes, takes forces on its ports and
// tells what its nodes do. Oracles: equal bits; the motion under a constant force and moment in
// closed form; differences in time; the words of refusals.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "base/yaml_document.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/solid_texts.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::rigid_body_tests {
namespace {

constexpr double begin = 0.0, middle = 0.05, end = 0.1;

/// A box of 2 x 1 x 0.5 m about the origin, 1000 kg, or a square plate of 1 x 1 x 1 m and as heavy.
std::unique_ptr<Subdomain> build_rigid(int dim, const std::string& more, double length = 3.0e-3) {
  return build(SolidText{
      .name = "block",
      .dim = dim,
      .mesh = dim == 3 ? "box: {lengths: [2.0, 1.0, 0.5], elements: [2, 1, 1], origin: centre}"
                       : "rectangle: {lengths: [1.0, 1.0], elements: [2, 2], origin: centre}",
      .material = "linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}",
      .integrator = fmt::format("rigid_motion: {{step: {}}}", length),
      .side = "right",
      .model = "rigid",
      .more = more});
}

const std::string weight = "    body_force: [0.0, 0.0, -9.81]\n";
const std::string spinning =
    "    initial: {velocity: [1.0, 0.0, -2.0], velocity_field: [\"5 * z - 3 * y\", \"3 * x - 4 * "
    "z\", \"4 * y - 5 * x\"]}\n" +
    weight;

/// A constant force [N] on every node of the face.
Advance pushed(const Subdomain& body, double from, double to, std::vector<double> force) {
  Advance request = free_request(body, from, to);
  const Port& port = body.describe().ports[0];
  const std::size_t dim = index(port.geometry.dim);
  Waveform& imposed = request.boundary[0].forces.emplace_back();
  imposed.width = static_cast<int>(port.geometry.points.size());
  imposed.time = {from, to};
  for (std::size_t k = 0; k < 2 * port.geometry.points.size(); ++k)
    imposed.f.push_back(force[k % dim]);
  return request;
}

void step(Subdomain& body, const Advance& request, Response& response) {
  const Outcome outcome = body.advance(request, response);
  if (const Failed* failed = std::get_if<Failed>(&outcome)) FAIL() << failed->detail;
}

TEST(RigidSolid, RewindsAndResumesBitForBit) {
  const std::unique_ptr<Subdomain> body = build_rigid(3, spinning);
  const std::unique_ptr<Subdomain> twin = build_rigid(3, weight);
  Response first, second;
  step(*body, pushed(*body, begin, middle, {1.0e3, 2.0e3, -3.0e3}), first);
  const std::uint64_t saved = body->state_hash();
  body->save();
  const Advance next = pushed(*body, middle, end, {-4.0e3, 0.0, 1.0e3});
  step(*body, next, first);
  const std::uint64_t hash = body->state_hash();
  EXPECT_NE(hash, saved);
  body->restore();
  EXPECT_EQ(body->state_hash(), saved);
  twin->resume(body->checkpoint());
  for (Subdomain* other : {body.get(), twin.get()}) {
    step(*other, next, second);
    EXPECT_EQ(other->state_hash(), hash);
    EXPECT_EQ(second.ports[0].trace.u, first.ports[0].trace.u);
    EXPECT_EQ(second.ports[0].trace.a, first.ports[0].trace.a);
  }
}

/// Largest difference of the traces' displacements and velocities from the trapezoidal rule over
/// their rates.
std::array<double, 2> mismatch(double step_length) {
  const std::unique_ptr<Subdomain> body = build_rigid(3, spinning, step_length);
  Response response;
  step(*body, pushed(*body, begin, end, {1.0e3, 2.0e3, -3.0e3}), response);
  const Waveform& t = response.ports[0].trace;
  const std::size_t width = index(t.width);
  EXPECT_EQ(t.u.size(), t.size() * width);
  std::array<double, 2> most{};
  for (std::size_t k = 0; k + width < t.u.size(); ++k) {
    const double h = t.time[k / width + 1] - t.time[k / width];
    const auto miss = [&](const std::vector<double>& x, const std::vector<double>& rate) {
      return std::abs((x[k + width] - x[k]) / h - 0.5 * (rate[k] + rate[k + width]));
    };
    most[0] = std::max(most[0], miss(t.u, t.v));
    most[1] = std::max(most[1], miss(t.v, t.a));
  }
  return most;
}

TEST(RigidSolid, TellsMotionOfItsPortsThatBelongsTogether) {
  // Both rules are of second order in a step that turns the body by 0.02 rad; what comes next is of
  // relative size (0.02)^2, with factors of ten or more for the fourth derivatives.
  const std::array<double, 2> coarse = mismatch(2.0e-3), fine = mismatch(1.0e-3);
  for (std::size_t k : {0u, 1u}) EXPECT_NEAR(observed_order(coarse[k], fine[k]), 2.0, 0.02) << k;
}

TEST(RigidSolid, TakesTheForceAndMomentOfItsPort) {
  // A plate: three nodes of the right side, 1 N each along y at an arm of 0.5 m: force 3 N,
  // moment 1.5 N m at first, while the side looks to the right.
  const std::unique_ptr<Subdomain> body = build_rigid(2, "");
  Response response;
  const double time = 1.0e-3;  // it turns by 1e-8 rad: the arm stays to 1e-16
  step(*body, pushed(*body, begin, time, {0.0, 1.0}), response);
  const double nodes = 3.0, mass = 1000.0, inertia = mass / 6.0;
  const BodyRecord& record = response.records.back();
  EXPECT_NEAR(record.momentum[1], nodes * time, roundoff(100.0, nodes * time));
  EXPECT_NEAR(record.momentum[0], 0.0, roundoff(100.0, nodes * time));
  ASSERT_EQ(record.angular_momentum.size(), 1u);
  EXPECT_NEAR(record.angular_momentum[0], 0.5 * nodes * time, roundoff(1000.0, nodes * time));
  const double work = 0.5 * time * time * (nodes * nodes / mass + 0.25 * nodes * nodes / inertia);
  // Half of the last kick is not counted yet, a quarter of the energy of the one step: as much less
  // is told as done by loads, and both together are what the port did.
  EXPECT_NEAR(record.energy.kinetic, 0.75 * work, roundoff(1000.0, work));
  EXPECT_NEAR(record.energy.kinetic - record.energy.external_work, work, roundoff(1000.0, work));
  // And what acts is told back.
  EXPECT_EQ(response.ports[0].trace.f, std::vector<double>({0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}));
}

/// A force that grows from nothing over the step turns its velocity at the end, and has not moved
/// it: it has no energy of that, and no load has worked.
TEST(RigidSolid, HasNoEnergyOfAKickThatHasNotMovedIt) {
  for (const int dim : {2, 3}) {
    const std::unique_ptr<Subdomain> body = build_rigid(dim, "");
    Response response;
    Advance request = pushed(*body, begin, 1.0e-3, {3.0, 1.0, -2.0});
    std::vector<double>& forces = request.boundary[0].forces[0].f;
    std::fill_n(forces.begin(), forces.size() / 2, 0.0);
    step(*body, request, response);
    const BodyRecord& record = response.records.back();
    const double impulse = record.momentum[1], scale = impulse * impulse / body->describe().mass;
    EXPECT_GT(impulse, 0.0);
    EXPECT_NEAR(record.energy.kinetic, 0.0, roundoff(1000.0, 100.0 * scale)) << dim;
    EXPECT_NEAR(record.energy.external_work, 0.0, roundoff(1000.0, 100.0 * scale)) << dim;
  }
}

TEST(RigidSolid, DescribesItself) {
  const std::unique_ptr<Subdomain> body = build_rigid(3, "");
  const Description& d = body->describe();
  EXPECT_EQ(d.model, "rigid, 2 hex8, exact free motion, step 0.003 s");
  EXPECT_EQ(d.dofs, 6);
  EXPECT_EQ(build_rigid(2, "")->describe().dofs, 3);
  EXPECT_NEAR(d.mass, 1000.0, roundoff(10.0, 1000.0));
  EXPECT_TRUE(std::isinf(d.stable_step));
  EXPECT_TRUE(d.can.force);
  EXPECT_FALSE(d.can.motion || d.can.obstacle);
  for (const std::string& measure : d.measures) {
    EXPECT_EQ(measure.find("stress"), std::string::npos) << measure;
    EXPECT_EQ(measure.find("mises"), std::string::npos) << measure;
  }
  EXPECT_EQ(body->measure().size(), d.measures.size());
}

TEST(RigidSolid, StartsFromAnyTurn) {
  // A quarter turn about z, then a spin about x: fields are of the reference position.
  const std::unique_ptr<Subdomain> body = build_rigid(
      3,
      "    initial: {displacement_field: [\"-y - x\", \"x - y\", \"0\"], velocity_field: [\"0\", "
      "\"-2 * z\", \"2 * x\"]}\n");
  Response response;
  step(*body, free_request(*body, 0.0, 0.0), response);
  // Turned, the box is 1 x 2 x 0.5 m: inertia m (2^2 + 0.5^2)/12 about x.
  EXPECT_NEAR(response.records[0].angular_momentum[0], 1000.0 * 4.25 / 12.0 * 2.0,
              roundoff(1000.0, 1000.0));
}

TEST(RigidSolid, RefusesWhatItIsNot) {
  const auto told = [](int dim, const std::string& more) {
    return refusal([&] { build_rigid(dim, more); });
  };
  const std::string stretched =
      told(3, "    initial: {displacement_field: [\"1.0e-6 * x\", \"0\", \"0\"]}\n");
  EXPECT_NE(stretched.find("bodies.block.initial.displacement_field"), std::string::npos);
  EXPECT_NE(stretched.find("is no rigid motion"), std::string::npos) << stretched;
  // Mirrored in the plane: no turn of space may help.
  EXPECT_NE(told(2, "    initial: {displacement_field: [\"-2 * x\", \"0\"]}\n").find("no rigid"),
            std::string::npos);
  EXPECT_NE(told(2, "    supports: {left: fixed}\n").find("supports"), std::string::npos);
}

}  // namespace
}  // namespace abut::rigid_body_tests
