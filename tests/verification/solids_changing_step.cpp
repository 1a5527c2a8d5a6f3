// Goal: explicit steps stay stable while strain changes their limit, or say that they cannot.
// Oracles: the same steps without a watch, which blow up; balance of energy; the limit itself.
#include "subdomain_solver/time/stable_steps.hpp"

#include <cmath>

#include "base/archive.hpp"
#include "subdomain_solver/fe/highest_frequency.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solid_runs.hpp"

namespace abut::solids_changing_step_tests {
namespace {

struct Case {
  double length;  // over that at rest
  Formulation formulation;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.length << " " << static_cast<int>(c.formulation);
}

/// A rubber block whose right side is carried to a length within some 500 steps, and rests there;
/// or goes back on the same way.
struct Pressed {
  static constexpr double duration = 60.0;
  Solid solid;
  double limit = 0.0, step = 0.0;
  bool there_and_back = false;

  explicit Pressed(const Case& c)
      : solid(block(), std::make_unique<NeoHookean>(test_moduli, 1.0), options(c.formulation)) {
    solid.fix("left", 0);
    solid.fix("bottom", 1);
    solid.fix("back", 2);
    solid.prescribe("right", 0, [this, change = c.length - 1.0](const Position&, double t) {
      double part = std::min(1.0, t / duration);
      if (there_and_back && t > duration) part = std::max(0.0, 2.0 - t / duration);
      return change * part * part * (3.0 - 2.0 * part);
    });
    limit = stable_step(solid.model);
    step = 0.95 * limit;
  }
  static Mesh block() {
    Mesh mesh = unit_mesh("hex8", 4);
    distort(mesh, 0.01);
    return mesh;
  }
  static FeOptions options(Formulation formulation) {
    FeOptions options;
    options.formulation = formulation;
    options.batched = true;
    return options;
  }

  StableSteps steps(bool clamp) {
    return StableSteps(std::make_unique<ExplicitDynamics>(solid.problem),
                       std::make_unique<HighestFrequency>(solid.model), {step, limit, clamp});
  }

  /// Of the velocities as they are: what central differences conserve instead stays the same, in a
  /// linear body, where they blow up.
  double kinetic() const {
    const Eigen::Map<const Vector> v(solid.motion.v.data(), solid.model.dofs());
    return 0.5 * v.dot(solid.model.lumped_mass().cwiseProduct(v));
  }

  /// Supports work against the internal force, not against the inertia of their own nodes.
  double kinetic_of_supports() const {
    double sum = 0.0;
    for (const Prescribed& p : solid.problem.supports) {
      const double v = solid.motion.v[p.dof];
      sum += 0.5 * solid.model.lumped_mass()(p.dof) * v * v;
    }
    return sum;
  }

  struct End {
    std::optional<Failed> failed;
    double worst = 0.0;   // largest relative error of the balance of energy
    double energy = 0.0;  // largest
  };
  End run(Integrator& steps) {
    Motion& motion = solid.motion;
    End end;
    end.failed = steps.begin(motion, 0.0);
    const int count = static_cast<int>((there_and_back ? 160.0 : 70.0) / step);
    for (int k = 0; k < count && !end.failed; ++k) {
      end.failed = steps.step(motion, k * step, step);
      const double energy = kinetic() + motion.stored;
      end.energy = std::max(end.energy, energy);
      end.worst =
          std::max(end.worst, std::abs(energy - kinetic_of_supports() - motion.external_work));
      if (energy > 1.0e6) break;
    }
    return end;
  }
};

class PressedOrPulled : public testing::TestWithParam<Case> {
 protected:
  Pressed body{GetParam()};
};

/// Largest error of the balance with steps a quarter as long, below the limit all the time.
double error_of_short_steps(const Case& c) {
  Pressed body(c);
  body.step *= 0.25;
  ExplicitDynamics steps(body.solid.problem);
  const Pressed::End end = body.run(steps);
  EXPECT_FALSE(end.failed);
  return end.worst;
}
// Errors of central differences are of second order, 16 times those of a quarter of the step.
constexpr double second_order = 20.0;

TEST_P(PressedOrPulled, BlowsUpAtAConstantStep) {
  ExplicitDynamics raw(body.solid.problem);
  const Pressed::End end = body.run(raw);
  EXPECT_TRUE(end.failed);
  EXPECT_GT(end.worst, 0.1 * end.energy);
}

TEST_P(PressedOrPulled, KeepsItsEnergyInParts) {
  StableSteps clamped = body.steps(true);
  const Pressed::End end = body.run(clamped);
  ASSERT_FALSE(end.failed) << end.failed->detail;
  EXPECT_LT(end.worst, second_order * error_of_short_steps(GetParam()));
  const std::vector<double> told = clamped.measure(body.solid.motion);
  EXPECT_GE(told[1], 2.0);
  EXPECT_LT(told[0], body.step);
  // At the end the limit is below the whole step and above its parts.
  const double limit = stable_step(body.solid.model, body.solid.motion.q, {});
  EXPECT_LT(limit, body.step);
  EXPECT_GT(limit, body.step / told[1]);
}

TEST_P(PressedOrPulled, IsRefusedWithLimitStepAndCell) {
  StableSteps refused = body.steps(false);
  const Pressed::End end = body.run(refused);
  ASSERT_TRUE(end.failed);
  EXPECT_EQ(end.failed->cause, Failed::Cause::step_too_small);
  for (const char* words : {"stable limit has fallen to", "below the step of", "cell ", "clamp"})
    EXPECT_NE(end.failed->detail.find(words), std::string::npos) << end.failed->detail;
  // In time: nothing has grown yet.
  EXPECT_LT(end.worst, second_order * error_of_short_steps(GetParam()));
}

TEST_P(PressedOrPulled, WholeStepsComeBackWithTheShape) {
  body.there_and_back = true;
  StableSteps clamped = body.steps(true);
  const Pressed::End end = body.run(clamped);
  ASSERT_FALSE(end.failed) << end.failed->detail;
  EXPECT_GE(clamped.measure(body.solid.motion)[1], 2.0);
  // Whole steps are the same bits with and without a watch.
  Motion raw = body.solid.motion;
  ExplicitDynamics steps(body.solid.problem);
  ASSERT_FALSE(clamped.step(body.solid.motion, 1.0e3, body.step));
  ASSERT_FALSE(steps.step(raw, 1.0e3, body.step));
  EXPECT_EQ(raw.q, body.solid.motion.q);
}

TEST_P(PressedOrPulled, GoesOnFromASavedStateAsWithoutIt) {
  // The steps, their parts and the next bound are all in the motion.
  StableSteps whole = body.steps(true);
  Motion& motion = body.solid.motion;
  ASSERT_FALSE(whole.begin(motion, 0.0));
  const auto go = [&](StableSteps& steps, int from, int to) {
    for (int k = from; k < to; ++k) ASSERT_FALSE(steps.step(motion, k * body.step, body.step));
  };
  go(whole, 0, 370);
  std::vector<std::byte> saved;
  Archive kept = Archive::writer(saved, Archive::Form::bare);
  motion.state(kept);
  go(whole, 370, 700);
  const Motion once = motion;
  Archive back = Archive::reader(saved, Archive::Form::bare);
  motion.state(back);
  StableSteps other = body.steps(true);
  go(other, 370, 700);
  EXPECT_EQ(motion.q, once.q);
  EXPECT_EQ(motion.control, once.control);
  EXPECT_GE(other.measure(motion)[1], 2.0);
}

TEST(StableSteps, AreWholeWhereOnlyTheBoundIsAboveTheLimit) {
  // Cells distorted by a fifth of an edge: the bound [M.58] is some 10 % above their frequencies, a
  // step of 0.99 of the limit is stable all the same.
  for (const bool clamp : {false, true}) {
    Mesh mesh = unit_mesh("hex8", 6);
    distort(mesh, 0.2 / 6.0);
    Solid solid(std::move(mesh), std::make_unique<NeoHookean>(test_moduli, 1.0),
                Pressed::options(Formulation::full));
    DrawTensors draw;
    for (double& v : solid.motion.v) v = 1.0e-4 * draw.between(-1.0, 1.0);
    const double limit = stable_step(solid.model);
    const double step = 0.99 * limit;
    StableSteps steps(std::make_unique<ExplicitDynamics>(solid.problem),
                      std::make_unique<HighestFrequency>(solid.model), {step, limit, clamp});
    ASSERT_FALSE(steps.begin(solid.motion, 0.0));
    for (int k = 0; k < 1000; ++k) ASSERT_FALSE(steps.step(solid.motion, k * step, step));
    EXPECT_EQ(steps.measure(solid.motion)[1], 1.0);
    EXPECT_LT(steps.measure(solid.motion)[0], limit);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Strains, PressedOrPulled,
    testing::Values(Case{0.5, Formulation::full}, Case{0.6, Formulation::one_point},
                    Case{0.5, Formulation::mean_dilatation}, Case{3.0, Formulation::full},
                    Case{3.0, Formulation::one_point}, Case{3.0, Formulation::mean_dilatation}));

}  // namespace
}  // namespace abut::solids_changing_step_tests
