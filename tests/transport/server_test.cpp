// Goal: each way in which a peer can misbehave ends in one named error within the deadline, and
// only those. Oracle: the kind of error, the words that name body and request, and the hand-run
// clock.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <thread>

#include "base/error.hpp"
#include "tests/transport/loop.hpp"

namespace abut::server_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Serve, TheBodyIsMadeFromTheSpecificationThatWasSent) {
  ConfiguredLoop loop;
  EXPECT_EQ(loop.specification.document, "scene.yaml");
  EXPECT_EQ(loop.specification.text, "text");
  EXPECT_EQ(loop.specification.overrides, std::vector<std::string>{"a.b=1"});
  EXPECT_EQ(loop.specification.path, "bodies.fake");
  EXPECT_EQ(loop.body.describe().model, "point mass on a spring");
}

TEST(Serve, TheMakingOfABodyShowsThatItGoesOn) {
  MemoryLink link;  // with real threads and the real clock
  AlwaysAlive alive;
  Deadlines deadlines;
  deadlines.progress = Milliseconds(5);
  std::atomic<bool> seen = false;  // a sign of life, by the coordinator
  Server server(
      "fake",
      [&seen](const Specification&, const ProgressHook&) {
        while (!seen) std::this_thread::sleep_for(Milliseconds(1));  // a large mesh
        return std::unique_ptr<Subdomain>(std::make_unique<FakeSubdomain>());
      },
      link.far(), alive, Limits{}, deadlines);
  std::thread solver([&server] { server.step(Milliseconds(60'000)); });
  v1::Request request;
  request.set_number(1);
  request.set_session(server.session());
  request.mutable_configure()->set_path("bodies.fake");
  Frame frame;
  frame.seal(request);
  link.near().send(frame.bytes());
  v1::Reply reply;
  for (int frames = 0; !reply.has_configured() && frames < 10'000; ++frames) {
    const std::optional<Bytes> got = link.near().receive(Milliseconds(60'000));
    ASSERT_TRUE(got && parse_into(reply, *open_frame(*got)));
    EXPECT_EQ(reply.number(), 1u);
    seen = seen || reply.has_progress();
  }
  solver.join();
  EXPECT_TRUE(seen);
  EXPECT_TRUE(reply.has_configured());
}

TEST(Serve, RepeatedRequestRunsOnce) {
  ConfiguredLoop loop;
  v1::Request request;
  request.set_number(2);
  request.set_session(loop.server.session());
  const Advance advance = request_for(0);
  encode(advance, *request.mutable_advance());
  Frame frame;
  frame.seal(request);
  std::string replies[2];
  for (std::string& reply : replies) {
    loop.link.near().send(frame.bytes());
    const std::optional<Bytes> got = loop.link.near().receive(Milliseconds(1));
    ASSERT_TRUE(got.has_value());
    reply.assign(reinterpret_cast<const char*>(got->data()), got->size());
  }
  EXPECT_EQ(replies[0], replies[1]);
  EXPECT_EQ(loop.fake->counts.advances, 1);
}

TEST(Serve, AGapInTheNumbersIsAFault) {
  ConfiguredLoop loop;
  v1::Request request;
  request.set_number(9);
  request.set_session(loop.server.session());
  request.mutable_ping();
  Frame frame;
  frame.seal(request);
  loop.link.near().send(frame.bytes());
  const std::optional<Bytes> got = loop.link.near().receive(Milliseconds(1));
  v1::Reply reply;
  ASSERT_TRUE(got && parse_into(reply, *open_frame(*got)));
  EXPECT_EQ(reply.fault().kind(), v1::FAULT_KIND_RUN);
  EXPECT_TRUE(contains(reply.fault().what(), "request 9 follows request 1"))
      << reply.fault().what();
}

// Goal: a stranger's request cannot end the solver: what comes before any save is a fault, and the
// body serves on. Oracle: the kind of the reply.
TEST(Serve, ARestoreBeforeAnySaveIsAFault) {
  ConfiguredLoop loop;
  const auto answer_to = [&loop](std::uint64_t number, bool restore) {
    v1::Request request;
    request.set_number(number);
    request.set_session(loop.server.session());
    request.set_restore_first(restore);
    request.mutable_hash();
    Frame frame;
    frame.seal(request);
    loop.link.near().send(frame.bytes());
    const std::optional<Bytes> got = loop.link.near().receive(Milliseconds(1));
    v1::Reply reply;
    EXPECT_TRUE(got && parse_into(reply, *open_frame(*got)));
    return reply;
  };
  const v1::Reply fault = answer_to(2, true);
  EXPECT_EQ(fault.fault().kind(), v1::FAULT_KIND_RUN);
  EXPECT_TRUE(contains(fault.fault().what(), "before any save")) << fault.fault().what();
  EXPECT_TRUE(answer_to(3, false).has_hash());
}

TEST(Serve, AFailedSolveIsAValueAndTheBodyServesOn) {
  ConfiguredLoop loop;
  loop.body.save();
  Advance hopeless = request_for(0);
  hopeless.boundary[0].impulse = {1.0e149};
  Response response;
  const Outcome outcome = loop.body.advance(hopeless, response);
  ASSERT_TRUE(std::holds_alternative<Failed>(outcome));
  EXPECT_EQ(std::get<Failed>(outcome).cause, Failed::Cause::non_finite);
  EXPECT_EQ(std::get<Failed>(outcome).detail, "the mass is lost");
  loop.body.restore();
  advance_once(loop);
}

TEST(Serve, TheBodysInputErrorArrivesWithItsThreeParts) {
  ConfiguredLoop loop;
  loop.fake->during_substep = [] { throw InputError("wrong", "scene.yaml:3", "mend it"); };
  try {
    advance_once(loop);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what_is_wrong, "wrong");
    EXPECT_EQ(error.where, "scene.yaml:3");
    EXPECT_EQ(error.remedy, "mend it");
  }
}

TEST(Serve, AnExceptionInTheBodyNamesBodyAndRequest) {
  ConfiguredLoop loop;
  loop.fake->during_substep = [] { throw std::out_of_range("index 7"); };
  EXPECT_EQ(run_error([&loop] { advance_once(loop); }),
            "body 'fake' failed at advance (request 2): index 7");
}

TEST(Serve, AReplyAboveTheLimitIsNamedWithItsSize) {
  ConfiguredLoop loop(1000);
  Advance many = request_for(0);
  many.records = 1000;  // of some 40 bytes each
  Response response;
  const std::string error = run_error([&] { (void)loop.body.advance(many, response); });
  EXPECT_TRUE(contains(error, "body 'fake'") && contains(error, "above the limit of 1000"))
      << error;
}

TEST(Caller, ARequestAboveTheLimitIsNamedWithItsSize) {
  ConfiguredLoop loop(1000);
  Advance large = request_for(0);
  Waveform& force = large.boundary[0].forces[0];
  force.clear();
  for (int i = 0; i < 1000; ++i) {
    force.time.push_back(i);
    force.f.push_back(1.0);
  }
  Response response;
  const std::string error = run_error([&] { (void)loop.body.advance(large, response); });
  EXPECT_TRUE(contains(error, "advance (request 2) for body 'fake'") &&
              contains(error, "above the limit of 1000"))
      << error;
}

TEST(Caller, NaNInAReplyIsRefusedByName) {
  ConfiguredLoop loop;
  v1::Reply reply;
  reply.set_number(2);
  reply.set_session(loop.server.session());
  Response response;
  FakeSubdomain body;
  const Advance advance = request_for(0);
  EXPECT_TRUE(std::holds_alternative<Advanced>(body.advance(advance, response)));
  response.ports[0].trace.v[4] = std::numeric_limits<double>::quiet_NaN();
  encode(response, advance, *reply.mutable_advanced());
  Frame frame;
  frame.seal(reply);
  loop.deaf = true;
  loop.body.start(advance);
  loop.link.far().send(frame.bytes());
  EXPECT_EQ(
      run_error([&] { (void)loop.body.finish(response); }),
      "body 'fake' gave no sound answer to advance (request 2): advanced.ports[0].trace.v is not "
      "finite: entry 4 is nan");
}

TEST(Caller, APeerThatLivesButDoesNotAnswerIsGivenUpAtTheDeadline) {
  ConfiguredLoop loop;
  loop.deaf = true;
  const TimePoint begin = loop.link.near().now();
  EXPECT_EQ(run_error([&loop] { advance_once(loop); }),
            "body 'fake' has not answered advance (request 2) within 60 s, nor shown progress");
  const TimePoint::duration waited = loop.link.near().now() - begin;
  EXPECT_GE(waited, Deadlines{}.request);
  EXPECT_LE(waited, Deadlines{}.request + Deadlines{}.slice);  // one look may come late
}

TEST(Caller, ProgressExtendsTheDeadline) {
  // The far end shows progress every 50 s of the hand-run clock and answers after 200 s.
  ConfiguredLoop loop;
  loop.deaf = true;
  Channel& near = loop.link.near();
  const TimePoint begin = near.now();
  TimePoint next = begin + std::chrono::seconds(50);
  v1::Reply progress;
  progress.set_number(2);
  progress.set_session(loop.server.session());
  progress.mutable_progress();
  Frame frame;
  frame.seal(progress);
  loop.link.on_idle([&] {
    if (near.now() >= begin + std::chrono::seconds(200)) {
      loop.server.step(Milliseconds(0));
    } else if (near.now() >= next) {
      next += std::chrono::seconds(50);
      loop.link.far().send(frame.bytes());
    }
  });
  advance_once(loop);
  EXPECT_GE(near.now() - begin, std::chrono::seconds(200));
  EXPECT_EQ(loop.fake->counts.advances, 1);
}

TEST(Caller, ARequestIsNotRepeatedToABodyThatShowsProgress) {
  // A sign every second for an hour: repeats would fill the queue of a body that cannot look at it.
  ConfiguredLoop loop;
  Channel& near = loop.link.near();
  const TimePoint begin = near.now();
  TimePoint next = begin + Deadlines{}.progress;
  v1::Reply progress;
  progress.set_number(2);
  progress.set_session(loop.server.session());
  progress.mutable_progress();
  Frame frame;
  frame.seal(progress);
  loop.link.on_idle([&] {
    if (near.now() >= begin + std::chrono::hours(1)) {
      loop.server.step(Milliseconds(0));
    } else if (near.now() >= next) {
      next += Deadlines{}.progress;
      loop.link.far().send(frame.bytes());
    }
  });
  const int before = loop.to_solver.counts().sent;
  advance_once(loop);
  EXPECT_EQ(loop.to_solver.counts().sent - before, 1);
  EXPECT_EQ(loop.fake->counts.advances, 1);
}

TEST(Serve, TheHookShowsProgressAtMostFourTimesASecond) {
  // 10 substeps of 0.1 s: signs are due at 0.25, 0.5 and 0.75 s.
  ConfiguredLoop loop;
  int signs = 0;
  loop.fake->during_substep = [&loop] {
    loop.link.on_idle([] {});
    (void)loop.link.near().receive(Milliseconds(100));  // turns the clock, and takes what has come
    loop.progress();
  };
  v1::Request request;
  request.set_number(2);
  request.set_session(loop.server.session());
  const Advance advance = request_for(0);
  encode(advance, *request.mutable_advance());
  Frame frame;
  frame.seal(request);
  loop.link.near().send(frame.bytes());
  const int before = loop.to_coordinator.counts().sent;
  loop.server.step(Milliseconds(0));
  signs = loop.to_coordinator.counts().sent - before - 1;  // one is the reply
  EXPECT_GE(signs, 2);
  EXPECT_LE(signs, 4);  // 1 s of solving
}

TEST(Caller, APeerThatSendsOnlyCorruptFramesIsGivenUpWithSizeAndLimit) {
  ConfiguredLoop loop;
  loop.deaf = true;
  const std::vector<std::byte> noise(77, std::byte{0x5a});
  loop.link.on_idle([&] { loop.link.far().send(noise); });
  EXPECT_EQ(
      run_error([&loop] { advance_once(loop); }),
      "body 'fake' sent 16 corrupt frames while at advance (request 2), the last one of 77 bytes "
      "(limit 268435456 bytes)");
}

TEST(Caller, ASecondSolverOfTheSameNameIsAnError) {
  ConfiguredLoop loop;
  loop.caller.accept_session(1);
  loop.deaf = true;
  v1::Reply hello;
  hello.mutable_hello()->set_session(2);
  Frame frame;
  frame.seal(hello);
  loop.link.on_idle([&] { loop.link.far().send(frame.bytes()); });
  EXPECT_EQ(run_error([&loop] { advance_once(loop); }),
            "a second solver with the name of body 'fake' has connected");
}

TEST(Caller, AnInterruptEndsTheWaitAtOnce) {
  ConfiguredLoop loop;
  loop.deaf = true;
  const std::atomic<bool> interrupted{true};
  Caller caller("fake",
                CallContext{loop.to_solver, loop.alive, &interrupted, Limits{}, Deadlines{}});
  caller.accept_session(1);
  caller.request().mutable_ping();
  const TimePoint begin = loop.link.near().now();
  EXPECT_EQ(run_error([&caller] { caller.call("ping"); }),
            "interrupted while body 'fake' was at ping (request 1)");
  EXPECT_LE(loop.link.near().now() - begin, Deadlines{}.slice);
}

TEST(Serve, WorksInAThreadOfItsOwn) {
  MemoryLink link;
  AlwaysAlive alive;
  Server server(
      "fake",
      [](const Specification&, const ProgressHook&) {
        return std::unique_ptr<Subdomain>(std::make_unique<FakeSubdomain>());
      },
      link.far(), alive, Limits{}, Deadlines{});
  std::thread solver([&server] {
    while (server.step(Milliseconds(100))) {
    }
  });
  Caller caller("fake", CallContext{link.near(), alive, nullptr, Limits{}, Deadlines{}});
  caller.accept_session(server.session());
  RemoteSubdomain body(caller);
  body.start_configure(Specification{});
  body.finish_configure();
  FakeSubdomain local;
  Response response;
  for (int window = 0; window < 10; ++window) {
    const Advance advance = request_for(window);
    EXPECT_TRUE(std::holds_alternative<Advanced>(body.advance(advance, response)));
    EXPECT_TRUE(std::holds_alternative<Advanced>(local.advance(advance, response)));
  }
  EXPECT_EQ(body.state_hash(), local.state_hash());
  caller.request().mutable_finish();
  EXPECT_TRUE(caller.call("finish").has_finished());
  solver.join();
}

TEST(Serve, ALostCoordinatorEndsTheSolveItself) {
  struct Fading : Liveness {
    std::string loss(TimePoint) override { return gone ? "is gone" : ""; }
    bool gone = false;
  } coordinator;
  MemoryLink link;
  Deadlines deadlines;
  deadlines.progress = Milliseconds(0);  // a sign of progress, and a look, at every substep
  int substeps = 0;
  Server server(
      "fake",
      [&substeps, &coordinator](const Specification&, const ProgressHook& hook) {
        std::unique_ptr<FakeSubdomain> body = std::make_unique<FakeSubdomain>();
        body->during_substep = [&substeps, &coordinator, hook] {
          coordinator.gone = ++substeps == 4;
          hook();
        };
        return std::unique_ptr<Subdomain>(std::move(body));
      },
      link.far(), coordinator, Limits{}, deadlines);
  v1::Request request;
  Frame frame;
  request.set_session(server.session());
  request.set_number(1);
  request.mutable_configure();
  frame.seal(request);
  link.near().send(frame.bytes());
  EXPECT_TRUE(server.step(Milliseconds(0)));
  request.set_number(2);
  const Advance advance = request_for(0);
  encode(advance, *request.mutable_advance());
  frame.seal(request);
  link.near().send(frame.bytes());
  EXPECT_THROW(server.step(Milliseconds(0)), CoordinatorLost);
  EXPECT_EQ(substeps, 4);  // of ten
}

TEST(Serve, NoCoordinatorWithinPatienceIsNamed) {
  MemoryLink link;
  AlwaysAlive alive;
  Deadlines deadlines;
  deadlines.slice = Milliseconds(5);
  Server server("fake", MakeBody{}, link.far(), alive, Limits{}, deadlines);
  EXPECT_EQ(run_error([&server] { server.greet(Milliseconds(20)); }),
            "no coordinator has answered body 'fake' within 0.02 s");
}

}  // namespace
}  // namespace abut::server_test
