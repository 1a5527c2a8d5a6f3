#pragma once

#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "messaging/codec.hpp"
#include "messaging/faulty_channel.hpp"
#include "messaging/frame.hpp"
#include "messaging/memory_channel.hpp"
#include "messaging/remote_subdomain.hpp"
#include "messaging/serve.hpp"
#include "tests/support/fakes.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace abut {

/// Coordinator's and solver's side of the wire in one thread, on a clock that moves only while the
/// coordinator waits in vain: minutes of deadlines pass in no time, and a seed says it all.
template <class Body>
struct LoopOf {
  explicit LoopOf(const FaultyChannel::Chances& there = {}, const FaultyChannel::Chances& back = {},
                  std::uint64_t seed = 0, const Limits& limits = {})
      : to_solver(link.near(), there, seed),
        to_coordinator(link.far(), back, seed + 1),
        server(
            "fake",
            [this](const Specification& got, const ProgressHook& hook) {
              specification = got;
              progress = hook;
              std::unique_ptr<Body> made = std::make_unique<Body>();
              fake = made.get();
              return std::unique_ptr<Subdomain>(std::move(made));
            },
            to_coordinator, alive, limits, Deadlines{}),
        caller("fake", CallContext{to_solver, alive, nullptr, limits, Deadlines{}}),
        body(caller) {
    link.on_idle([this] {
      if (!deaf) server.step(Milliseconds(0));
    });
  }

  void configure() {
    caller.accept_session(server.session());
    body.start_configure(Specification{"scene.yaml", "text", {"a.b=1"}, "bodies.fake"});
    body.finish_configure();
  }

  AlwaysAlive alive;
  MemoryLink link;
  FaultyChannel to_solver, to_coordinator;
  Body* fake = nullptr;  // made by Configure
  Specification specification;    // as the solver got it
  ProgressHook progress;
  bool deaf = false;  // the solver lives, but never looks at its messages
  Server server;
  Caller caller;
  RemoteSubdomain body;
};
using Loop = LoopOf<FakeSubdomain>;

/// One whose body is there; frames hold so many bytes.
struct ConfiguredLoop : Loop {
  explicit ConfiguredLoop(std::size_t frame_bytes = Limits().frame_bytes)
      : Loop({}, {}, 0, limits_of(frame_bytes)) {
    configure();
  }
  static Limits limits_of(std::size_t frame_bytes) {
    Limits limits;
    limits.frame_bytes = frame_bytes;
    return limits;
  }
};

/// A request with a force that depends on the window, so that no two windows are alike.
inline Advance request_for(int window) {
  Advance advance;
  advance.window = TimeWindow{window, 0.1 * window, 0.1 * (window + 1)};
  advance.records = 2;
  advance.boundary.resize(1);
  advance.boundary[0].forces.resize(1);
  Waveform& force = advance.boundary[0].forces[0];
  force.time = {advance.window.begin, advance.window.end};
  force.f = {1.0 + window, -0.5 * window};
  return advance;
}

inline void advance_once(Loop& loop) {
  Response response;
  EXPECT_TRUE(std::holds_alternative<Advanced>(loop.body.advance(request_for(0), response)));
}

/// What is wrong, and the remedy behind a bar where `remedy` asks for it.
inline std::string run_error(const std::function<void()>& act, bool remedy = false) {
  try {
    act();
  } catch (const RunError& error) {
    return error.what_is_wrong + (remedy ? " | " + error.remedy : "");
  }
  return "no error";
}

}  // namespace abut
