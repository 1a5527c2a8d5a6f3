// Goal: two bars in one body move as two bodies under their contact force would, conserve what
// their method says, and rewind. Oracles: the single bars, balances, the law of the contact, equal
// hashes.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_pair_tests {
namespace {

constexpr double pair_step = 0.5;  // [s]; h / c is 1 s
constexpr double pair_gap = 0.3;   // [m]
constexpr double pair_speed = 0.05;
const std::string penalty = "penalty: {stiffness: 0.2}";
const std::string multiplier = "lagrange_multiplier: {}";

struct Method {
  std::string name, contact, integrator;
  friend std::ostream& operator<<(std::ostream& out, const Method& m) { return out << m.name; }
};

std::string scheme(const std::string& words) {
  return fmt::format("{}step: {}}}", words, number(pair_step));
}

std::vector<Method> methods() {
  const std::string explicit_words = scheme("central_difference: {");
  const std::string newmark = scheme("newmark: {mass: averaged, ");
  const std::string euler = scheme("backward_euler: {mass: lumped, ");
  return {{"penalty_explicit", penalty, explicit_words},
          {"penalty_newmark", penalty, newmark},
          {"penalty_backward_euler", penalty, euler},
          {"multiplier_explicit", multiplier, explicit_words},
          {"multiplier_newmark", multiplier, newmark},
          {"multiplier_backward_euler", multiplier, euler}};
}

/// Bars of 20 and 30 elements, wave speed and impedance 1.
std::string pair_text(const Method& m, double gap = pair_gap, double speed = pair_speed,
                      const std::string& lengths = "reference") {
  return fmt::format(
      "bodies:\n  pair:\n    model: {{bar_pair: {{left: {{length: 20.0, area: 1.0, elements: 20, "
      "position: -20.0, velocity: {0}}}, right: {{length: 30.0, area: 1.0, elements: 30, position: "
      "{1}, velocity: {2}}}, contact: {{{3}}}, lengths: {4}}}}}\n"
      "    material: {{linear_elastic: {{youngs_modulus: 1.0, density: 1.0}}}}\n"
      "    integrator: {{{5}}}\n",
      number(speed), number(gap), number(-speed), m.contact, lengths, m.integrator);
}

std::unique_ptr<Subdomain> build_pair(const std::string& text) {
  return make_body(Document::from_text("test", text), "bodies.pair");
}

/// The single bar of the pair, as a body that takes forces at a massive contact node.
BarText single(const Method& m, int side) {
  BarText bar = side == 0 ? unit_bar("bar", 20.0, 20, m.integrator, -20.0, pair_speed)
                          : unit_bar("bar", 30.0, 30, m.integrator, pair_gap, -pair_speed);
  bar.layer = "massive: {}";
  bar.sides = {side == 0 ? "right" : "left"};
  return bar;
}

/// What the single bar tells all over itself is the pair's share of that side.
void expect_same_fields(Subdomain& bar, Subdomain& pair, int side) {
  const std::vector<FieldValues> own = bar.fields(), both = pair.fields();
  ASSERT_EQ(own.size(), both.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    const std::size_t from = side == 0 ? 0 : both[k].size() - own[k].size();
    for (std::size_t i = 0; i < own[k].size(); ++i)
      ASSERT_NEAR(own[k][i], both[k][from + i], roundoff(10000, pair_speed * 60.0)) << k;
  }
}

class Pair : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Solver, Pair, testing::ValuesIn(methods()),
                         [](const auto& method) { return method.param.name; });

/// Backward Euler is offered to pairs only: no single bar can be compared.
class PairBesideBars : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Solver, PairBesideBars,
                         testing::Values(methods()[0], methods()[1], methods()[3], methods()[4]),
                         [](const auto& method) { return method.param.name; });

TEST_P(PairBesideBars, MoveAsTwoBodiesUnderTheirContactForceWould) {
  const Method& m = GetParam();
  const std::unique_ptr<Subdomain> pair = build_pair(pair_text(m));
  Response both;
  step(*pair, free_request(*pair, 0.0, 60.0), both);
  for (int side : {0, 1}) {
    const std::unique_ptr<Subdomain> bar = build(single(m, side));
    Advance request = free_request(*bar, 0.0, 60.0);
    const Waveform& seen = both.ports[side].trace;
    request.boundary[0].forces = {seen};
    Response alone;
    step(*bar, request, alone);
    const Waveform& own = alone.ports[0].trace;
    ASSERT_EQ(own.size(), seen.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
      // 120 steps of the explicit scheme and as many implicit solves of 50 rows
      ASSERT_NEAR(own.u[i], seen.u[i], roundoff(10000, pair_speed * 60.0)) << i;
    }
    // inside a window an explicit bar shows its half-step velocities
    EXPECT_NEAR(own.v.back(), seen.v.back(), roundoff(10000, pair_speed));
    const MemberRecord& member = both.records[0].members[side];
    EXPECT_NEAR(alone.records[0].energy.total(), member.energy.total(), roundoff(100000, 0.05));
    expect_same_fields(*bar, *pair, side);
  }
}

TEST_P(Pair, FliesAsTwoFreeBarsUntilItTouches) {
  const std::unique_ptr<Subdomain> pair = build_pair(pair_text(GetParam()));
  Response response;
  step(*pair, free_request(*pair, 0.0, 2.0), response);  // the gap closes after 3 s
  for (std::size_t side : {0u, 1u}) {
    const double v = side == 0 ? pair_speed : -pair_speed;
    const Waveform& trace = response.ports[side].trace;
    for (std::size_t i = 0; i < trace.size(); ++i) {
      EXPECT_NEAR(trace.u[i], v * trace.time[i], roundoff(1000, 0.1));
      EXPECT_EQ(trace.f[i], 0.0);
    }
    EXPECT_NEAR(response.records[0].members[side].energy.stored, 0.0, roundoff(100, 1.0e-3));
  }
}

TEST_P(Pair, MomentumStaysAndForcesAreOppositeAndNeverPull) {
  const std::unique_ptr<Subdomain> pair = build_pair(pair_text(GetParam()));
  Response response;
  step(*pair, free_request(*pair, 0.0, 100.0, 50), response);
  const double scale = 30.0 * pair_speed;
  double most = 0.0;
  for (const BodyRecord& record : response.records) {
    EXPECT_NEAR(record.momentum[0], -10.0 * pair_speed, roundoff(20000, scale));
    EXPECT_NEAR(record.momentum[0], record.members[0].momentum[0] + record.members[1].momentum[0],
                roundoff(10, scale));
  }
  for (std::size_t i = 0; i < response.ports[0].trace.size(); ++i) {
    const double force = response.ports[1].trace.f[i];
    EXPECT_GE(force, 0.0);
    EXPECT_EQ(response.ports[0].trace.f[i], -force);
    most = std::max(most, force);
  }
  EXPECT_GT(most, 0.5 * pair_speed) << "they touched";
}

TEST_P(Pair, TheContactLawHoldsAtItsInstant) {
  const Method& m = GetParam();
  const std::unique_ptr<Subdomain> pair = build_pair(pair_text(m));
  Response response;
  step(*pair, free_request(*pair, 0.0, 40.0), response);
  const Waveform& left = response.ports[0].trace;
  const Waveform& right = response.ports[1].trace;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const double gap = pair_gap + right.u[i] - left.u[i];
    if (m.contact == penalty) {
      EXPECT_NEAR(right.f[i], 0.2 * std::max(0.0, -gap), roundoff(10000, 0.2 * 2.0)) << i;
    } else {
      EXPECT_GE(gap, -roundoff(10000, 2.0)) << i;
    }
  }
}

TEST_P(Pair, RestoreAndResumeRepeatEveryBit) {
  const std::unique_ptr<Subdomain> pair = build_pair(pair_text(GetParam()));
  const std::unique_ptr<Subdomain> twin = build_pair(pair_text(GetParam(), pair_gap, -1.0));
  Response first, second, third;
  step(*pair, free_request(*pair, 0.0, 10.0), first);  // in contact
  EXPECT_GT(largest_size(first.ports[1].trace.f), 0.0);
  pair->save();
  twin->resume(pair->checkpoint());
  EXPECT_EQ(twin->state_hash(), pair->state_hash());
  step(*pair, free_request(*pair, 10.0, 60.0), first);
  const std::uint64_t hash = pair->state_hash();
  pair->restore();
  EXPECT_EQ(pair->state_hash(), twin->state_hash());
  step(*pair, free_request(*pair, 10.0, 60.0), second);
  step(*twin, free_request(*twin, 10.0, 60.0), third);
  EXPECT_EQ(pair->state_hash(), hash);
  EXPECT_EQ(twin->state_hash(), hash);
  EXPECT_EQ(first.ports[0].trace.f, second.ports[0].trace.f);
  EXPECT_EQ(first.ports[0].trace.f, third.ports[0].trace.f);
}

TEST_P(Pair, IsDescribedByItsMembersAndOffersNothing) {
  const std::unique_ptr<Subdomain> pair = build_pair(pair_text(GetParam()));
  const Description& d = pair->describe();
  ASSERT_EQ(d.members.size(), 2u);
  EXPECT_EQ(d.members[0].name, "left");
  EXPECT_EQ(d.members[1].mass, 30.0);
  EXPECT_EQ(d.members[1].ports, std::vector<std::int32_t>{1});
  EXPECT_EQ(d.ports[1].name, "right_tip");
  EXPECT_EQ(d.ports[1].geometry.transit, 1.0);  // h / c
  EXPECT_EQ(d.mass, 50.0);
  EXPECT_FALSE(d.can.force || d.can.motion || d.can.obstacle || d.can.impulse || d.can.kernel);
  EXPECT_THROW(pair->probe({0, {1.0}, pair_step, 3}), RunError);
}

TEST(PairEnergy, OfThePenaltySpringIsPartOfTheWhole) {
  for (const Method& m : {methods()[0], methods()[1]}) {
    const std::unique_ptr<Subdomain> pair = build_pair(pair_text(m));
    Response response;
    step(*pair, free_request(*pair, 0.0, 150.0, 300), response);
    const double first = response.records.front().energy.total();
    double spring_most = 0.0;
    for (std::size_t i = 0; i < response.records.size(); ++i) {
      const BodyRecord& r = response.records[i];
      const double spring =
          r.energy.total() - r.members[0].energy.total() - r.members[1].energy.total();
      const double force = response.ports[1].trace.f[i + 1];  // one record per substep
      EXPECT_NEAR(spring, force * force / (2.0 * 0.2), roundoff(1000, first)) << m.name;
      spring_most = std::max(spring_most, spring);
    }
    EXPECT_GT(spring_most, 0.01 * first) << m.name;
    // exact but for the substeps in which the spring begins and ends to act
    EXPECT_NEAR(response.records.back().energy.total(), first, 1.0e-3 * first) << m.name;
  }
}

TEST(PairOnCurrentLengths, FailsWhenAnElementHasNoLengthLeft) {
  // twice the speed of sound: no elastic bar can take the impact
  const std::unique_ptr<Subdomain> pair =
      build_pair(pair_text(methods()[3], pair_gap, 2.0, "current"));
  Response response;
  const Outcome outcome = pair->advance(free_request(*pair, 0.0, 40.0), response);
  const Failed* failed = std::get_if<Failed>(&outcome);
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->cause, Failed::Cause::inverted_element);
}

TEST(PairRefusals, SayWhichKeyAndWhatToDo) {
  const Method good = methods()[0];
  auto refusal = [](const std::string& text) {
    try {
      build_pair(text);
    } catch (const InputError& error) {
      return error.where + " | " + error.what_is_wrong;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(pair_text(good)), "accepted");
  Method m = good;
  m.integrator = "central_difference: {step: 1.1}";
  EXPECT_NE(refusal(pair_text(m)).find("above the stable limit"), std::string::npos);
  m.integrator = "central_difference: {step: 0.5, dispersion_terms: 2}";
  EXPECT_NE(refusal(pair_text(m)).find("bar_pair does not offer"), std::string::npos);
  m.integrator = "hht_alpha: {step: 0.5}";
  EXPECT_NE(refusal(pair_text(m)).find("is not offered to bar_pair"), std::string::npos);
  EXPECT_NE(refusal(pair_text(good, -0.1)).find("overlaps the left bar by 0.1 m"),
            std::string::npos);
  EXPECT_NE(refusal(pair_text(good) + "    body_force: [1.0]\n").find("body_force"),
            std::string::npos);
  EXPECT_NE(refusal(pair_text(good) + "    supports: {left: fixed}\n").find("supports"),
            std::string::npos);
  EXPECT_NE(refusal(pair_text(good) + "    ports: {tip: {side: left}}\n").find("ports"),
            std::string::npos);
}

TEST(PairRefusals, BackwardEulerIsForPairsOnly) {
  BarText bar;
  bar.integrator = "backward_euler: {step: 1.0e-7}";
  EXPECT_THROW(build(bar), InputError);
}

}  // namespace
}  // namespace abut::solver_pair_tests
