// Goal: explicit steps keep their contract, whichever way the model finds its forces. Oracles: the
// motion itself, bit by bit; the same steps with forces cell by cell.
#include "subdomain_solver/time/explicit_dynamics.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/index.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::time_explicit_dynamics_tests {
namespace {

/// A block on two rollers, one of them inclined, in motion.
struct Block {
  FeModel model;
  Problem problem;
  Motion motion;

  Block(bool batched, int threads)
      : model(unit_mesh("hex8", 12), std::make_unique<NeoHookean>(test_moduli, 1.0),
              {Plane::strain, Formulation::full, 1.0, 0.05, batched, threads}, frames()) {
    problem.model = &model;
    for (std::int32_t node : model.mesh().nodes_of("left"))
      problem.supports.push_back({3 * node, [](double t) { return 0.01 * t; }});
    for (const NodeFrame& f : frames())
      problem.supports.push_back({3 * f.node, [](double) { return 0.0; }});
    std::sort(problem.supports.begin(), problem.supports.end(),
              [](const Prescribed& a, const Prescribed& b) { return a.dof < b.dof; });
    motion.q.assign(index(model.dofs()), 0.0);
    DrawTensors draw;
    for (std::size_t i = 0; i < motion.q.size(); ++i)
      motion.v.push_back(0.01 * draw.between(-1.0, 1.0));
  }

  static std::vector<NodeFrame> frames() {
    const Matrix3 axes = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()).toRotationMatrix();
    return {{unit_mesh("hex8", 12).nodes_of("right_bottom_back").front(), axes}};
  }

  void advance(int steps) {
    ExplicitDynamics scheme(problem);
    ASSERT_FALSE(scheme.begin(motion, 0.0));
    for (int k = 0; k < steps; ++k) ASSERT_FALSE(scheme.step(motion, 0.01 * k, 0.01));
  }
};

TEST(ExplicitDynamics, IsTheSameBitsForAllThreads) {
  Block one(true, 1), three(true, 3);
  one.advance(20);
  three.advance(20);
  EXPECT_EQ(one.motion.q, three.motion.q);
  EXPECT_EQ(one.motion.v, three.motion.v);
  EXPECT_EQ(one.motion.a, three.motion.a);
  EXPECT_EQ(one.motion.force, three.motion.force);
  EXPECT_EQ(one.motion.stored, three.motion.stored);
  EXPECT_EQ(one.motion.external_work, three.motion.external_work);
}

TEST(ExplicitDynamics, IsTheSameMotionCellByCell) {
  Block batched(true, 1), cells(false, 1);
  batched.advance(20);
  cells.advance(20);
  // Rounding of forces of order 1 on masses of 1/12^3, over 0.2 of time.
  const double rounding = roundoff(1000.0 * 1728.0 * 0.04, 1.0);
  EXPECT_LT(largest_difference(batched.motion.q, cells.motion.q), rounding);
  EXPECT_GT(largest_size(cells.motion.q), 1.0e-3);
  EXPECT_NEAR(batched.motion.external_work, cells.motion.external_work, rounding);
  EXPECT_NE(cells.motion.external_work, 0.0);
}

TEST(ExplicitDynamics, LeavesTheMotionAsItWasWhenItFails) {
  for (const bool batched : {true, false}) {
    Block run(batched, 1);
    run.advance(3);
    ExplicitDynamics scheme(run.problem);
    const Motion before = run.motion;
    // A step of 100 carries nodes a whole body's length.
    ASSERT_TRUE(scheme.step(run.motion, 0.03, 100.0));
    EXPECT_EQ(run.motion.q, before.q);
    EXPECT_EQ(run.motion.v, before.v);
    EXPECT_EQ(run.motion.a, before.a);
    EXPECT_EQ(run.motion.force, before.force);
    EXPECT_EQ(run.motion.history, before.history);
    EXPECT_EQ(run.motion.stored, before.stored);
    EXPECT_EQ(run.motion.external_work, before.external_work);
  }
}

}  // namespace
}  // namespace abut::time_explicit_dynamics_tests
