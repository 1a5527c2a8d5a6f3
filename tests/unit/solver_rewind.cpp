// Goal: a body comes back to a saved state bit for bit, divides windows as the contract says, and
// reports what was asked for. Oracles: equal hashes, equal bits, exact times.

#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_rewind_tests {
namespace {

/// The case's bar, all of whose ports have met a surface.
std::unique_ptr<Subdomain> build_met(const SolverCase& c, double velocity) {
  std::unique_ptr<Subdomain> body = build(case_bar(c, velocity));
  for (std::size_t p = 0; p < body->describe().ports.size(); ++p) meet_point(*body, p, true);
  return body;
}

/// A request that keeps or brings the case's ports into contact.
Advance contact_request(const Subdomain& body, double begin, double end) {
  Advance request = free_request(body, begin, end);
  for (std::size_t p = 0; p < request.boundary.size(); ++p) {
    if (body.describe().can.obstacle) {
      request.boundary[p].obstacles = {
          pushing_surface(body, p, substep_times(begin, end, case_step), 0.1)};
    } else {
      Waveform& motion = request.boundary[p].motion;
      motion.time = {begin, end};
      motion.u = {0.0, -0.1 * outward(body, p)};
      motion.v = motion.a = {0.0, 0.0};
    }
  }
  return request;
}

class Rewind : public testing::TestWithParam<SolverCase> {};
INSTANTIATE_TEST_SUITE_P(Solver, Rewind, testing::ValuesIn(all_cases()), case_name);

TEST_P(Rewind, RestoreInTheMiddleOfContactRepeatsEveryBit) {
  const std::unique_ptr<Subdomain> body = build_met(GetParam(), 0.02);
  Response before, first, second;
  step(*body, contact_request(*body, 0.0, 7.3), before);  // ends with a shortened substep
  const std::uint64_t saved = body->state_hash();
  body->save();
  const Advance next = contact_request(*body, 7.3, 15.1);
  step(*body, next, first);
  const std::uint64_t hash = body->state_hash();
  EXPECT_NE(hash, saved);
  body->restore();
  EXPECT_EQ(body->state_hash(), saved);
  Response other;  // something else in between must leave no trace
  step(*body, free_request(*body, 7.3, 20.0), other);
  body->restore();
  step(*body, next, second);
  EXPECT_EQ(body->state_hash(), hash);
  for (std::size_t p = 0; p < first.ports.size(); ++p) {
    EXPECT_EQ(first.ports[p].trace.u, second.ports[p].trace.u);
    EXPECT_EQ(first.ports[p].trace.v, second.ports[p].trace.v);
    EXPECT_EQ(first.ports[p].trace.f, second.ports[p].trace.f);
  }
  EXPECT_EQ(first.records[0].energy.kinetic, second.records[0].energy.kinetic);
}

TEST_P(Rewind, CheckpointResumesAnotherBodyInTheSameState) {
  const std::unique_ptr<Subdomain> body = build_met(GetParam(), 0.02);
  const std::unique_ptr<Subdomain> twin = build_met(GetParam(), -1.0);
  Response response, reply;
  step(*body, contact_request(*body, 0.0, 6.0), response);
  twin->resume(body->checkpoint());
  EXPECT_EQ(twin->state_hash(), body->state_hash());
  const Advance next = contact_request(*body, 6.0, 12.0);
  step(*body, next, response);
  step(*twin, next, reply);
  EXPECT_EQ(twin->state_hash(), body->state_hash());
  EXPECT_EQ(response.ports[0].trace.f, reply.ports[0].trace.f);
}

TEST_P(Rewind, AWindowOfNoLengthReportsTheState) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam(), 0.5));
  const std::uint64_t hash = body->state_hash();
  Response response;
  step(*body, free_request(*body, 2.0, 2.0), response);
  EXPECT_EQ(response.steps, 0);
  EXPECT_EQ(body->state_hash(), hash);
  ASSERT_EQ(response.records.size(), 1u);
  EXPECT_NEAR(response.records[0].momentum[0], 20.0, roundoff(50, 20.0));  // 40 kg
  EXPECT_NEAR(response.records[0].energy.kinetic, 5.0, roundoff(100, 5.0));
  EXPECT_EQ(response.ports[0].trace.time, std::vector<double>{2.0});
  EXPECT_EQ(response.ports[0].lower.size(), 1u);
}

TEST_P(Rewind, SubstepsLandOnTheEndAndTheNominalStepStays) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam(), 0.5));
  double begin = 0.0;
  Response response;
  for (double end : {0.7, 0.71, 5.0, 5.0 + 0.6 * 7}) {
    step(*body, free_request(*body, begin, end), response);
    const std::vector<double>& times = response.ports[0].trace.time;
    EXPECT_EQ(times.back(), end);
    EXPECT_EQ(times, substep_times(begin, end, case_step));
    EXPECT_EQ(response.steps + 1, static_cast<int>(times.size()));
    EXPECT_EQ(body->describe().step, case_step);
    begin = end;
  }
}

TEST_P(Rewind, RecordsDivideTheWindowAndEachHasItsSweptRange) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam(), 0.5));
  Advance request = free_request(*body, 0.0, 12.0, 5);
  request.sampling = Sampling::records;
  Response response;
  step(*body, request, response);
  ASSERT_EQ(response.records.size(), 5u);
  EXPECT_EQ(response.records.back().time, 12.0);
  for (std::size_t p = 0; p < response.ports.size(); ++p) {
    const PortResponse& port = response.ports[p];
    const double at = body->describe().ports[p].geometry.points[0];
    ASSERT_EQ(port.lower.size(), 5u);
    ASSERT_EQ(port.upper.size(), 5u);
    EXPECT_EQ(port.trace.size(), 6u);  // begin and the records
    for (int i = 0; i < 5; ++i) {
      const std::size_t k = index(i);
      EXPECT_NEAR(response.records[k].time, 2.4 * (i + 1), roundoff(4, 12.0));
      // uniform flight at 0.5 m/s: the range of each part is where its ends are
      EXPECT_NEAR(port.lower[k], at + 1.2 * i, roundoff(200, 46.0));
      EXPECT_NEAR(port.upper[k], at + 1.2 * (i + 1), roundoff(200, 46.0));
    }
  }
}

TEST_P(Rewind, FreeFlightInOneRequestEqualsManyToRoundOff) {
  const std::unique_ptr<Subdomain> once = build_met(GetParam(), 0.02);
  const std::unique_ptr<Subdomain> often = build_met(GetParam(), 0.02);
  Response response, reply;
  for (Subdomain* body : {once.get(), often.get()})  // make them vibrate
    step(*body, contact_request(*body, 0.0, 6.0), response);
  Advance flight = free_request(*once, 6.0, 6.0 + 20 * 3.0, 20);
  flight.sampling = Sampling::records;
  step(*once, flight, response);
  for (int w = 0; w < 20; ++w)
    step(*often, free_request(*often, 6.0 + 3.0 * w, 6.0 + 3.0 * (w + 1)), reply);
  // 100 substeps of a few roundings each, sizes up to 1 m
  EXPECT_NEAR(response.ports[0].trace.u.back(), reply.ports[0].trace.u.back(), roundoff(2000, 1.0));
  EXPECT_NEAR(response.records.back().energy.total(), reply.records.back().energy.total(),
              roundoff(2000, 0.1));
}

TEST(Rewind, ACheckpointOfAnotherMeshIsRefused) {
  const SolverCase c = all_cases().front();
  BarText finer = case_bar(c);
  finer.elements = 50;
  const std::unique_ptr<Subdomain> body = build(case_bar(c));
  const std::unique_ptr<Subdomain> other = build(finer);
  const std::uint64_t hash = other->state_hash();
  EXPECT_THROW(other->resume(body->checkpoint()), RunError);
  EXPECT_EQ(other->state_hash(), hash);  // it is as before
}

TEST(Rewind, AStateThatIsNotFiniteIsAFailedValue) {
  const std::unique_ptr<Subdomain> body = build(case_bar(all_cases().front()));
  Advance request = free_request(*body, 0.0, 6.0);
  request.boundary[0].impulse = {std::numeric_limits<double>::infinity()};
  Response response;
  const Outcome outcome = body->advance(request, response);
  const Failed* failed = std::get_if<Failed>(&outcome);
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->cause, Failed::Cause::non_finite);
  EXPECT_NE(failed->detail.find("'bar'"), std::string::npos) << failed->detail;
  EXPECT_LE(failed->time, 6.0);
}

}  // namespace
}  // namespace abut::solver_rewind_tests
