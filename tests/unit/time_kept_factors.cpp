// Goal: factors that serve for many steps change nothing but the time that steps take, and a motion
// that goes on elsewhere goes on to the same bits. Oracle: Newton's method with factors of its own.
#include "subdomain_solver/time/implicit_dynamics.hpp"

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::time_kept_factors_tests {
namespace {

constexpr double length = 0.1;  // [s] of a step, in which waves pass a tenth of a cell
constexpr int never = std::numeric_limits<int>::max();

/// Counts factorisations.
class Counting final : public LinearSolver {
 public:
  explicit Counting(int& count) : count_(count) {}
  bool factor(const SparseMatrix& matrix) override {
    ++count_;
    return solver_->factor(matrix);
  }
  bool solve(const Vector& b, Vector& x) override { return solver_->solve(b, x); }

 private:
  int& count_;
  std::unique_ptr<LinearSolver> solver_ = make_direct_solver(Pivots::every);
};

/// A rubber block that is held at one side and thrown away from it.
struct Thrown {
  Solid solid;
  int factorisations = 0;
  std::unique_ptr<ImplicitDynamics> run;

  Thrown(double speed, int keeps_from) : solid(block(), std::make_unique<NeoHookean>(law(), 1.0)) {
    for (int i = 0; i < 3; ++i) solid.fix("left", i);
    solid.motion.v = nodal(solid.model.mesh(), [speed](const Position& x) {
      return Position(speed * x(0) / 4.0, 0.0, 0.1 * speed * x(0) / 4.0);
    });
    renew(keeps_from);
    EXPECT_FALSE(run->begin(solid.motion, 0.0));
  }
  static Mesh block() {
    BoxMesh box;
    box.lengths = {4.0, 2.0, 2.0};
    box.elements = {4, 2, 2};
    return generate(box, "test");
  }
  static Moduli law() { return isotropic(1.0, 0.3); }
  void renew(int keeps_from) {
    ImplicitDynamics::Options options;
    options.keeps_from = keeps_from;
    run = std::make_unique<ImplicitDynamics>(solid.problem, options,
                                             std::make_unique<Counting>(factorisations));
  }
  void go(int first, int last) {
    for (int k = first; k < last; ++k) {
      const std::optional<Failed> failed = run->step(solid.motion, k * length, length);
      ASSERT_FALSE(failed) << failed->detail;
    }
  }
};

class KeptFactors : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Time, KeptFactors, testing::Values(0.01, 0.2, 1.0));

TEST_P(KeptFactors, LeadToTheSameMotion) {
  constexpr int steps = 40;
  Thrown kept(GetParam(), 0), own(GetParam(), never);
  kept.go(0, steps);
  own.go(0, steps);
  EXPECT_LT(2 * kept.factorisations, own.factorisations);
  // Every step is solved to 1e-9 of its forces; errors of steps add up while the block swings.
  EXPECT_LT(largest_difference(kept.solid.motion.q, own.solid.motion.q),
            iteration(1.0e-9, steps) * largest_size(own.solid.motion.q));
  EXPECT_LT(largest_difference(kept.solid.motion.v, own.solid.motion.v),
            iteration(1.0e-9, steps) * largest_size(own.solid.motion.v));
}

TEST_P(KeptFactors, GoOnElsewhereToTheSameBits) {
  Thrown kept(GetParam(), 0);
  kept.go(0, 7);
  const Motion middle = kept.solid.motion;
  kept.go(7, 12);
  const Motion end = kept.solid.motion;
  for (const bool renewed : {false, true}) {  // rewound, and resumed by a body that knows nothing
    kept.solid.motion = middle;
    if (renewed) kept.renew(0);
    kept.go(7, 12);
    EXPECT_EQ(kept.solid.motion.q, end.q);
    EXPECT_EQ(kept.solid.motion.v, end.v);
    EXPECT_EQ(kept.solid.motion.a, end.a);
    EXPECT_EQ(kept.solid.motion.control, end.control);
  }
}

TEST(KeptFactorsOfSmallMotions, ServeAllSteps) {
  Thrown kept(1.0e-4, 0);
  kept.go(0, 20);
  EXPECT_EQ(kept.factorisations, 1);
}

}  // namespace
}  // namespace abut::time_kept_factors_tests
