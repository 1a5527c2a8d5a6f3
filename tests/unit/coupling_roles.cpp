// Goal: roles and islands follow from what the bodies are, and never go round in a circle. Oracles:
// hand-made bodies.

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/coupling/islands.hpp"
#include "coordinator/coupling/line_watch.hpp"
#include "coordinator/coupling/compare/parallel_force.hpp"
#include "coordinator/coupling/roles.hpp"
#include "coordinator/coupling/unilateral.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/scripted.hpp"

namespace abut::coupling_roles_tests {
namespace {

int kinematic_of(const BarText& left, const BarText& right) {
  const std::unique_ptr<Subdomain> a = build(left), b = build(right);
  Bodies bodies({a.get(), b.get()});
  Joint joint = make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies);
  joint.exchange = std::make_unique<Unilateral>();
  Roles roles(bodies, 1e-5, false);
  roles.start({&joint, 1});
  roles.choose(joint);
  return joint.role.kinematic;
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
  graded.tied = "left";  // keeps its mass
  graded.integrator = explicit_scheme(1.0e-6);
  const std::unique_ptr<Subdomain> a = build(soft), b = build(graded);
  Bodies bodies({a.get(), b.get()});
  Joint joint = make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies);
  joint.role.kinematic = 0;
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
    joint.exchange = std::make_unique<Unilateral>();
    Roles roles(bodies, 1e-5, false);
    roles.start({&joint, 1});
    roles.choose(joint);
    EXPECT_EQ(joint.role.kinematic, wall_first ? 1 : 0);
  }
}

TEST(Roles, TheForceOfTheParallelFormLivesOnTheLongerSteps) {
  EXPECT_EQ(coarser_side(Facing(1.0, 2.0).joint, Facing(1.0, 2.0).bodies), 1);
  EXPECT_EQ(coarser_side(Facing(2.0, 1.0).joint, Facing(2.0, 1.0).bodies), 0);
}

/// Bodies with closed joints between pairs of them.
std::vector<Joint> joined(const std::vector<std::array<int, 2>>& pairs, bool ordered = true) {
  std::vector<Joint> joints(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    joints[i].sides = {Side{pairs[i][0], 0}, Side{pairs[i][1], 0}};
    joints[i].watch = std::make_unique<PointWatch>();
    joints[i].engage(1.0);
    if (ordered) {
      joints[i].exchange = std::make_unique<Unilateral>();
    } else {
      joints[i].exchange = std::make_unique<ParallelForce>();
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
  joints[0].role.kinematic = 1;  // the middle one is kinematic to both
  const std::vector<std::vector<int>> middle = {{1}, {0, 2}};
  EXPECT_EQ(find_islands(joints, 3)[0].levels, middle);
  joints[0].role.kinematic = 0;
  joints[1].role.kinematic = 1;  // the outer ones are
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
  /// Joints touch in some order.
  void choose(const std::array<int, 3>& touches = {0, 1, 2}) {
    Bodies all({&bodies[0], &bodies[1], &bodies[2]});
    Roles roles(all, 4.0, false);
    roles.start(joints);
    for (int j : touches) roles.choose(joints[j]);
  }
};

TEST(Roles, ThatWouldGoRoundInACircleAreThoseOfAnOrder) {
  // Pair by pair 2 > 1 and 1 > 0 by the mesh, and 0 > 2 by the compliance: the last one turns.
  Triangle t({4.0, 2.0, 1.0});
  for (int b : {0, 1, 2}) t.bodies[b].description_.ports[0].geometry.spacing = 3.0 - b;
  t.choose();
  EXPECT_EQ(t.joints[0].kinematic_side().body, 1);
  EXPECT_EQ(t.joints[1].kinematic_side().body, 2);
  EXPECT_EQ(t.joints[2].kinematic_side().body, 2);
  EXPECT_EQ(find_islands(t.joints, 3)[0].levels.size(), 3u);
}

TEST(Roles, OfAnyBodiesInAnyOrderOfTouchesAreThoseOfAnOrder) {
  // Whatever bodies differ in, there is one that moves first and one that moves last.
  std::array<int, 3> touches = {0, 1, 2};
  do {
    for (int trial = 0; trial < 729; ++trial) {
      Triangle t({1.0, 1.0, 1.0});
      int code = trial;
      for (Scripted& body : t.bodies) {
        body.compliance = std::array{1.0, 2.0, 5.0}[code % 3];
        body.description_.ports[0].geometry.spacing = std::array{1.0, 2.0, 3.0}[code / 3 % 3];
        code /= 9;
      }
      t.choose(touches);
      EXPECT_NO_THROW(find_islands(t.joints, 3)) << trial;
    }
  } while (std::ranges::next_permutation(touches).found);
}

TEST(Roles, GiveWayToThoseThatOnlyOneSideCanTake) {
  Triangle t({1.0, 1.0, 1.0});
  t.bodies[2].description_.can.obstacle = false;  // 1 before 2, and 0 before 2
  t.choose();
  EXPECT_EQ(t.joints[1].kinematic_side().body, 1);
  EXPECT_EQ(t.joints[2].kinematic_side().body, 0);
}

TEST(Roles, ThatTheSceneFixesInACircleAreRefusedBeforeTheRun) {
  Triangle t({1.0, 1.0, 1.0});
  for (Joint& joint : t.joints) joint.role.fixed = true;
  EXPECT_THROW(t.choose(), InputError);
  Triangle open({1.0, 1.0, 1.0});
  open.joints[0].role.fixed = open.joints[1].role.fixed = true;
  EXPECT_NO_THROW(open.choose());
  EXPECT_EQ(open.joints[2].kinematic_side().body, 0);
}

}  // namespace
}  // namespace abut::coupling_roles_tests
