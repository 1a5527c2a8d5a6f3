// Goal: contact closes, opens, and is ruled out where geometry and forces say so; roles and islands
// follow from what the bodies are. Oracles: hand-made traces and bodies.

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/horizon.hpp"
#include "coordinator/coupling/roles.hpp"
#include "coordinator/coupling/islands.hpp"
#include "coordinator/coupling/transmission.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace abut {
namespace {

/// A body whose reply is written down beforehand.
class Scripted : public Subdomain {
 public:
  Scripted(double place, double normal, double step, int ports = 1) {
    description_.step = step;
    description_.mass = 1.0;
    for (int p = 0; p < ports; ++p) {
      Port port;
      port.geometry.points = {place + p};
      port.geometry.normals = {p == 0 ? normal : -normal};
      description_.ports.push_back(port);
    }
    reply.ports.resize(index(ports));
  }
  /// u at the times of a window and, if any, forces.
  void trace(std::vector<double> time, std::vector<double> u, std::vector<double> f = {}) {
    Waveform& w = reply.ports[0].trace;
    w.time = std::move(time);
    w.u = std::move(u);
    w.f = std::move(f);
  }
  const Description& describe() const override { return description_; }
  void save() override {}
  void restore() override {}
  void start(const Advance&) override {}
  [[nodiscard]] Outcome finish(Response& response) override {
    response = reply;
    return Advanced{};
  }
  void meet(int, const PortGeometry&, const ContactLaw&) override {}
  void yields(int, int, const PortKernel&) override {}
  PortKernel probe(int, std::span<const double> patterns, double step, int count) override {
    PortKernel kernel;
    kernel.width = static_cast<int>(patterns.size());
    kernel.step = step;
    kernel.displacement.assign(index(count), patterns[0] * compliance);
    return kernel;
  }
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte>) override {}
  std::uint64_t state_hash() override { return 0; }

  Response reply;
  double compliance = 0.0;  // [m/N]

  Description description_;
};

/// Two scripted bodies, the left one looking right, 1 m apart.
struct Meeting {
  Scripted left, right;
  Bodies bodies;
  Joint joint;

  explicit Meeting(double left_step = 1.0, double right_step = 1.0)
      : left(-1.0, 1.0, left_step), right(0.0, -1.0, right_step), bodies({&left, &right}) {
    joint = make_joint("meeting", {Side{0, 0}, Side{1, 0}}, bodies);
  }
  void reply() { EXPECT_FALSE(bodies.advance_all()); }
};

TEST(Joints, KnowsItsGapAndOffsets) {
  const Meeting m;
  EXPECT_EQ(m.joint.reference_gap, 1.0);
  EXPECT_EQ(m.joint.gap(0.25, -0.25), 0.5);
  EXPECT_EQ(m.joint.offset(0), 1.0);
  EXPECT_EQ(m.joint.offset(1), -1.0);
}

TEST(Joints, RefusesPortsThatLookTheSameWay) {
  Scripted a(0.0, 1.0, 1.0), b(1.0, 1.0, 1.0);
  const Bodies bodies({&a, &b});
  EXPECT_THROW(make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies), InputError);
}

TEST(Joints, RefusesSidesThatOverlapAtTheStart) {
  Scripted a(0.5, 1.0, 1.0), b(0.0, -1.0, 1.0);
  const Bodies bodies({&a, &b});
  try {
    make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies);
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("0.5"), std::string::npos) << error.what();
  }
}

TEST(FirstOverlap, LocatesTheTouchOnTheFinerSide) {
  Meeting m;
  m.left.trace({0, 1, 2, 3, 4}, {0.0, 0.25, 0.5, 0.75, 1.0});
  m.right.trace({0, 4}, {0.0, -1.0});  // closing at 0.5 m/s: the gap of 1 m is gone at 2
  m.reply();
  const std::optional<Touch> touch = first_overlap(m.joint, m.bodies, 0.0);
  ASSERT_TRUE(touch);
  EXPECT_EQ(touch->time, 2.0);
  EXPECT_EQ(touch->speed, 0.5);
  EXPECT_EQ(touch->state, 3.0);  // the first substep that overlaps ends there
}

TEST(FirstOverlap, InterpolatesWithinASubstep) {
  Meeting m;
  m.left.trace({0, 1, 2}, {0.0, 0.8, 1.6});
  m.right.trace({0, 2}, {0.0, 0.0});
  m.reply();
  const std::optional<Touch> touch = first_overlap(m.joint, m.bodies, 0.0);
  ASSERT_TRUE(touch);
  EXPECT_NEAR(touch->time, 1.25, roundoff(8, 2.0));
  EXPECT_NEAR(touch->speed, 0.8, roundoff(8, 2.0));
}

TEST(FirstOverlap, SidesThatOnlyMeetAreNotApartAndDoNotOverlap) {
  Meeting m;
  m.left.trace({0, 1}, {0.0, 1.0});
  m.right.trace({0, 1}, {0.0, 0.0});
  m.reply();
  EXPECT_FALSE(first_overlap(m.joint, m.bodies, 0.0));
}

TEST(FirstOverlap, WhatIsNegligibleIsNone) {
  Meeting m;
  m.left.trace({0, 1}, {0.0, 1.0 + 1e-13});  // numerical forerunners
  m.right.trace({0, 1}, {0.0, 0.0});
  m.reply();
  EXPECT_TRUE(first_overlap(m.joint, m.bodies, 0.0));
  EXPECT_FALSE(first_overlap(m.joint, m.bodies, 1e-12));
}

TEST(FirstOverlap, AnOverlapThatGetsSmallerIsARelease) {
  Meeting m;
  m.left.trace({0, 1, 2}, {1.01, 1.005, 0.99});
  m.right.trace({0, 2}, {0.0, 0.0});
  m.reply();
  EXPECT_FALSE(first_overlap(m.joint, m.bodies, 0.0));
}

/// What the interface of two scripted bodies shows. Both give way by half a metre per newton.
ContactHistory history(Meeting& m) {
  m.left.compliance = m.right.compliance = 0.5;
  m.reply();
  ContactHistory h;
  h.read(m.joint, m.bodies);
  return h;
}

TEST(ContactHistory, ReadsForcesAndGapsAtTheSubsteps) {
  Meeting m;
  m.left.trace({0, 1, 2}, {0.5, 1.0, 0.75}, {0, -3, 0});  // pushed to the left
  m.right.trace({0, 1, 2}, {0, 0, 0.25});
  const ContactHistory h = history(m);
  ASSERT_EQ(h.size(), 3u);
  EXPECT_EQ(h[0].gap, 0.5);
  EXPECT_EQ(h[1].force, 3.0);
  EXPECT_EQ(h[1].gap, 0.0);
  EXPECT_EQ(h[2].gap, 0.5);
  EXPECT_EQ(h.peak(), 3.0);
}

TEST(ContactHistory, EventsAreWhereGapAndForceOfTheFreeAndTheHeldSidesCrossZero) {
  Meeting m;
  m.left.trace({0, 1, 2}, {0.5, 1.0, 0.75}, {0, -3, 0});
  m.right.trace({0, 1, 2}, {0, 0, 0.25});
  const ContactHistory h = history(m);
  // Free, the sides would overlap by 3 N x 1 m/N at 1: a gap of 0.5 m is gone after a seventh.
  EXPECT_NEAR(h.touch(1).time, 0.5 / 3.5, roundoff(8, 1.0));
  EXPECT_NEAR(h.touch(1).speed, 3.5, roundoff(8, 3.5));
  // Held, they would be pulled by 0.5 N at 2: the force of 3 N is gone after six sevenths.
  EXPECT_NEAR(h.release(2), 1.0 + 3.0 / 3.5, roundoff(8, 2.0));
}

TEST(ContactHistory, KnowsTheEnergyOfEventsFromGapsAndForcesAlone) {
  // Goal: [M.25]. Oracle: a spring of 1 N/m that a surface loads, its energy and the work on it.
  Meeting m;
  m.left.trace({0, 1, 2, 3}, {0.5, 1.0, 1.0, 0.75}, {0, -3, -2, 0});
  m.right.trace({0, 1, 2, 3}, {0, 0, 0, 0.25});
  const ContactHistory h = history(m);
  EXPECT_EQ(h.energy(1), -0.5 * 3.0 * 0.5);  // closing takes
  EXPECT_EQ(h.energy(2), 0.0);               // closed, contact does no work
  EXPECT_EQ(h.energy(3), 0.5 * 2.0 * 0.5);   // opening gives
}

TEST(ContactHistory, AForceOfKicksActsAtTheBeginOfItsSubstep) {
  Meeting m;
  m.left.reply.ports[0].trace.support = ForceSupport::step;
  m.left.trace({0, 1, 2, 3}, {1, 1, 1, 0}, {0, -3, -3, 0});
  m.right.trace({0, 1, 2, 3}, {0, 0, 0, 0});
  const ContactHistory h = history(m);
  EXPECT_TRUE(h.kicks());
  EXPECT_EQ(h.release(3), 1.0 + 3.0 / 4.0);  // 3 N act at 1, held sides would be pulled by 1 N at 2
}

TEST(ContactHistory, JudgesTheMeansOverTheCoarserSide) {
  Meeting m(0.5, 2.0);  // a hole in the force of the finer, kinematic side is none of the coarser
  m.left.trace({0, .5, 1, 1.5, 2, 2.5, 3, 3.5, 4}, {1, 1, 1, 1, 1, 1, 1, 1, 1},
               {-4, -4, 0, -4, -4, -4, -4, -4, -4});
  m.right.trace({0, 2, 4}, {0, 0, 0});
  ContactHistory h = history(m);
  ASSERT_EQ(h.size(), 3u);
  EXPECT_GT(h[1].force, 0.0);
  EXPECT_GT(h[2].force, 0.0);
  m.left.trace({0, .5, 1, 1.5, 2, 2.5, 3, 3.5, 4}, {1, 1, 1, 1, 1, .75, .5, .25, 0},
               {-4, -4, -4, -4, -1, 0, 0, 0, 0});
  h = history(m);
  EXPECT_EQ(h[2].force, 0.0);
  // located on the finer side: 1 N at 2, a pull of 0.25 N at 2.5
  EXPECT_NEAR(h.release(2), 2.0 + 0.5 * 0.8, roundoff(8, 4.0));
}

TEST(PayingImpulse, GivesExactlyWhatIsOwed) {
  // Goal: [M.26]. Oracle: the energy of two masses before and after the impulse.
  for (double debt : {0.3, -0.3, 1e-9}) {
    for (double approach : {2.0, -2.0}) {
      Meeting m;
      m.left.reply.ports[0].recoil = Recoil{approach, 1.0 / 2.0};
      m.right.reply.ports[0].recoil = Recoil{0.0, 1.0 / 3.0};
      m.reply();
      m.joint.debt = debt;
      const double j = paying_impulse(m.joint, m.bodies);
      const auto energy = [](double mass, double v) { return 0.5 * mass * v * v; };
      const double left = approach - j / 2.0, right = -j / 3.0;
      EXPECT_NEAR(energy(2.0, left) + energy(3.0, right) - energy(2.0, approach), debt,
                  roundoff(16, 4.0));
      EXPECT_LT(std::abs(j), 2.0);  // the smaller root
    }
  }
}

TEST(PayingImpulse, TakesBackNoMoreThanThereIsAndWaitsWhereItWouldStirUpMore) {
  Meeting m;
  m.left.reply.ports[0].recoil = Recoil{2.0, 0.5};
  m.right.reply.ports[0].recoil = Recoil{};  // a wall
  m.reply();
  m.joint.debt = -100.0;
  EXPECT_EQ(paying_impulse(m.joint, m.bodies), 4.0);  // stops it: 4 J of the 100
  m.joint.debt = 100.0;
  EXPECT_EQ(paying_impulse(m.joint, m.bodies), 0.0);
}

TEST(ReleaseImpulse, GivesBackAllThatContactTook) {
  Meeting m;
  m.left.reply.ports[0].recoil = Recoil{0.5, 0.5};
  m.right.reply.ports[0].recoil = Recoil{};
  m.reply();
  m.joint.debt = 2.0;
  const double j = release_impulse(m.joint, m.bodies);
  EXPECT_NEAR(0.5 * 2.0 * std::pow(0.5 - j / 2.0, 2) - 0.5 * 2.0 * 0.25, 2.0, roundoff(16, 2.0));
  EXPECT_GT(j, 0.0);  // apart
}

TEST(Horizon, IsTheGapOverTheBoundOfTheClosingSpeedAndAMargin) {
  Meeting m;
  m.left.trace({0.0}, {0.2});
  m.right.trace({0.0}, {-0.3});
  m.left.reply.ports[0].speed_bound = 2.0;
  m.right.reply.ports[0].speed_bound = 3.0;
  m.reply();
  const double horizon = free_flight_horizon({&m.joint, 1}, m.bodies);
  EXPECT_LE(horizon, 0.5 / 5.0);  // never later than the touch
  EXPECT_GE(horizon, 0.9 * 0.5 / 5.0);
}

TEST(Horizon, CountsTheAccelerationOfBodyForces) {
  Meeting m;
  m.left.trace({0.0}, {0.0});
  m.right.trace({0.0}, {0.0});
  m.left.reply.ports[0].acceleration_bound = 2.0;
  m.reply();
  const double horizon = free_flight_horizon({&m.joint, 1}, m.bodies);
  EXPECT_LE(horizon, 1.0);  // 1 m at 2 m/s^2 from rest
  EXPECT_GE(horizon, 0.9);
  m.left.reply.ports[0].speed_bound =
      -1.0;  // moving apart first: back after 1 s, there at 1.618
  m.reply();
  const double later = free_flight_horizon({&m.joint, 1}, m.bodies);
  EXPECT_GT(later, 1.0);
  EXPECT_LE(later, 0.5 * (1.0 + std::sqrt(5.0)));
}

TEST(Horizon, IsEndlessForBodiesThatPartAndNothingForContact) {
  Meeting m;
  m.left.trace({0.0}, {0.0});
  m.right.trace({0.0}, {0.0});
  m.left.reply.ports[0].speed_bound = -1.0;
  m.reply();
  EXPECT_TRUE(std::isinf(free_flight_horizon({&m.joint, 1}, m.bodies)));
  m.joint.engage(1.0);
  EXPECT_EQ(free_flight_horizon({&m.joint, 1}, m.bodies), 0.0);
  m.joint.disengage();
  m.left.trace({0.0}, {1.0});
  m.reply();
  EXPECT_EQ(free_flight_horizon({&m.joint, 1}, m.bodies), 0.0);
}

TEST(Horizon, SweptBoxesThatMeetInAnyPartAreSeen) {
  Meeting m;
  m.left.reply.ports[0].lower = {-1.0, -1.0};
  m.left.reply.ports[0].upper = {-0.6, -0.1};
  m.right.reply.ports[0].lower = {-0.5, -0.05};
  m.right.reply.ports[0].upper = {0.0, 0.0};
  m.reply();
  EXPECT_TRUE(stayed_apart({&m.joint, 1}, m.bodies));
  m.left.reply.ports[0].upper = {-0.5, -0.1};  // in the first part
  m.reply();
  EXPECT_FALSE(stayed_apart({&m.joint, 1}, m.bodies));
}

int kinematic_of(const BarText& left, const BarText& right) {
  const std::unique_ptr<Subdomain> a = build(left), b = build(right);
  Bodies bodies({a.get(), b.get()});
  Joint joint = make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies);
  joint.how = std::make_unique<Unilateral>();
  choose_roles({&joint, 1}, bodies, 1e-5, false);
  return joint.kinematic;
}

BarText right_bar() {
  BarText bar;
  bar.name = "right";
  bar.position = 0.02;
  bar.sides = {"left"};
  return bar;
}

TEST(Roles, TheSofterSideIsKinematic) {
  BarText soft = right_bar();
  soft.modulus = 1e8;
  soft.density = 100.0;
  EXPECT_EQ(kinematic_of(BarText(), soft), 1);
  BarText hard = right_bar();
  hard.modulus = 1e10;
  hard.density = 1e4;
  EXPECT_EQ(kinematic_of(BarText(), hard), 0);
}

TEST(Roles, AmongEqualsTheFinerMeshThenTheFinerStepThenTheFirst) {
  EXPECT_EQ(kinematic_of(BarText(), right_bar()), 0);
  BarText finer = right_bar();
  finer.elements = 250;
  EXPECT_EQ(kinematic_of(BarText(), finer), 1);
  BarText quicker = right_bar();
  quicker.integrator = explicit_scheme(5e-8, 6);
  EXPECT_EQ(kinematic_of(BarText(), quicker), 1);
}

TEST(Roles, TheContactSpringLowersTheStableStepOfAMassiveNode) {
  // Half a cell's mass between two springs k, the node beside it the same: 2 / w = h / c alone, and
  // w^2 = (2 k + k) / (m / 2) with the partner's spring.
  BarText soft, graded = right_bar();
  soft.layer = "massless: {stiffness_factor: 1.0}";
  soft.integrator = explicit_scheme(1.0e-7);  // without dispersion terms its spring is k
  graded.solid = true;
  graded.layer = "massless: {}";
  graded.integrator = explicit_scheme(1.0e-6);
  const std::unique_ptr<Subdomain> a = build(soft), b = build(graded);
  Bodies bodies({a.get(), b.get()});
  Joint joint = make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies);
  joint.kinematic = 0;
  const double alone = bodies.describe(1).stable_step;
  EXPECT_NEAR(stable_step_in_contact(joint, bodies, 1.0e-5) / alone, std::sqrt(4.0 / 6.0),
              1.0e-3);  // the bound of solids is sharp to 1e-4
  const std::unique_ptr<Subdomain> core = build(right_bar());
  Bodies cores({a.get(), core.get()});
  EXPECT_TRUE(std::isinf(stable_step_in_contact(joint, cores, 1.0e-5)));  // massless as well
}

TEST(Roles, AWallNeverIsKinematic) {
  const std::unique_ptr<Subdomain> wall = build_wall(0.0, "left");
  const std::unique_ptr<Subdomain> bar = build(BarText());
  for (bool wall_first : {true, false}) {
    Bodies bodies(wall_first ? std::vector<Subdomain*>{wall.get(), bar.get()}
                             : std::vector<Subdomain*>{bar.get(), wall.get()});
    Joint joint = make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies);
    joint.how = std::make_unique<Unilateral>();
    choose_roles({&joint, 1}, bodies, 1e-5, false);
    EXPECT_EQ(joint.kinematic, wall_first ? 1 : 0);
  }
}

TEST(Roles, TheForceOfTheParallelFormLivesOnTheLongerSteps) {
  EXPECT_EQ(coarser_side(Meeting(1.0, 2.0).joint, Meeting(1.0, 2.0).bodies), 1);
  EXPECT_EQ(coarser_side(Meeting(2.0, 1.0).joint, Meeting(2.0, 1.0).bodies), 0);
}

/// Bodies with closed joints between pairs of them.
std::vector<Joint> joined(const std::vector<std::array<int, 2>>& pairs, bool ordered = true) {
  std::vector<Joint> joints(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    joints[i].sides = {Side{pairs[i][0], 0}, Side{pairs[i][1], 0}};
    joints[i].engage(1.0);
    if (ordered) {
      joints[i].how = std::make_unique<Unilateral>();
    } else {
      joints[i].how = std::make_unique<ParallelForce>();
    }
  }
  return joints;
}

TEST(Islands, AreTheBodiesThatClosedJointsJoin) {
  std::vector<Joint> joints = joined({{0, 1}, {1, 2}, {3, 4}});
  std::vector<Island> islands = find_islands(joints, 6);
  ASSERT_EQ(islands.size(), 2u);
  EXPECT_EQ(islands[0].joints, (std::vector<int>{0, 1}));
  EXPECT_EQ(islands[1].joints, (std::vector<int>{2}));
  joints[1].disengage();
  islands = find_islands(joints, 6);
  ASSERT_EQ(islands.size(), 2u);
  EXPECT_EQ(islands[0].joints, (std::vector<int>{0}));
  for (Joint& joint : joints) joint.disengage();
  EXPECT_TRUE(find_islands(joints, 6).empty());
}

TEST(Islands, KinematicBodiesAdvanceBeforeThoseThatTakeTheirReactions) {
  std::vector<Joint> joints = joined({{0, 1}, {1, 2}});  // 0 is kinematic to 1, 1 to 2
  const std::vector<std::vector<int>> chain = {{0}, {1}, {2}};
  EXPECT_EQ(find_islands(joints, 3)[0].levels, chain);
  joints[0].kinematic = 1;  // the middle one is kinematic to both
  const std::vector<std::vector<int>> middle = {{1}, {0, 2}};
  EXPECT_EQ(find_islands(joints, 3)[0].levels, middle);
  joints[0].kinematic = 0;
  joints[1].kinematic = 1;  // the outer ones are
  const std::vector<std::vector<int>> outer = {{0, 2}, {1}};
  EXPECT_EQ(find_islands(joints, 3)[0].levels, outer);
}

TEST(Islands, TheParallelFormAdvancesAllAtOnce) {
  const std::vector<std::vector<int>> levels = {{0, 1, 2}};
  EXPECT_EQ(find_islands(joined({{0, 1}, {1, 2}}, false), 3)[0].levels, levels);
}

/// Three bodies, each of which could meet the two others: what a bar cannot, surfaces can.
struct Triangle {
  std::vector<Scripted> bodies;
  std::vector<Joint> joints = joined({{0, 1}, {1, 2}, {2, 0}});

  explicit Triangle(const std::array<double, 3>& compliance) {
    for (double c : compliance) {
      Scripted& body = bodies.emplace_back(0.0, 1.0, 1.0);
      body.compliance = c;
      body.description_.can.obstacle = true;
    }
  }
  void choose() {
    Bodies all({&bodies[0], &bodies[1], &bodies[2]});
    choose_roles(joints, all, 4.0, false);
  }
};

TEST(Roles, ThatWouldGoRoundInACircleAreThoseOfAnOrder) {
  // Pair by pair 2 > 1, 1 > 0 by the mesh and 0 > 2 by the compliance, which says more.
  Triangle t({4.0, 2.0, 1.0});
  for (int b : {0, 1, 2})
    t.bodies[index(b)].description_.ports[0].geometry.spacing = 3.0 - b;
  t.choose();
  EXPECT_NO_THROW(find_islands(t.joints, 3));
  EXPECT_EQ(t.joints[2].kinematic_side().body, 0);
  EXPECT_EQ(find_islands(t.joints, 3)[0].levels.size(), 3u);
}

TEST(Roles, OfAnyBodiesAreThoseOfAnOrder) {
  // Whatever bodies differ in, there is one that moves first and one that moves last.
  for (int trial = 0; trial < 729; ++trial) {
    Triangle t({1.0, 1.0, 1.0});
    int code = trial;
    for (Scripted& body : t.bodies) {
      body.compliance = std::array{1.0, 2.0, 5.0}[index(code % 3)];
      body.description_.ports[0].geometry.spacing = std::array{1.0, 2.0, 3.0}[index(code / 3 % 3)];
      code /= 9;
    }
    t.choose();
    EXPECT_NO_THROW(find_islands(t.joints, 3)) << trial;
  }
}

TEST(Roles, ThatTheSceneFixesInACircleAreRefusedBeforeTheRun) {
  Triangle t({1.0, 1.0, 1.0});
  for (Joint& joint : t.joints) joint.role_fixed = true;
  EXPECT_THROW(t.choose(), InputError);
  t.joints[2].role_fixed = false;
  EXPECT_NO_THROW(t.choose());
  EXPECT_EQ(t.joints[2].kinematic_side().body, 0);
}

}  // namespace
}  // namespace abut
