// Goal: factors of a surface without mass that serve for many steps and windows are no memory
// beside the state, and what its balance leaves costs no momentum. Oracles: a body that has nothing
// but the state; conservation.
#include "subdomain_solver/time/massless_layer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/archive.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::time_massless_layer_tests {
namespace {

constexpr double length = 0.04;  // [s] of a step; the stable one is about 0.2

/// A block of test moduli that flies, turns and is bent by its waves, its front without mass.
struct Bare {
  Solid solid;
  std::unique_ptr<ExplicitDynamics> run;

  Bare(std::unique_ptr<const Material> law, bool batched)
      : solid(block(), std::move(law), with(batched)) {
    std::vector<int> front;
    const FeModel& model = solid.model;
    for (const std::int32_t node : model.mesh().nodes_of("front"))
      for (int i = 0; i < 3; ++i) front.push_back(node * 3 + i);
    std::ranges::sort(front);
    solid.model.make_massless(front, {});
    solid.motion.v = nodal(model.mesh(), [](const Position& x) {
      return Position(0.05 + 0.4 * x(2), 0.3 * std::sin(x(0)), -0.2 * x(0) * x(2));
    });
    renew();
    EXPECT_FALSE(run->begin(solid.motion, 0.0));
  }
  static Mesh block() {
    BoxMesh box;
    box.lengths = {4.0, 3.0, 2.0};
    box.elements = {4, 3, 2};
    return generate(box, "test");
  }
  static FeOptions with(bool batched) {
    FeOptions options;
    options.batched = batched;
    return options;
  }
  void renew() { run = std::make_unique<ExplicitDynamics>(solid.problem); }
  void go(int first, int last) {
    for (int k = first; k < last; ++k) {
      const std::optional<Failed> failed = run->step(solid.motion, k * length, length);
      ASSERT_FALSE(failed) << failed->detail;
    }
  }
  void state(Archive& archive) {
    solid.motion.state(archive);
    run->able().layer->state(archive);
  }
  std::vector<std::byte> save() {
    std::vector<std::byte> bytes;
    Archive archive = Archive::writer(bytes, Archive::Form::named);
    state(archive);
    return bytes;
  }
  void restore(const std::vector<std::byte>& bytes) {
    Archive archive = Archive::reader(bytes, Archive::Form::named);
    state(archive);
  }
  std::vector<std::byte> place() {  // that the factors belong to
    std::vector<std::byte> bytes;
    Archive archive = Archive::writer(bytes, Archive::Form::bare);
    run->able().layer->state(archive);
    return bytes;
  }
};

struct Case {
  const char* name;
  bool plastic, batched;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class KeptLayer : public testing::TestWithParam<Case> {
 protected:
  static Bare body() {
    const auto& [name, plastic, batched] = GetParam();
    if (plastic)
      return {std::make_unique<J2Plasticity>(test_moduli, test_hardening(), 1.0), batched};
    return {std::make_unique<NeoHookean>(test_moduli, 1.0), batched};
  }
};
INSTANTIATE_TEST_SUITE_P(Solve, KeptLayer,
                         testing::Values(Case{"NeoHookean", false, true},
                                         Case{"NeoHookeanCellByCell", false, false},
                                         Case{"Plastic", true, true}),
                         [](const auto& param) { return std::string(param.param.name); });

TEST_P(KeptLayer, GoesOnToTheSameBitsWithoutItsFactors) {
  Bare body = KeptLayer::body();
  const std::vector<std::byte> begin = body.place();
  body.go(0, 40);
  const std::vector<std::byte> saved = body.save();
  EXPECT_NE(body.place(),
            begin);  // it was made anew on the way, or this would show nothing
  body.go(40, 80);
  const std::vector<std::byte> end = body.save();
  body.restore(saved);  // with the factors of the end
  body.go(40, 80);
  EXPECT_EQ(body.save(), end);
  body.renew();  // with none
  body.restore(saved);
  body.go(40, 80);
  EXPECT_EQ(body.save(), end);
}

/// A trial of a window that strays far makes factors that are none of the body's.
TEST_P(KeptLayer, ForgetsWhereATrialHasLedIt) {
  Bare body = KeptLayer::body(), plain = KeptLayer::body();
  body.go(0, 10);
  plain.go(0, 10);
  const std::vector<std::byte> saved = body.save();
  for (double& v : body.solid.motion.v) v *= 3.0;
  body.go(10, 40);
  body.restore(saved);
  body.go(10, 40);
  plain.go(10, 40);
  EXPECT_EQ(body.save(), plain.save());
}

TEST_P(KeptLayer, KeepsMomentumToRoundOff) {
  Bare body = KeptLayer::body();
  const auto momentum = [&body](int i) {
    const Vector& mass = body.solid.model.lumped_mass();
    double sum = 0.0;
    for (Eigen::Index k = i; k < mass.size(); k += 3)
      sum += mass(k) * body.solid.motion.v[index(static_cast<int>(k))];
    return sum;
  };
  const std::array<double, 3> before = {momentum(0), momentum(1), momentum(2)};
  body.go(0, 80);
  // Forces of about 1 on 60 nodes, in 80 steps; the balance leaves a billionth of them, which would
  // be some 1e-10.
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(momentum(i), before[index(i)], roundoff(60.0 * 80.0, 0.1)) << i;
}

}  // namespace
}  // namespace abut::time_massless_layer_tests
