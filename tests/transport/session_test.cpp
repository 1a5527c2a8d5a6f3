// Goal: what belongs to an earlier process of the same name is nobody's, whatever its number.
// Oracle: the values of the reply that is taken, the counts of what the body did.
#include <gtest/gtest.h>

#include <string>

#include "base/error.hpp"
#include "tests/transport/loop.hpp"

namespace abut::session_test {
namespace {

Frame sealed(const google::protobuf::MessageLite& message) {
  Frame frame;
  frame.seal(message);
  return frame;
}

/// The reply of a session to the first advance, with a step count of its own.
v1::Reply reply_of(std::uint64_t session, int steps) {
  FakeSubdomain body;
  Response response;
  const Advance advance = request_for(0);
  EXPECT_TRUE(std::holds_alternative<Advanced>(body.advance(advance, response)));
  response.steps = steps;
  v1::Reply reply;
  reply.set_number(2);
  reply.set_session(session);
  encode(response, advance, *reply.mutable_advanced());
  return reply;
}

TEST(Session, AStaleReplyOfAnEarlierSessionWithTheRightNumberIsNotTaken) {
  ConfiguredLoop loop;
  const Advance advance = request_for(0);
  Response response;
  // They lie in the channel before the request is sent: one of another session, one of none.
  loop.to_coordinator.send(sealed(reply_of(loop.server.session() + 2, 77)).bytes());
  loop.to_coordinator.send(sealed(reply_of(0, 78)).bytes());
  EXPECT_TRUE(std::holds_alternative<Advanced>(loop.body.advance(advance, response)));
  EXPECT_EQ(response.steps, 10);
  EXPECT_EQ(loop.caller.foreign(), 2);
  EXPECT_EQ(loop.fake->counts.advances, 1);
}

TEST(Session, RepliesOfAnEarlierSessionAmongFaultsAreNeverTaken) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const FaultyChannel::Chances rough{.drop = 0.1, .delay = 0.3, .duplicate = 0.3};
    Loop loop(rough, rough, seed);
    loop.configure();
    const v1::Reply stale = reply_of(loop.server.session() + 2, 77);
    loop.link.on_idle([&] {
      loop.to_coordinator.send(sealed(stale).bytes());
      loop.server.step(Milliseconds(0));
    });
    const Advance advance = request_for(0);
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(loop.body.advance(advance, response)));
    ASSERT_EQ(response.steps, 10) << "seed " << seed;
  }
}

TEST(Session, ProgressOfAnEarlierSessionDoesNotExtendTheDeadline) {
  ConfiguredLoop loop;
  loop.deaf = true;
  v1::Reply progress;
  progress.set_number(2);
  progress.set_session(loop.server.session() + 2);
  progress.mutable_progress();
  const TimePoint begin = loop.link.near().now();
  TimePoint next = begin;
  loop.link.on_idle([&] {
    if (loop.link.near().now() < next) return;
    next += Milliseconds(10'000);
    loop.link.far().send(sealed(progress).bytes());
  });
  Response response;
  const Advance advance = request_for(0);
  EXPECT_EQ(run_error([&] { (void)loop.body.advance(advance, response); }),
            "body 'fake' has not answered advance (request 2) within 60 s, nor shown progress; "
            "6 replies of another session came");
}

TEST(Session, ARequestToAnEarlierSolverOfThisNameIsNotExecuted) {
  ConfiguredLoop loop;
  v1::Request request;
  request.set_number(2);
  encode(request_for(0), *request.mutable_advance());
  for (const std::uint64_t session : {std::uint64_t{0}, loop.server.session() + 2}) {
    request.set_session(session);
    loop.link.near().send(sealed(request).bytes());
    EXPECT_FALSE(loop.link.near().receive(Milliseconds(1)).has_value());
  }
  EXPECT_EQ(loop.server.foreign(), 2);
  EXPECT_EQ(loop.fake->counts.advances, 0);
}

TEST(Session, AWelcomeOrARefusalToAnEarlierSolverOfThisNameIsNotHeard) {
  Loop loop;
  v1::Request welcome, refusal;
  welcome.set_session(loop.server.session() + 2);
  welcome.mutable_welcome();
  refusal.set_session(loop.server.session() + 2);
  refusal.mutable_refuse()->set_reason("it has taken part in another run");
  for (const v1::Request* request : {&welcome, &refusal}) {
    loop.link.near().send(sealed(*request).bytes());
    EXPECT_TRUE(loop.server.step(Milliseconds(0)));
  }
  EXPECT_EQ(loop.server.foreign(), 2);
  refusal.set_session(0);  // of a coordinator that could not read the Hello
  loop.link.near().send(sealed(refusal).bytes());
  EXPECT_THROW(loop.server.step(Milliseconds(0)), CoordinatorLost);
}

TEST(Session, ASolverThatWasRestartedIsNamedAndItsRepliesAreNotTaken) {
  ConfiguredLoop loop;
  loop.deaf = true;  // it is gone; another of its name greets, and answers what it never did
  v1::Reply hello;
  hello.set_session(loop.server.session() + 2);
  hello.mutable_hello()->set_session(loop.server.session() + 2);
  loop.to_coordinator.send(sealed(reply_of(loop.server.session() + 2, 77)).bytes());
  loop.to_coordinator.send(sealed(hello).bytes());
  Response response;
  const Advance advance = request_for(0);
  EXPECT_EQ(run_error([&] { (void)loop.body.advance(advance, response); }),
            "a second solver with the name of body 'fake' has connected");
  EXPECT_EQ(loop.caller.foreign(), 1);
}

TEST(Session, EveryServerDrawsItsOwn) {
  const Loop one, other;
  EXPECT_NE(one.server.session(), 0u);
  EXPECT_NE(one.server.session(), other.server.session());
}

TEST(Remote, PartnersAndHowTheyYieldReachTheBody) {
  ConfiguredLoop loop;
  PortGeometry wall;
  wall.points = {0.5};
  wall.normals = {-1.0};
  loop.body.meet({0, 0, &wall, {true}});
  PortKernel kernel;
  kernel.step = 0.1;
  kernel.displacement = {1.0, 2.0};
  loop.body.meet({0, 0, nullptr, {}, &kernel});
  EXPECT_EQ(loop.fake->counts.meetings, 1);
  EXPECT_EQ(loop.fake->counts.kernels_told, 1);
  Advance advance = request_for(0);
  advance.boundary[0].obstacles.resize(1);
  Waveform& motion = advance.boundary[0].obstacles[0].motion;
  motion.time = {advance.window.begin, advance.window.end};
  motion.u = {0.0, 0.0};
  Response response;
  EXPECT_TRUE(std::holds_alternative<Advanced>(loop.body.advance(advance, response)));
  EXPECT_EQ(response.ports[0].reactions.at(0).force.time, motion.time);
}

TEST(Remote, AnObstacleThatWasNeverMetIsAFaultThatNamesTheField) {
  ConfiguredLoop loop;
  Advance advance = request_for(0);
  advance.boundary[0].obstacles.resize(1);
  advance.boundary[0].obstacles[0].motion.time = {0.0, 0.1};
  advance.boundary[0].obstacles[0].motion.u = {0.0, 0.0};
  Response response;
  EXPECT_EQ(run_error([&] { (void)loop.body.advance(advance, response); }),
            "body 'fake' failed at advance (request 2): unsound request: "
            "advance.boundary[0].obstacles[0] is of nobody: the port has met 0 partners");
}

TEST(Remote, AKernelThatNoFrameHoldsIsRefusedBeforeItIsMade) {
  ConfiguredLoop loop(1000);
  EXPECT_NE(run_error([&] {
              loop.body.probe({0, {1.0}, 0.1, 1000});
            }).find("above the limit of 1000"),
            std::string::npos);
  EXPECT_EQ(loop.fake->counts.kernels, 0);
}

}  // namespace
}  // namespace abut::session_test
