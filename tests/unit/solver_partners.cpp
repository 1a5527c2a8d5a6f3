// Goal: a bar that meets a surface which gives way moves as both bodies at once would; forces of
// several partners add up; replies hold what is wanted and where.
// Oracles: the second body under the reaction, which must be where the first one saw it; the same
// forces as one; the whole of a trace.

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_partners_tests {
namespace {

struct Pairing {
  std::string name, integrator, layer;  // no layer: joined
  friend std::ostream& operator<<(std::ostream& out, const Pairing& m) { return out << m.name; }
};

/// Kick layers of several terms smooth otherwise while they are held, which is always in joints.
std::vector<Pairing> meetings() {
  std::vector<Pairing> all;
  for (int terms : {1, 2, 6, 12})
    all.push_back({"explicit" + std::to_string(terms) + "_massless",
                   explicit_scheme(case_step, terms), "massless: {stiffness_factor: 1.4}"});
  all.push_back({"explicit1_kick", explicit_scheme(case_step), "kick: {}"});
  for (int terms : {1, 6})
    all.push_back(
        {"explicit" + std::to_string(terms) + "_tied", explicit_scheme(case_step, terms), ""});
  for (const char* scheme : {"newmark", "hht_alpha", "generalized_alpha"}) {
    all.push_back(
        {std::string(scheme) + "_massless", implicit_scheme(scheme, case_step), "massless: {}"});
    all.push_back({std::string(scheme) + "_tied", implicit_scheme(scheme, case_step), ""});
  }
  return all;
}

constexpr double speed = 0.02;

std::unique_ptr<Subdomain> build_side(const Pairing& m, const std::string& side) {
  BarText bar = case_bar({"", m.integrator, m.layer, {side}}, side == "right" ? speed : 0.0);
  bar.position = side == "right" ? -case_elements : 0.0;
  if (m.layer.empty()) bar.tied = side;
  return build(bar);
}

class YieldingObstacle : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(Solver, YieldingObstacle, testing::ValuesIn(meetings()),
                         [](const auto& m) { return m.param.name; });

/// The bar and the one that it runs into, or is joined with.
struct Pair {
  explicit Pair(const Pairing& m, int most)
      : here(build_side(m, "right")), there(build_side(m, "left")) {
    const PortKernel kernel = there->probe({0, {1.0}, case_step, most});
    here->meet({0, 0, &there->describe().ports[0].geometry, {m.layer.empty()}, &kernel});
  }

  /// The surface as the other bar moves under a force, from the present state.
  Obstacle surface(double begin, double end, const std::vector<double>& force) {
    there->save();
    const Waveform moved = under(begin, end, force).ports[0].trace;
    there->restore();
    Obstacle obstacle;
    obstacle.motion.time = moved.time;
    obstacle.motion.u = moved.u;
    obstacle.motion.f = force;
    return obstacle;
  }
  Response under(double begin, double end, const std::vector<double>& force) {
    Response response;
    Advance request = free_request(*there, begin, end);
    Waveform& imposed = request.boundary[0].forces.emplace_back();
    imposed.support = there->probe({0, {1.0}, case_step, 1}).support;
    imposed.time = substep_times(begin, end, case_step);
    imposed.f = force;
    step(*there, request, response);
    return response;
  }

  std::unique_ptr<Subdomain> here, there;
};

TEST_P(YieldingObstacle, IsTheOtherBarInOneAdvance) {
  for (const int steps : {1, 7, 60}) {
    Pair pair(GetParam(), steps);
    const bool joined = GetParam().layer.empty();
    double pressed = 0.0;
    for (int w = 0; w < 180 / steps; ++w) {
      const double begin = w * steps * case_step, end = (w + 1) * steps * case_step;
      const std::vector<double> none(index(steps) + 1, 0.0);
      Advance request = free_request(*pair.here, begin, end);
      request.boundary[0].obstacles = {pair.surface(begin, end, none)};
      pair.here->save();
      Response seen, again;
      step(*pair.here, request, seen);
      const std::vector<double> reaction = seen.ports[0].reactions[0].force.f;
      // The pair of the last force and motion is where the fixed point stays.
      request.boundary[0].obstacles = {pair.surface(begin, end, reaction)};
      pair.here->restore();
      step(*pair.here, request, again);
      // Displacements of up to 2 m, forces of 0.01 N, tens of roundings a substep; joints add up
      // what they leave open.
      const double rounding = roundoff(200.0 * 180, 2.0);
      EXPECT_LT(largest_difference(reaction, again.ports[0].reactions[0].force.f), rounding);
      const Waveform there = pair.under(begin, end, reaction).ports[0].trace;
      for (std::size_t i = 1; i < reaction.size(); ++i) {
        const double gap = there.u[i] - seen.ports[0].trace.u[i];
        if (joined || reaction[i] > 0.0) {
          ASSERT_NEAR(gap, 0.0, rounding) << steps << ' ' << i;
        }
        ASSERT_GT(gap, -rounding);
        pressed = std::max(pressed, reaction[i]);
      }
    }
    EXPECT_GT(pressed, 0.4 * speed) << steps;  // Z v / 2
  }
}

TEST(YieldingObstacle, OfOtherStepsIsRefused) {
  const Pairing m = meetings().front();
  const std::unique_ptr<Subdomain> here = build_side(m, "right"), there = build_side(m, "left");
  here->meet({0, 0, &there->describe().ports[0].geometry});
  PortKernel kernel = there->probe({0, {1.0}, 0.5 * case_step, 3});
  const auto refusal = [&]() -> std::string {
    try {
      here->meet({0, 0, nullptr, {}, &kernel});
    } catch (const RunError& error) {
      return error.what_is_wrong;
    }
    return "taken";
  };
  EXPECT_TRUE(refusal().ends_with(fmt::format(
      "its steps are {} s, where {} s belong, 0.5 of it off", 0.5 * case_step, case_step)))
      << refusal();
  kernel.step = case_step * (1.0 + 1.0e-8);  // looks the same in six digits
  EXPECT_TRUE(refusal().ends_with(", 1e-08 of it off")) << refusal();
  kernel.step = case_step * (1.0 + 1.0e-12);  // rounding
  EXPECT_EQ(refusal(), "taken");
  kernel.support = ForceSupport::linear;
  EXPECT_TRUE(
      refusal().starts_with("gives way by a kernel that this body cannot take: its forces "
                            "are linear between times, where those "))
      << refusal();
}

TEST(Partners, OfABarAreObstaclesOneAtATime) {
  const SolverCase c = complete_cases().front();
  const std::unique_ptr<Subdomain> body = build(case_bar(c));
  const std::vector<double> times = substep_times(0.0, 6.0, case_step);
  PortGeometry point = body->describe().ports[0].geometry;
  point.normals[0] *= -1.0;
  for (const int k : {0, 1}) body->meet({0, k, &point, {.tied = true}});
  EXPECT_THROW(body->meet({0, 3, &point}), RunError) << "2 is next";
  Advance request = free_request(*body, 0.0, 6.0);
  std::vector<Obstacle>& obstacles = request.boundary[0].obstacles;
  obstacles.resize(2);
  obstacles[1] = pushing_surface(*body, 0, times, 0.1);
  Response response;
  step(*body, request, response);
  ASSERT_EQ(response.ports[0].reactions.size(), 2u);
  EXPECT_TRUE(response.ports[0].reactions[0].force.empty());
  EXPECT_EQ(response.ports[0].reactions[1].force.time, response.ports[0].trace.time);
  obstacles[0] = obstacles[1];
  EXPECT_THROW((void)body->advance(request, response), RunError);
}

class PartnersOf : public testing::TestWithParam<SolverCase> {};
INSTANTIATE_TEST_SUITE_P(Solver, PartnersOf, testing::ValuesIn(all_cases()), case_name);

TEST_P(PartnersOf, PushWithTheSumOfTheirForces) {
  const std::unique_ptr<Subdomain> apart = build(case_bar(GetParam())),
                                   together = build(case_bar(GetParam()));
  Waveform one(1), two(1), both(1);
  one.time = two.time = both.time = {0.0, 5.0, 12.0};
  one.f = {0.25, -0.5, 1.0};
  two.f = {0.5, 0.25, -0.125};
  both.f = {0.75, -0.25, 0.875};
  Response first, second;
  Advance request = free_request(*apart, 0.0, 12.0);
  request.boundary[0].forces = {one, {}, two};
  step(*apart, request, first);
  request.boundary[0].forces = {{}, both};
  step(*together, request, second);
  EXPECT_LT(largest_difference(first.ports[0].trace.u, second.ports[0].trace.u),
            roundoff(100 * 20, 20.0));
  EXPECT_LT(largest_difference(first.ports[0].trace.f, second.ports[0].trace.f),
            roundoff(100 * 20, 20.0));
}

TEST_P(PartnersOf, SeeTheFieldsThatTheyWant) {
  const std::unique_ptr<Subdomain> all = build(case_bar(GetParam(), 0.1)),
                                   some = build(case_bar(GetParam(), 0.1));
  Response whole, part;
  Advance request = free_request(*all, 0.0, 6.0);
  request.boundary[0].impulse = {0.1};
  step(*all, request, whole);
  request.want.resize(request.boundary.size());
  request.want[0] = {false, true, false, true, {}};
  step(*some, request, part);
  EXPECT_EQ(part.ports[0].trace.time, whole.ports[0].trace.time);
  EXPECT_TRUE(part.ports[0].trace.u.empty() && part.ports[0].trace.a.empty());
  EXPECT_EQ(part.ports[0].trace.v, whole.ports[0].trace.v);
  EXPECT_EQ(part.ports[0].trace.f, whole.ports[0].trace.f);
}

}  // namespace
}  // namespace abut::solver_partners_tests
