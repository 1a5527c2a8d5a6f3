// Goal: a step that is told without taking it is the step. Oracle: the step itself, bit by bit.
#include "subdomain_solver/time/foreseeing.hpp"

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "subdomain_solver/time/drift_kick_drift.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "subdomain_solver/time/stable_steps.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"

namespace abut::time_foreseeing_tests {
namespace {

constexpr double length = 0.01;  // [s] of a step

/// Tells a bound of its own, and counts how often it is asked.
class ScriptedWatch final : public FrequencyWatch {
 public:
  ScriptedWatch(double square, int& asked) : square_(square), asked_(asked) {}
  std::optional<Bound> bound(std::span<const double>, std::span<const double>, double from,
                             Effort) override {
    ++asked_;
    return Bound{std::max(from, square_), 0, 0};
  }
  std::string place(const Bound&) const override { return "a cell"; }
  int least_interval() const override { return 4; }

 private:
  double square_;
  int& asked_;
};

class Push final : public Load {
 public:
  void add(double time, std::span<const double> q, Vector& force) const override {
    for (Eigen::Index i = 0; i < force.size(); ++i) force(i) += 1.0e-3 * (time - 0.5 * q[i]);
  }
};

/// A block that one side drags, in motion under a load.
struct Block {
  FeModel model;
  Problem problem;
  Motion motion;
  int asked = 0;

  Block(const std::string& element, bool linear) : model(unit_mesh(element, 3), law(linear), {}) {
    problem.model = &model;
    const int dim = model.mesh().dim;
    for (std::int32_t node : model.mesh().nodes_of("left"))
      problem.supports.push_back({dim * node, [](double t) { return 0.01 * t; }});
    problem.loads.push_back(std::make_unique<Push>());
    motion.q.assign(index(model.dofs()), 0.0);
    DrawTensors draw;
    for (std::size_t i = 0; i < motion.q.size(); ++i)
      motion.v.push_back(0.01 * draw.between(-1.0, 1.0));
  }

  static std::unique_ptr<const Material> law(bool linear) {
    if (linear) return std::make_unique<LinearElastic>(test_moduli, 1.0);
    return std::make_unique<NeoHookean>(test_moduli, 1.0);
  }
  /// `share`: of the square of the limit that bounds are told at; 0: steps are not held.
  std::unique_ptr<Integrator> steps(double share, bool clamp) {
    auto scheme = std::make_unique<DriftKickDrift>(problem, length);
    if (share == 0.0) return scheme;
    const double limit = 2.0 / length;
    return std::make_unique<StableSteps>(
        std::move(scheme), std::make_unique<ScriptedWatch>(share * limit * limit, asked),
        StableSteps::Options{length, length, clamp});
  }
};

// Without bounds every step is told; held below a limit, all but those that begin with a bound or
// are taken in parts.
TEST(Foreseeing, ToldStepsAreTakenSteps) {
  for (const char* element : {"quad4", "hex8"}) {
    for (const bool linear : {true, false}) {
      for (const double share : {0.0, 0.9, 3.0}) {
        for (const bool clamp : {true, false}) {
          if (share > 1.0 && !clamp) continue;  // refused
          SCOPED_TRACE(testing::Message() << element << (linear ? ", linear, " : ", neo-Hookean, ")
                                          << share << (clamp ? ", clamped" : ""));
          Block block(element, linear);
          const std::unique_ptr<Integrator> steps = block.steps(share, clamp);
          Foreseeing* foreseeing = steps->able().foreseeing;
          ASSERT_NE(foreseeing, nullptr);
          ASSERT_FALSE(steps->begin(block.motion, 0.0));
          Foreseen ahead;
          int told = 0, bound = 0;
          for (int k = 0; k < 40; ++k) {
            ahead.steps = 0;
            const int asked = block.asked;
            const Motion before = block.motion;
            const bool tells = foreseeing->foresee(block.motion, k * length, length, ahead);
            EXPECT_EQ(block.motion.q, before.q);
            EXPECT_EQ(block.motion.control, before.control);
            EXPECT_EQ(block.asked, asked);
            ASSERT_FALSE(steps->step(block.motion, k * length, length));
            if (tells) {
              EXPECT_EQ(ahead.q, block.motion.q) << "step " << k;
            }
            told += tells ? 1 : 0;
            bound += block.asked > asked ? 1 : 0;
            if (share <= 1.0) {
              EXPECT_EQ(tells, block.asked == asked) << "step " << k;
            }
          }
          if (share == 0.0) {
            EXPECT_EQ(told, 40);
          }
          if (share > 0.0) {
            EXPECT_GT(bound, 0);
          }
          if (share == 0.9) {
            EXPECT_EQ(told, 40 - bound);
          }
          if (share > 1.0) {
            EXPECT_LE(told, 4);  // until the first bound divides steps
          }
        }
      }
    }
  }
}

// A wrapper hands on what the integrator inside can do, whole: it replaces what it does itself.
TEST(Foreseeing, WrappersHandOnAllAbilities) {
  Block block("quad4", false);
  int asked = 0;
  std::unique_ptr<Integrator> schemes[] = {std::make_unique<DriftKickDrift>(block.problem, length),
                                           std::make_unique<ExplicitDynamics>(block.problem)};
  for (std::unique_ptr<Integrator>& scheme : schemes) {
    const Integrator::Abilities inside = scheme->able();
    const StableSteps held(std::move(scheme), std::make_unique<ScriptedWatch>(1.0, asked),
                           {length, length, false});
    const Integrator::Abilities& able = held.able();
    EXPECT_EQ(able.inertia, inside.inertia);
    EXPECT_NE(able.inertia, nullptr);
    EXPECT_EQ(able.layer, inside.layer);
    EXPECT_EQ(able.lag, inside.lag);
    EXPECT_EQ(able.statics, inside.statics);
    EXPECT_EQ(able.accelerates_without_ties, inside.accelerates_without_ties);
    EXPECT_EQ(able.foreseeing != nullptr, inside.foreseeing != nullptr);
    EXPECT_EQ(able.held, &held);
  }
}

}  // namespace
}  // namespace abut::time_foreseeing_tests
