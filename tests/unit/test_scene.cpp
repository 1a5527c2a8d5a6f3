// Goal: a scene that cannot run is refused with a message that says what to write. Oracle: the
// exact text. The files of configs/invalid cover the same ground through the program.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/yaml_resolved.hpp"
#include "coordinator/scene.hpp"
#include "tests/support/refusal.hpp"

namespace abut::test_scene {
namespace {

constexpr const char* two_bars = R"(meta:
  title: Two bars
  closed_form: {bar_impact: {interface: impact}}
  expect:
    - {measure: momentum.total, equals: 0.0, absolute: 1.0e-12, because: round-off}
time: {begin: -2.0e-4, end: 8.0e-4, window: 1.0e-5}
bodies:
  left: {ports: {tip: {side: right}}}
  right: {launch: connect}
  third: {launch: {spawn: {program: other}}}
interfaces:
  impact:
    sides: [left.tip, right.tip]
    contact: {}
schwarz:
  form: parallel
  accelerator: {aitken: {initial: 0.25}}
)";

Document document(std::vector<std::string> overrides = {}) {
  return Document::from_text("s.yaml", two_bars, std::move(overrides));
}

std::string refusal(std::vector<std::string> overrides) {
  return abut::refusal([&] { read_scene(document(overrides)); });
}

TEST(Scene, ReadsWhatIsGivenAndKeepsDefaults) {
  const Scene scene = read_scene(document());
  EXPECT_EQ(scene.time.window, 1.0e-5);
  EXPECT_EQ(scene.bodies.at(1).first, "right");
  EXPECT_TRUE(std::holds_alternative<SpawnLaunch>(scene.bodies[0].second.launch));
  EXPECT_TRUE(std::holds_alternative<ConnectLaunch>(scene.bodies[1].second.launch));
  EXPECT_EQ(std::get<SpawnLaunch>(scene.bodies[2].second.launch).program, "other");
  EXPECT_EQ(scene.interfaces.at(0).second.name, "impact");
  EXPECT_TRUE(scene.schwarz.parallel);
  EXPECT_EQ(std::get<AitkenAcceleration>(scene.schwarz.accelerator).initial.value, 0.25);
  EXPECT_FALSE(scene.schwarz.max_iterations);
}

TEST(Scene, ResolvedTextReadsBackToTheSameScene) {
  const std::string once = to_yaml(read_scene(document()));
  EXPECT_EQ(to_yaml(read_scene(Document::from_text("again.yaml", once))), once);
}

struct Bad {
  const char* name;
  std::vector<std::string> overrides;
  const char* message;
};

class BadScene : public testing::TestWithParam<Bad> {};

TEST_P(BadScene, IsRefusedWithItsMessage) {
  EXPECT_EQ(refusal(GetParam().overrides), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Scene, BadScene,
    testing::Values(
        Bad{"EndBeforeBegin",
            {"time={begin: 1, end: 0, window: 1}"},
            "s.yaml, from --set time={begin: 1, end: 0, window: 1}: time.end: must be after begin, "
            "1 s, but is 0 s. Give an end after the begin."},
        Bad{"WindowLongerThanTheRun",
            {"time.window=1"},
            "s.yaml, from --set time.window=1: time.window: is longer than the run of 0.001 s. "
            "Give "
            "a window of at most 0.001 s."},
        Bad{"WindowLostInRounding",
            {"time.end=1.0e+300"},
            "s.yaml:6: time.window: is lost in the rounding of times up to 1e+300 s. Give a window "
            "of at least 2.22e+290 s, or times nearer to zero."},
        Bad{"SideWithoutPort",
            {"interfaces.impact.sides=[left, right.tip]"},
            "s.yaml, from --set interfaces.impact.sides=[left, right.tip]: "
            "interfaces.impact.sides[0]: is left, which is not of the form body.port. Name a body "
            "and one of its ports, for example left.tip."},
        Bad{"SideOfNoBody",
            {"interfaces.impact.sides=[left.tip, rigth.tip]"},
            "s.yaml, from --set interfaces.impact.sides=[left.tip, rigth.tip]: "
            "interfaces.impact.sides[1]: is rigth.tip, but there is no body rigth. Choose one of "
            "the "
            "bodies: left, right, third."},
        Bad{"BodyAgainstItself",
            {"interfaces.impact.sides=[left.tip, left.tail]"},
            "s.yaml, from --set interfaces.impact.sides=[left.tip, left.tail]: "
            "interfaces.impact.sides: must be ports of two different bodies. Name one port of each "
            "of the two bodies that meet."},
        Bad{"SamePortsInTwoInterfaces",
            {"interfaces.second={sides: [right.tip, left.tip], contact: {}}"},
            "s.yaml, from --set interfaces.second={sides: [right.tip, left.tip], contact: {}}: "
            "interfaces.second.sides: are left.tip and right.tip, which the interface impact joins "
            "already. Keep one of the two interfaces."},
        Bad{"KinematicIsNoSide",
            {"interfaces.impact.transmission={unilateral: {kinematic: third.tip}}"},
            "s.yaml, from --set interfaces.impact.transmission={unilateral: {kinematic: "
            "third.tip}}: "
            "interfaces.impact.transmission.unilateral.kinematic: is third.tip, which is not a "
            "side "
            "of the interface. Choose left.tip or right.tip."},
        Bad{"DirichletIsNoSide",
            {"interfaces.impact.transmission={dirichlet_neumann: {dirichlet: left}}"},
            "s.yaml, from --set interfaces.impact.transmission={dirichlet_neumann: {dirichlet: "
            "left}}: interfaces.impact.transmission.dirichlet_neumann.dirichlet: is left, which is "
            "not a side of the interface. Choose left.tip or right.tip."},
        Bad{"NoSuchInterface",
            {"meta.closed_form.bar_impact.interface=crash"},
            "s.yaml, from --set meta.closed_form.bar_impact.interface=crash: "
            "meta.closed_form.bar_impact.interface: is crash, but there is no such interface. "
            "Choose one of: impact."},
        Bad{"NoBody",
            {"bodies={}"},
            "s.yaml, from --set bodies={}: bodies: has no body. Give at least one body."},
        Bad{"TwoExpectedValues",
            {"meta.expect[0].at_most=1"},
            "s.yaml:5: meta.expect[0].measure: has 2 expected values. Give exactly one of equals, "
            "at_most, at_least beside it."},
        Bad{"NoTolerance",
            {"meta.expect=[{measure: m, equals: 1, because: b}]"},
            "s.yaml, from --set meta.expect=[{measure: m, equals: 1, because: b}]: "
            "meta.expect[0].measure: has 0 tolerances. Give exactly one of relative, absolute "
            "beside "
            "equals, and none beside a bound."},
        Bad{"RelaxationOfZero",
            {"schwarz.accelerator={relaxation: {factor: 0}}"},
            "s.yaml, from --set schwarz.accelerator={relaxation: {factor: 0}}: "
            "schwarz.accelerator.relaxation.factor: must be above 0 and at most 2, but is 0. Give "
            "the relaxation factor in this range, or probe."},
        Bad{"FirstFactorOfAWord",
            {"schwarz.accelerator={aitken: {initial: half}}"},
            "s.yaml, from --set schwarz.accelerator={aitken: {initial: half}}: "
            "schwarz.accelerator.aitken.initial: must be a number or probe, but is half. Give the "
            "relaxation factor as a number, or probe."},
        Bad{"EndpointWithoutTransport",
            {"network.endpoint=localhost"},
            "s.yaml, from --set network.endpoint=localhost: network.endpoint: must begin with "
            "tcp:// "
            "or ipc://, but is localhost. Give for example tcp://127.0.0.1:5555."}),
    [](const testing::TestParamInfo<Bad>& instance) { return std::string(instance.param.name); });

class BodiesOfAScene : public testing::Test {
 protected:
  BodiesOfAScene() {
    for (Description& body : bodies) {
      body.step = 1.0e-7;
      body.ports = {Port{.name = "tip", .geometry = at(0.0, 1.0)},
                    Port{.name = "tail", .geometry = at(-1.0, -1.0)}};
    }
    bodies[1].ports[0].geometry = at(0.25, -1.0);
  }
  static PortGeometry at(double point, double normal) {
    PortGeometry geometry;
    geometry.points = {point};
    geometry.normals = {normal};
    return geometry;
  }
  std::string refusal(std::vector<std::string> overrides = {}) {
    const Document text = document(std::move(overrides));
    const Scene scene = read_scene(text);
    const std::array<const Description*, 3> pointers{&bodies[0], &bodies[1], &bodies[2]};
    return abut::refusal([&] { validate_bodies(scene, pointers, text); });
  }
  std::array<Description, 3> bodies;
};

TEST_F(BodiesOfAScene, WindowsOfWholeStepsAreAccepted) {
  bodies[1].step = 1.0e-5 / 3.0;  // inexact in binary: round-off does not count
  bodies[2].step = 0.0;           // any window is one step
  EXPECT_EQ(refusal(), "not refused");
}

TEST_F(BodiesOfAScene, AStepThatDoesNotDivideTheWindowIsRefused) {
  bodies[1].step = 3.0e-6;
  bodies[1].stable_step = 1.0e-5;
  EXPECT_EQ(
      refusal(),
      "s.yaml:6: time.window: must hold a whole number of steps of body right, but 1e-05 s is "
      "3.33333 steps of 3e-06 s. Give a window of 9e-06 s or 1.2e-05 s, or the body a step of "
      "2.5e-06 s or 3.33333333333e-06 s.");
}

/// The numbers of "a window of 9e-06 s or 1.2e-05 s" behind some words.
std::vector<std::string> proposed(const std::string& message, const std::string& behind) {
  std::vector<std::string> numbers;
  std::size_t at = message.find(behind);
  while (at != std::string::npos) {
    at += numbers.empty() ? behind.size() : 4;  // " or "
    const std::size_t end = message.find(" s", at);
    numbers.push_back(message.substr(at, end - at));
    at = message.compare(end, 6, " s or ") == 0 ? end + 2 : std::string::npos;
  }
  return numbers;
}

// Goal: what is proposed is not refused next. Oracle: the same rules, applied to the proposal.
TEST_F(BodiesOfAScene, EveryProposalIsAccepted) {
  int windows = 0, steps = 0;
  for (const double step : {3.0e-6, 2.226e-6, 7.0e-7, 1.5e-5, 3.3e-8, 0.9e-6, 4.1e-6}) {
    for (const double other : {1.0e-7, 4.0e-7, 6.0e-7, 1.3e-6}) {
      for (const int records : {1, 2, 10}) {
        bodies[0].step = other;
        bodies[1].step = step;
        bodies[2].step = other;
        for (Description& body : bodies) body.stable_step = 1.0e-5;
        const std::string recording = fmt::format("output={{records_per_window: {}}}", records);
        const std::string message = refusal({recording});
        for (const std::string& window : proposed(message, "a window of ")) {
          EXPECT_EQ(refusal({recording, "time.window=" + window}), "not refused") << message;
          ++windows;
        }
        const std::size_t of = message.find("steps of body ");
        Description& blamed = bodies[message.compare(of, 18, "steps of body left") == 0 ? 0 : 1];
        for (const std::string& better : proposed(message, "the body a step of ")) {
          const double kept = std::exchange(blamed.step, std::stod(better));
          EXPECT_EQ(refusal({recording}), "not refused") << message;
          blamed.step = kept;
          ++steps;
        }
      }
    }
  }
  EXPECT_GT(windows, 30);
  EXPECT_GT(steps, 10);
}

TEST_F(BodiesOfAScene, StepsAreCountedBeforeTheyOverflow) {
  bodies[0].step = 1.0e-19;
  EXPECT_NE(refusal().find("takes steps of 1e-19 s"), std::string::npos) << refusal();
  bodies[0].step = 1.0e-12;
  EXPECT_NE(refusal().find("holds 1e+07 steps of body left, more than 1e+06"), std::string::npos)
      << refusal();
  const std::string run = "time={begin: 0.0, end: 10.0, window: 10.0}";
  for (Description& body : bodies) body.step = 3.0e-9;
  EXPECT_NE(refusal({"interfaces={}", "meta={title: alone}", "schwarz=null", run})
                .find("holds 3.33e+09 steps of body left, more than 1e+09"),
            std::string::npos);
}

TEST_F(BodiesOfAScene, AStepLongerThanTheWindowIsRefused) {
  bodies[1].step = 1.5e-5;
  EXPECT_EQ(
      refusal(),
      "s.yaml:6: time.window: must hold a whole number of steps of body right, but 1e-05 s is "
      "0.666667 steps of 1.5e-05 s. Give a window of 1.5e-05 s, or the body a step of 1e-05 "
      "s.");
}

TEST_F(BodiesOfAScene, AStepOffByMoreThanRoundOffIsRefused) {
  bodies[1].step = 1.0e-5 / 3.0 * (1.0 + 2.0e-9);  // the rule's tolerance is 1e-9
  EXPECT_NE(refusal(), "not refused");
}

TEST_F(BodiesOfAScene, APortThatTheBodyLacksIsRefused) {
  EXPECT_EQ(refusal({"interfaces.impact.sides=[left.top, right.tip]"}),
            "s.yaml, from --set interfaces.impact.sides=[left.top, right.tip]: "
            "interfaces.impact.sides[0]: is left.top, but left has no port top. Choose one of its "
            "ports: tip, tail.");
}

TEST_F(BodiesOfAScene, SidesOfUnlikeDimensionAreRefused) {
  bodies[1].ports[0].geometry.dim = 2;
  EXPECT_EQ(refusal(),
            "s.yaml:13: interfaces.impact.sides: join a port in 1D and one in 2D. Give both bodies "
            "the same dimension.");
}

TEST_F(BodiesOfAScene, SidesThatLookTheSameWayAreRefused) {
  bodies[1].ports[0].geometry.normals = {1.0};
  EXPECT_EQ(refusal(),
            "s.yaml:13: interfaces.impact.sides: look the same way and cannot touch. Join a right "
            "end with a left end.");
}

TEST_F(BodiesOfAScene, SidesThatOverlapAtTheStartAreRefusedAndThoseThatTouchAreNot) {
  bodies[1].ports[0].geometry.points = {0.0};
  EXPECT_EQ(refusal(), "not refused");
  bodies[1].ports[0].geometry.points = {-0.5};
  EXPECT_EQ(refusal(),
            "s.yaml:13: interfaces.impact.sides: overlap by 0.5 m at the start. Move a body with "
            "initial.position until the gap is zero or more.");
}

}  // namespace
}  // namespace abut::test_scene
