// Goal: a body that takes forces and answers for its port kernel, by the model of solids, meets a
// bar of the bars' own core as another such bar does.
// Oracles: the closed form of the impact; momentum; the kernel as the map from forces to motion.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::rungs_in_contact_tests {
namespace {

/// One window of forces on the left end of a bar that is fixed on the right.
class KernelOfASolid : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Schemes, KernelOfASolid,
                         testing::Values(explicit_scheme(0.6), implicit_scheme("newmark", 0.6),
                                         implicit_scheme("hht_alpha", 0.6),
                                         implicit_scheme("generalized_alpha", 0.6)));

BarText small_bar(const std::string& integrator) {
  BarText bar = unit_bar("bar", 20.0, 20, integrator);
  bar.sides = {"left"};
  bar.fixed = "right";
  bar.solid = true;
  return bar;
}

constexpr int steps = 40;
const std::vector<double> push = {1.0};  // along x

TEST_P(KernelOfASolid, TellsWhatForcesDo) {
  const std::unique_ptr<Subdomain> body = build(small_bar(GetParam()));
  ASSERT_TRUE(body->describe().can.kernel);
  const PortKernel kernel = body->probe({0, push, 0.6, steps});
  Advance request = free_request(*body, 0.0, steps * 0.6);
  Waveform& force = request.boundary[0].forces.emplace_back();
  for (int i = 0; i <= steps; ++i) {
    force.time.push_back(i == steps ? steps * 0.6 : i * 0.6);
    force.f.push_back(std::sin(0.7 * i) - 0.3);
  }
  Response response;
  ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
  for (int i = 1; i <= steps; ++i) {
    double u = kernel.begin[i - 1] * force.f[0];
    for (int j = 1; j <= i; ++j) u += kernel.displacement[i - j] * force.f[j];
    // sums of 40 products, each from a chain of 40 steps
    EXPECT_NEAR(response.ports[0].trace.u[i], u, roundoff(100.0 * steps, 10.0));
  }
}

TEST_P(KernelOfASolid, LeavesTheStateAndWhatFollowsUntouched) {
  BarText text = small_bar(GetParam());
  text.velocity = 0.3;
  text.body_force = 0.01;
  const std::unique_ptr<Subdomain> body = build(text);
  Response first, second;
  ASSERT_TRUE(
      std::holds_alternative<Advanced>(body->advance(free_request(*body, 0.0, 6.0), first)));
  body->save();
  const std::uint64_t hash = body->state_hash();
  const PortKernel kernel = body->probe({0, push, 0.6, steps});
  EXPECT_EQ(body->state_hash(), hash);
  ASSERT_TRUE(
      std::holds_alternative<Advanced>(body->advance(free_request(*body, 6.0, 12.0), first)));
  body->restore();
  ASSERT_TRUE(
      std::holds_alternative<Advanced>(body->advance(free_request(*body, 6.0, 12.0), second)));
  EXPECT_EQ(first.ports[0].trace.u, second.ports[0].trace.u);
  // Nothing of velocity and weight is in it.
  EXPECT_EQ(kernel.displacement,
            build(small_bar(GetParam()))->probe({0, push, 0.6, steps}).displacement);
}

// Of schemes with gamma = 1/2: others take steps' ends by unequal weights.
class ImpulseOnASolid : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Schemes, ImpulseOnASolid,
                         testing::Values(explicit_scheme(0.6), implicit_scheme("newmark", 0.6)));

TEST_P(ImpulseOnASolid, IsThatOfTheForcesOfAllWindows) {
  // Two windows under force, of steps of their own, and one without.
  BarText text = small_bar(GetParam());
  text.fixed.clear();
  const std::unique_ptr<Subdomain> body = build(text);
  Response response;
  double impulse = 0.0, time = 0.0;
  for (const double size : {0.1, 0.04, 0.0}) {  // strains stay below 1
    Advance request = free_request(*body, time, time + 6.0);
    Waveform& force = request.boundary[0].forces.emplace_back();
    for (int i = 0; i <= 7 && size > 0.0; ++i) {
      force.time.push_back(time + i * 6.0 / 7.0);
      force.f.push_back(size * (1.0 + 0.1 * i * i));
    }
    if (size > 0.0) {
      double part = 0.0;
      force.impulse(time, time + 6.0, {&part, 1});
      impulse += part;
    }
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
    time += 6.0;
  }
  EXPECT_NEAR(response.records[0].momentum[0], impulse, roundoff(1000.0, impulse));
  // Work on the port is the partner's to tell. Implicit steps have it among the work of inertia
  // and stress, from which it is taken again: round-off of 30 solves, each of the energy there is,
  // in an order of sums that is the factorisation's own.
  const Energy& energy = response.records[0].energy;
  EXPECT_GT(energy.total(), 0.1);
  EXPECT_NEAR(energy.external_work, 0.0, roundoff(30.0, energy.total()));
}

/// Two bars; the first by the model of solids, or by the bars' own core.
SceneText solid_and_bar(const std::string& first, const std::string& second, bool solid) {
  SceneText scene = two_bars();
  scene.closed_form = false;
  scene.bars[0].solid = solid;
  scene.bars[0].integrator = first;
  scene.bars[1].integrator = second;
  scene.bars[0].layer = "massless: {stiffness_factor: 1.0}";  // as that of solids
  scene.bars[1].layer = "massless: {}";
  return scene;
}

/// Of the duration of contact, 2 L/c; its number of contacts beside it.
std::pair<double, std::size_t> release_error(const RunResult& r) {
  const std::vector<double> closed = r.times(RunEvent::Kind::contact_closed, "first");
  const std::vector<double> opened = r.times(RunEvent::Kind::contact_opened, "first");
  EXPECT_EQ(closed.size(), opened.size());
  return {std::abs((opened.back() - closed.front()) / 5.0e-4 - 1.0), closed.size()};
}

TEST(SolidAndBar, CollideAsTwoBars) {
  const std::string fine = explicit_scheme(1.0e-7, 6);
  for (const std::string& first :
       {explicit_scheme(1.0e-7), implicit_scheme("newmark", 1.0e-6), explicit_scheme(5.0e-7)}) {
    const ResultPtr r = run(solid_and_bar(first, fine, true));
    const ResultPtr cores = run(solid_and_bar(first, fine, false));
    ASSERT_TRUE(r->completed() && cores->completed()) << first;
    const auto [error, contacts] = release_error(*r);
    EXPECT_EQ(contacts, 1u) << first;
    // The bars' own core, whose contact element has the stiffness of the mesh, moves alike but for
    // the impulses that pay back what events take: measured 1.3e-5 to 7.2e-5 of the duration.
    EXPECT_NEAR(error, release_error(*cores).first, 1.0e-4) << first;
    EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0) << first;
    // Impulses are equal and opposite, whatever the steps: round-off of 10000 of them.
    EXPECT_LT(r->momentum_error(), roundoff(1000.0, 1.0)) << first;
    // Central differences hold another energy than that of their nodes, by (w dt)^2/8 of what
    // vibrates; two bars of the core lose 5e-4 with these steps.
    EXPECT_LT(std::abs(r->energy_error()), 5.0e-4) << first;
    // Published for plain elements: 0.5 % of the velocity is left in vibration.
    EXPECT_NEAR(r->velocity(0), -100.0, 1.0) << first;
    EXPECT_NEAR(r->velocity(1), 100.0, 1.0) << first;
  }
}

/// Places of the second bar's end before contact ends, at the ends of windows; the first bar is in
/// modes. 0: by the model of solids.
std::vector<double> places(int modes) {
  SceneText scene = solid_and_bar(explicit_scheme(1.0e-7), explicit_scheme(1.0e-7, 6), true);
  scene.bars[1].position += 5.0e-6;  // so that no rounding decides in which step they touch
  std::string text = scene.text();
  if (modes > 0) {
    const std::size_t at = text.find("fe: {"), end = text.find("}}", at);
    text.insert(end + 2, fmt::format(", modes: {}", modes));
    text.replace(at, 2, "modal");
  }
  const ResultPtr r = run_text(text);
  EXPECT_TRUE(r->completed()) << modes;
  EXPECT_LT(r->momentum_error(), roundoff(10'000.0, 1.0)) << modes;
  std::vector<double> out;
  for (const RunResult::Row& row : r->rows) {
    if (row.time < 4.9e-4) out.push_back(row.u[1]);
  }
  return out;
}

TEST(ModalBar, TendsToTheBarWithItsModes) {
  // 200 elements: the end's shape and 200 modes with a fixed end are all there is. They are the
  // elements' motion to round-off (tests/verification/solids_modal.cpp), with the mass of the end
  // node: without it the front comes sooner, by less than it takes to cross a cell.
  const std::vector<double> whole = places(200);
  EXPECT_LT(largest_difference(places(0), whole), 100.0 * 0.25 / 200 / 1000.0);
  // Without the upper modes the front is as wide as the shortest wave kept, 2 L/modes, and the port
  // moves on at its own speed of 100 m/s before: by less than that width over c.
  double before = HUGE_VAL;
  for (const int modes : {80, 120, 160}) {
    const double off = largest_difference(places(modes), whole);
    EXPECT_LT(off, 100.0 * 2.0 * 0.25 / modes / 1000.0) << modes;
    EXPECT_LT(off, before) << modes;
    before = off;
  }
}

/// A rigid block of 2e-4 kg that meets a long bar of impedance 1 kg/s at 100 m/s, at time 0.
ResultPtr block_and_bar(const std::string& integrator, const std::string& step) {
  BarText bar{.name = "bar",
              .length = 0.5,
              .elements = 400,
              .integrator = integrator,
              .layer = "massless: {}",
              .position = 0.01,
              .velocity = 0.0,
              .sides = {"left"}};
  SolidText block{.name = "block",
                  .dim = 1,
                  .mesh = "bar: {length: 0.2, elements: 1, area: 1.0e-6}",
                  .material = bar_law(bar.modulus, bar.density),
                  .integrator = fmt::format("rigid_motion: {{step: {}}}", step),
                  .position = {-0.2},
                  .velocity = {100.0},
                  .model = "rigid",
                  .sides = {"right"}};
  std::string scene = scene_text(9.0e-4, 1.0e-5, block.text() + bar.text(),
                                 "interfaces:\n" + touching("first", "block.right", "bar.left"));
  scene.replace(scene.find("begin: 0.0"), 10, "begin: -1.0e-4");
  return run_text(scene);
}

TEST(RigidBlock, IsSlowedByABarAsByADashpot) {
  // Until the front returns from the bar's free end at 2 L/c = 1e-3 s: m v' = -Z v.
  for (const auto& [integrator, step] : {std::pair(explicit_scheme(1.0e-7, 6), "1.0e-7"),
                                         {explicit_scheme(1.0e-7, 6), "1.0e-6"},
                                         {implicit_scheme("newmark", 1.0e-7), "1.0e-7"}}) {
    const ResultPtr r = block_and_bar(integrator, step);
    ASSERT_TRUE(r->completed()) << integrator;
    double most = 0.0;
    for (const RunResult::Row& row : r->rows) {
      const double exact = 100.0 * std::exp(-std::max(0.0, row.time) / 2.0e-4);
      most = std::max(most, std::abs(row.momentum[0] / 2.0e-4 - exact));
    }
    // A bar of cells begins to push over its first one: (m v0/Z) changes by half a cell's mass,
    // 6.25e-7 kg of 2e-4, so v by 0.16 m/s and less as it falls. The first push is that of a level
    // of time, 100 N on one side of it: half a step of it, 0.25 m/s with the step of 1e-6 s.
    EXPECT_LT(most, 0.16 + 0.5 * std::stod(step) * 100.0 / 2.0e-4) << integrator << " " << step;
    EXPECT_LT(r->momentum_error(), roundoff(10'000.0, 1.0)) << integrator << " " << step;
    EXPECT_LT(std::abs(r->energy_error()), iteration(1.0e-6)) << integrator << " " << step;
    EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0) << integrator << " " << step;
  }
}

}  // namespace
}  // namespace abut::rungs_in_contact_tests
