// Goal: the bars' own core takes loads, initial fields and points at its ends, with every scheme
// and contact layer.
// Oracles: the model of solids where both discretise alike; balances of energy and momentum; rest
// under loads that hold each other; equal bits where two texts say the same.

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/shared_schemes.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_bar_loads_tests {
namespace {

/// What a scene says of a bar besides its text.
struct Extra {
  std::string name, fields, more;  // keys of initial; keys of the body
};

std::vector<Extra> extras() {
  const auto load = [](const std::string& text) { return "    loads: {" + text + "}\n"; };
  return {
      {"traction_left", "", load("pull: {on: left, traction: ['0.02 * sin(0.3 * t) + 0.01']}")},
      {"traction_right", "", load("pull: {on: right, traction: ['t > 3 ? 0.05 : 0.02']}")},
      {"pressure_left", "", load("press: {on: left, pressure: '0.03 * cos(0.2 * t)'}")},
      {"pressure_right", "", load("press: {on: right, pressure: '0.01 * t'}")},
      {"acceleration", "", load("wind: {acceleration: ['1e-4 * x * cos(0.2 * t) - 1e-3']}")},
      {"velocity_field", "velocity_field: ['0.1 * cos(0.2 * x)'], ", ""},
      {"displacement_field", "displacement_field: ['0.1 * sin(0.3 * x)'], ", ""},
      {"all", "velocity_field: ['0.01 * x'], displacement_field: ['0.1 * cos(0.2 * x)'], ",
       load("pull: {on: right, traction: ['0.05 * cos(0.3 * t)']}, press: {on: left, pressure: "
            "'0.02'}, wind: {acceleration: ['1e-3 * sin(0.2 * x)']}") +
           "    body_force: [-0.002]\n"},
  };
}

std::string text_with(const BarText& bar, const Extra& extra) {
  std::string text = bar.text();
  const std::string start = "    initial: {";
  text.insert(text.find(start) + start.size(), extra.fields);
  return text + extra.more;
}

std::unique_ptr<Subdomain> build_text(const std::string& body) {
  return make_body(Document::from_text("test", "bodies:\n" + body), "bodies.bar");
}

std::unique_ptr<Subdomain> build_with(const BarText& bar, const Extra& extra) {
  return build_text(text_with(bar, extra));
}

bool is_core(const Subdomain& body) { return body.describe().model.starts_with("bar"); }

class LoadedBar : public testing::TestWithParam<SharedScheme> {};
INSTANTIATE_TEST_SUITE_P(Solver, LoadedBar, testing::ValuesIn(shared_schemes()),
                         [](const auto& s) { return s.param.name; });

TEST_P(LoadedBar, TakesTheStepsOfTheModelOfSolids) {
  for (const Extra& extra : extras()) {
    for (const bool layered : {false, true}) {
      const char* fixed = layered ? "" : "left";
      SCOPED_TRACE(extra.name + " " + fixed);
      const std::string layer = layered ? "massless: {stiffness_factor: 1.0}" : GetParam().layer;
      BarText text = case_bar({"", GetParam().integrator, layer, {"right"}}, 0.03);
      text.fixed = fixed;
      const std::unique_ptr<Subdomain> core = build_with(text, extra);
      text.solid = true;
      if (!layered) text.tied = "right";  // the end keeps its mass
      const std::unique_ptr<Subdomain> solid = build_with(text, extra);
      ASSERT_TRUE(is_core(*core));
      ASSERT_FALSE(is_core(*solid));
      constexpr int steps = 120;
      Response expected, found;
      const Advance request = free_request(*core, 0.0, steps * case_step, 4);
      step(*solid, request, expected);
      step(*core, request, found);
      const Waveform &a = expected.ports[0].trace, &b = found.ports[0].trace;
      // Each step rounds a handful of operations per node; one correction of Newton's method is
      // exact to the condition of the matrix, 1 + 4 (c dt / h)^2.
      const double rounding = roundoff(200.0 * steps, largest_size(a.u));
      EXPECT_LT(largest_difference(a.u, b.u), rounding);
      EXPECT_GT(largest_size(a.u), 0.1);
      for (std::size_t r = 0; r < 4; ++r) {
        // Both tell it as the mean forces of steps change it where no node is held.
        EXPECT_NEAR(found.records[r].momentum[0], expected.records[r].momentum[0], 40 * rounding);
        // forces of up to 0.1 N on 40 nodes
        EXPECT_NEAR(found.records[r].energy.external_work, expected.records[r].energy.external_work,
                    40 * rounding);
      }
    }
  }
}

class LoadedCases : public testing::TestWithParam<SolverCase> {};
INSTANTIATE_TEST_SUITE_P(Solver, LoadedCases, testing::ValuesIn(complete_cases()), case_name);

TEST_P(LoadedCases, WorkOfLoadsClosesTheBalanceOfEnergy) {
  for (const Extra& extra : extras()) {
    for (const char* touched : {"free", "forces", "obstacles"}) {
      SCOPED_TRACE(extra.name + " " + touched);
      const std::unique_ptr<Subdomain> body = build_with(case_bar(GetParam(), 0.02), extra);
      ASSERT_TRUE(is_core(*body));
      if (!body->describe().conserves) continue;
      Response response;
      Advance request = free_request(*body, 0.0, 0.0);
      step(*body, request, response);
      const auto own = [&response] {
        const Energy& e = response.records.back().energy;
        return e.total() - e.external_work;
      };
      const double first = own();
      double ports = 0.0, most = 0.0;
      for (std::size_t p = 0; p < request.boundary.size(); ++p) meet_point(*body, p, false, 0.05);
      for (int w = 0; w < 10; ++w) {
        const double begin = 12 * case_step * w, end = 12 * case_step * (w + 1);
        request = free_request(*body, begin, end);
        request.window.index = w;
        for (std::size_t p = 0; p < request.boundary.size(); ++p) {
          BoundaryData& data = request.boundary[p];
          if (touched == std::string("obstacles"))
            data.obstacles = {pushing_surface(*body, p, substep_times(begin, end, case_step), 0.1)};
          if (touched == std::string("forces")) {
            Waveform& force = data.forces.emplace_back();
            force.time = substep_times(begin, end, case_step);
            for (const double t : force.time) force.f.push_back(0.03 * std::sin(0.2 * t));
          }
        }
        step(*body, request, response);
        for (const PortResponse& port : response.ports) ports += port.work;
        most = std::max({most, std::abs(own()), response.records.back().energy.total()});
        // 120 steps of 41 nodes; with P = 12 the smoothed displacements round more
        EXPECT_NEAR(own() - ports, first, roundoff(5000.0, most)) << "window " << w;
      }
    }
  }
}

TEST_P(LoadedCases, MomentumIsTheImpulseOfTheLoads) {
  const std::string loads =
      "    loads: {pull: {on: right, traction: ['0.02 * t']}, press: {on: left, pressure: '0.05'}, "
      "wind: {acceleration: ['0.001 * t']}}\n";
  const std::unique_ptr<Subdomain> body = build_with(case_bar(GetParam()), {"", "", loads});
  Response response;
  step(*body, free_request(*body, 0.0, 0.0), response);
  const double before = response.records.back().momentum[0];
  EXPECT_NEAR(before, 0.0, roundoff(100.0, 0.05));
  const double end = 50 * case_step;
  step(*body, free_request(*body, 0.0, end), response);
  const double impulse = (0.02 + 0.04) * 0.5 * end * end + 0.05 * end;  // 40 kg
  EXPECT_NEAR(response.records.back().momentum[0], impulse, roundoff(2000.0, impulse));
}

TEST_P(LoadedCases, ALoadOnTheNodeOfContactIsTheReactionAtRest) {
  // It grows from nothing, so the bar never moves: the obstacle takes all of it.
  const std::vector<std::string>& sides = GetParam().sides;
  if (sides.size() > 1 || GetParam().name.find("kick") != std::string::npos) return;
  const std::string load = fmt::format(
      "    loads: {{press: {{on: {}, pressure: '-0.5 * sin(0.1 * t)^2'}}}}\n", sides[0]);
  const std::unique_ptr<Subdomain> body = build_with(case_bar(GetParam()), {"", "", load});
  meet_point(*body, 0, false);
  Response response;
  Advance request = free_request(*body, 0.0, 30 * case_step);
  Obstacle& wall = request.boundary[0].obstacles.emplace_back();
  wall.motion.time = {0.0, 30 * case_step};
  wall.motion.u = {0.0, 0.0};
  step(*body, request, response);
  const Waveform& reaction = response.ports[0].reactions[0].force;  // on the obstacle
  ASSERT_EQ(reaction.time.size(), 31u);
  for (std::size_t i = 1; i < reaction.time.size(); ++i) {
    const double expected = 0.5 * std::pow(std::sin(0.1 * reaction.time[i]), 2);
    EXPECT_NEAR(outward(*body, 0) * reaction.f[i], expected, roundoff(1000.0, 0.5));
  }
  EXPECT_LT(largest_size(response.ports[0].trace.u), roundoff(1000.0, 0.5));
  EXPECT_LT(response.records.back().energy.total(), roundoff(1000.0, 0.5));
}

TEST_P(LoadedCases, ABarThatStartsPressedStaysAtRest) {
  // A load of 0.3 on the node of contact, or on the far end of a bar compressed by 0.3.
  const std::vector<std::string>& sides = GetParam().sides;
  if (sides.size() > 1 || GetParam().name.find("kick") != std::string::npos) return;
  const bool left = sides[0] == "left";
  const std::string field = left ? "-0.3 * x" : "-0.3 * (x - 40)";
  const std::string other = left ? "right" : "left";
  const Extra starts[] = {
      {"node", "", fmt::format("    loads: {{l: {{on: {}, pressure: '-0.3'}}}}\n", sides[0])},
      {"bar", "displacement_field: ['" + field + "'], ",
       fmt::format("    loads: {{l: {{on: {}, pressure: '0.3'}}}}\n", other)}};
  for (const Extra& start : starts) {
    SCOPED_TRACE(start.name);
    // The element of contact is as stiff as the others, without dispersion terms.
    SolverCase plain = GetParam();
    plain.layer = "massless: {stiffness_factor: 1.0}";
    if (start.name == "bar" && plain.name.starts_with("explicit") &&
        !plain.name.starts_with("explicit1_"))
      continue;
    const std::unique_ptr<Subdomain> body = build_with(case_bar(plain), start);
    meet_point(*body, 0, false);
    Response response;
    step(*body, free_request(*body, 0.0, 0.0), response);
    const auto own = [&response] {
      const Energy& e = response.records.back().energy;
      return e.total() - e.external_work;
    };
    const double first = own();
    Advance request = free_request(*body, 0.0, 30 * case_step);
    Obstacle& wall = request.boundary[0].obstacles.emplace_back();
    wall.motion.time = {0.0, 30 * case_step};
    wall.motion.u = {0.0, 0.0};
    step(*body, request, response);
    for (const double f : response.ports[0].reactions[0].force.f)
      EXPECT_NEAR(outward(*body, 0) * f, 0.3, roundoff(2000.0, 12.0));
    EXPECT_LT(largest_size(response.ports[0].trace.u), roundoff(2000.0, 12.0));
    EXPECT_NEAR(own() - response.ports[0].work, first, roundoff(2000.0, 12.0));
    EXPECT_NEAR(response.records.back().momentum[0], 0.0, roundoff(2000.0, 12.0));
  }
}

TEST_P(LoadedCases, AUniformFieldOfVelocityIsAVelocity) {
  BarText text = case_bar(GetParam(), 0.1);
  text.body_force = -0.01;
  const std::unique_ptr<Subdomain> one = build(text);
  text.velocity = 0.0;
  const std::unique_ptr<Subdomain> other =
      build_with(text, {"", "velocity_field: ['" + number(0.1) + "'], ", ""});
  EXPECT_EQ(one->state_hash(), other->state_hash());
  Response response;
  for (Subdomain* body : {one.get(), other.get()})
    step(*body, free_request(*body, 0.0, 17.0), response);
  EXPECT_EQ(one->state_hash(), other->state_hash());
}

TEST_P(LoadedCases, ProbesSeeNoLoadsAndLeaveNoTrace) {
  const Extra all = extras().back();
  const std::unique_ptr<Subdomain> loaded = build_with(case_bar(GetParam()), all);
  const std::unique_ptr<Subdomain> bare =
      build_with(case_bar(GetParam()), {"", "", "    body_force: [-0.002]\n"});
  Response response;
  step(*loaded, free_request(*loaded, 0.0, 5.0), response);
  const std::uint64_t hash = loaded->state_hash();
  const PortKernel one = normal_kernel(*loaded, 0, case_step, 20);
  EXPECT_EQ(loaded->state_hash(), hash);
  const PortKernel other = normal_kernel(*bare, 0, case_step, 20);
  EXPECT_EQ(one.displacement, other.displacement);
  EXPECT_EQ(one.begin, other.begin);
  const std::unique_ptr<Subdomain> twin = build_with(case_bar(GetParam()), all);
  step(*twin, free_request(*twin, 0.0, 5.0), response);
  for (Subdomain* body : {loaded.get(), twin.get()})
    step(*body, free_request(*body, 5.0, 11.0), response);
  EXPECT_EQ(loaded->state_hash(), twin->state_hash());
}

BarText plain() { return case_bar({"", explicit_scheme(0.6), "massless: {}", {"right"}}); }

/// The port of a plain bar on something else than its right side.
std::string port_on(const std::string& side, const std::string& more) {
  std::string text = plain().text();
  const std::string was = "{side: right}";
  return text.replace(text.find(was), was.size(), "{side: " + side + "}") + more;
}

TEST(BarPoints, APortAtAnEndIsThatSide) {
  const std::unique_ptr<Subdomain> side = build_text(plain().text());
  const std::unique_ptr<Subdomain> point =
      build_text(port_on("tip", "    points: {tip: {at: [40.0]}, middle: {at: [20.0]}}\n"));
  EXPECT_TRUE(is_core(*point));
  EXPECT_EQ(point->describe().model, side->describe().model);
  EXPECT_EQ(point->describe().ports[0].geometry.normals, std::vector<double>{1.0});
  EXPECT_EQ(point->state_hash(), side->state_hash());
}

TEST(BarPoints, APortInsideMakesASolidThatSaysSo) {
  std::string text = port_on("middle", "    points: {middle: {at: [20.0]}}\n");
  EXPECT_THROW(build_text(text), InputError);  // a contact layer has no effect on it
  const std::string layer = "    contact_layer: {massless: {}}\n";
  text.erase(text.find(layer), layer.size());
  const std::string inside = build_text(text)->describe().model;
  EXPECT_TRUE(inside.starts_with("fe in place of the bars' own core, for a port inside the bar,"))
      << inside;
  text = plain().text() + "    constraints: {wall: {on: left, fixed: true}}\n";
  text.erase(text.find(layer), layer.size());
  const std::string held = build_text(text)->describe().model;
  EXPECT_TRUE(held.starts_with("fe in place of the bars' own core, for constraints,")) << held;
}

std::string refusal(const std::string& body) {
  return abut::refusal([&body] { build_text(body); });
}

TEST(BarPoints, AndLoadsAreRefusedWhereNothingIs) {
  const std::string beside = port_on("tip", "    points: {tip: {at: [39.8]}}\n");
  EXPECT_NE(refusal(beside).find("no node is at (39.8)"), std::string::npos);
  const std::string unknown = "    loads: {pull: {on: top, traction: ['1']}}\n";
  const std::string told = refusal(plain().text() + unknown);
  EXPECT_NE(told.find("loads.pull.on"), std::string::npos) << told;
  EXPECT_NE(told.find("'top'"), std::string::npos) << told;
  const std::string two = "    loads: {pull: {on: left, traction: ['1', '2']}}\n";
  EXPECT_NE(refusal(plain().text() + two).find("has 2 expressions"), std::string::npos);
  const std::string follows = "    loads: {pull: {on: left, pressure: '1', follows: true}}\n";
  EXPECT_NE(refusal(plain().text() + follows).find("loads.pull.follows"), std::string::npos);
}

}  // namespace
}  // namespace abut::solver_bar_loads_tests
