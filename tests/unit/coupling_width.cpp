// Goal: every condition at a joint is as wide as its ports. Oracle: bundles of bars, whose points
// must move as the bars do that are joined one by one. The bars of a bundle have velocities of
// their own, so that points taken for each other would be seen.

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/couple.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/parallel_force.hpp"
#include "coordinator/coupling/robin.hpp"
#include "tests/support/bundle.hpp"
#include "tests/support/scenes.hpp"

namespace abut {
namespace {

constexpr double step = 1.0e-6;                            // [s] of the left bars
constexpr std::array<double, 3> speed = {3.0, 1.0, -2.0};  // [m/s] with which sides approach
constexpr double tolerance = 1.0e-9;                       // of the iteration
constexpr int windows = 20, substeps = 5;                  // a wave goes to and fro in 20 elements

struct Case {
  std::string name;
  Decision decision = Decision::never;
  std::string left, right, layer;
  std::unique_ptr<Transmission> (*how)() = nullptr;
};

BarText bar(const std::string& name, const std::string& scheme, const std::string& layer,
            double velocity) {
  BarText bar;
  bar.name = name;
  bar.length = 0.02;
  bar.elements = 20;
  bar.integrator = scheme;
  bar.layer = layer;
  bar.position = name == "left" ? -0.02 : 0.0;
  bar.velocity = velocity;
  bar.sides = {name == "left" ? "right" : "left"};
  return bar;
}

std::vector<Case> cases() {
  const std::string fine = explicit_scheme(step / 2), same = explicit_scheme(step);
  const std::string newmark = implicit_scheme("newmark", step);
  const std::string massless = "massless: {}", massive = "massive: {}";
  const auto unilateral = []() -> std::unique_ptr<Transmission> {
    return std::make_unique<Unilateral>();
  };
  const auto parallel = []() -> std::unique_ptr<Transmission> {
    return std::make_unique<ParallelForce>();
  };
  const auto robin = []() -> std::unique_ptr<Transmission> {
    return std::make_unique<Robin>(Robin::Rule::matched, 0.0, false);
  };
  const auto robin_parallel = []() -> std::unique_ptr<Transmission> {
    return std::make_unique<Robin>(Robin::Rule::kernel, 0.0, true);
  };
  const auto published = []() -> std::unique_ptr<Transmission> {
    return std::make_unique<DirichletNeumann>(false);
  };
  std::vector<Case> all;
  for (const auto& [words, right] :
       {std::pair{"same_steps", same}, {"unlike_steps", fine}, {"implicit", newmark}}) {
    const std::string tail = std::string("_") + words;
    all.push_back({"tied_unilateral" + tail, Decision::never, same, right, massless, unilateral});
    all.push_back(
        {"contact_unilateral" + tail, Decision::every_substep, same, right, massless, unilateral});
    all.push_back({"tied_parallel" + tail, Decision::never, same, right, massless, parallel});
    all.push_back(
        {"contact_parallel" + tail, Decision::every_substep, same, right, massless, parallel});
    all.push_back({"tied_robin" + tail, Decision::never, same, right, massless, robin});
    all.push_back(
        {"tied_robin_parallel" + tail, Decision::never, same, right, massless, robin_parallel});
  }
  all.push_back(
      {"published_same_steps", Decision::window_begin, newmark, newmark, massive, published});
  all.push_back({"published_unlike_steps", Decision::window_begin, newmark,
                 implicit_scheme("newmark", step / 2), massive, published});
  return all;
}

/// Runs windows of a joint of two bodies; the left port's displacements at all substeps.
std::vector<double> run(const Case& c, Subdomain& left, Subdomain& right) {
  Bodies bodies({&left, &right}, substeps * step);
  bodies.prepare({0, 0.0, 0.0}, 1, Sampling::substeps);
  EXPECT_FALSE(bodies.advance_all());
  std::vector<Joint> joints;
  joints.push_back(make_joint("joint", {Side{0, 0}, Side{1, 0}}, bodies));
  Joint& joint = joints[0];
  joint.decision = c.decision;
  joint.how = c.how();
  joint.engage(speed[0]);
  introduce(joint, bodies);
  SchwarzSpec spec;
  spec.tolerance = tolerance;
  spec.max_iterations = 200;
  spec.accelerator = AndersonAcceleration{};
  Schwarz schwarz = make_schwarz(spec);
  const std::vector<Island> islands = find_islands(joints, 2);
  std::vector<double> u;
  for (int w = 0; w < windows; ++w) {
    const TimeWindow window{w, w * substeps * step, (w + 1) * substeps * step};
    bodies.save_all();
    bodies.prepare(window, 1, Sampling::substeps);
    const auto result = schwarz.solve(window, islands[0], joints, bodies);
    const SchwarzReport* report = std::get_if<SchwarzReport>(&result);
    EXPECT_TRUE(report != nullptr && report->converged) << c.name << " window " << w;
    if (report == nullptr || !report->converged) break;
    schwarz.accept(islands[0]);
    joint.force_scale = std::max(joint.force_scale, peak_force(joint, bodies));
    const Waveform& trace = trace_of(bodies, joint.sides[0]);
    u.insert(u.end(), trace.u.begin() + trace.width, trace.u.end());
  }
  return u;
}

class Width : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Coupling, Width, testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

TEST_P(Width, PointsOfAWideJointMoveAsJointsOfOnePoint) {
  const Case& c = GetParam();
  std::vector<std::unique_ptr<Subdomain>> lefts, rights;
  std::vector<std::vector<double>> alone;
  for (double v : speed) {
    const BarText left = bar("left", c.left, c.layer, v), right = bar("right", c.right, c.layer, 0);
    const std::unique_ptr<Subdomain> l = build(left), r = build(right);
    alone.push_back(run(c, *l, *r));
    lefts.push_back(build(left));
    rights.push_back(build(right));
  }
  Bundle left(std::move(lefts)), right(std::move(rights));
  const std::vector<double> wide = run(c, left, right);
  ASSERT_EQ(wide.size(), alone[0].size() * speed.size());
  // Both have converged to the tolerance, a mismatch of speed x step, in every window; waves carry
  // it on, and the published form's accelerations magnify it by a handful.
  const double error = 10.0 * tolerance * speed[0] * step * windows;
  for (std::size_t b = 0; b < speed.size(); ++b) {
    for (std::size_t i = 0; i < alone[b].size(); ++i)
      ASSERT_NEAR(wide[i * speed.size() + b], alone[b][i], error) << "point " << b << " at " << i;
  }
}

TEST(JointOfSurfaces, IsRefusedWhereTheirPointsDiffer) {
  std::vector<std::unique_ptr<Subdomain>> two, three;
  for (int b = 0; b < 3; ++b) {
    if (b < 2) two.push_back(build(bar("left", explicit_scheme(step), "massless: {}", 0.0)));
    three.push_back(build(bar("right", explicit_scheme(step), "massless: {}", 0.0)));
  }
  Bundle left(std::move(two)), right(std::move(three));
  const Bodies bodies({&left, &right});
  EXPECT_THROW(make_joint("joint", {Side{0, 0}, Side{1, 0}}, bodies), InputError);
}

}  // namespace
}  // namespace abut
