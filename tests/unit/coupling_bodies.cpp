// Goal: what is known of a body that fails is its last answer, however much of another one it left.
// Oracle: a point mass under an infinite impulse.

#include "coordinator/coupling/bodies.hpp"

#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/fakes.hpp"

namespace abut::coupling_bodies_tests {
namespace {

// A body in this process leaves in a response what it had come to when it failed; one in its own
// process sends nothing. What is read later must be the same.
TEST(Bodies, KeepTheLastAnswerOfABodyThatFails) {
  FakeSubdomain mass;
  Bodies bodies({&mass}, 1.0);
  bodies.prepare({0, 0.0, 1.0}, 1, Sampling::substeps);
  ASSERT_FALSE(bodies.advance_all());
  const std::vector<double> before = bodies.response(0).ports[0].trace.u;
  const double speed = bodies.response(0).ports[0].speed_bound;

  bodies.prepare({1, 1.0, 2.0}, 1, Sampling::substeps);
  bodies.boundary({0, 0}).impulse = {std::numeric_limits<double>::infinity()};
  const std::optional<Failed> failed = bodies.advance_all();
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->detail, "body 'fake': the mass is lost");
  EXPECT_EQ(bodies.response(0).ports[0].trace.u, before);
  EXPECT_EQ(bodies.response(0).ports[0].speed_bound, speed);
  EXPECT_EQ(bodies.response(0).records.back().time, 1.0);
}

}  // namespace
}  // namespace abut::coupling_bodies_tests
