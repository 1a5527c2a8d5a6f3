#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "messaging/channel.hpp"
#include "messaging/child_process.hpp"
#include "messaging/linked_bodies.hpp"
#include "messaging/protocol.hpp"
#include "messaging/zmq_channel.hpp"
#include "messaging/zmq_dealer.hpp"

namespace abut {

/// Tells why a peer can no longer answer. Asked only when a wait has timed out, so it costs nothing
/// while messages flow. A long solve is no reason: the peer's I/O thread answers heartbeats
/// meanwhile.
class Liveness {
 public:
  virtual ~Liveness() = default;
  /// Empty while the peer may still answer; else a predicate: "was killed by signal 9 (Killed)".
  /// `since` is when the wait began.
  virtual std::string loss(TimePoint since) = 0;
  /// When something last came from a process that serves several bodies one after the other: whose
  /// turn has not come need not answer. The clock's begin: never, or the peer shares no process.
  virtual TimePoint last_sign() { return {}; }
};

/// For peers that share this process.
class AlwaysAlive : public Liveness {
 public:
  std::string loss(TimePoint) override { return {}; }
};

/// The coordinator's view of one body: its process, if the coordinator started it, and its
/// connection.
class BodyLiveness : public Liveness {
 public:
  /// `child` may be null: somebody else started the solver. `shares`: with whom the body shares its
  /// process, for messages; empty: with nobody. `linked`: where its frames pass; null: by the hub.
  BodyLiveness(ZmqHub& hub, int peer, ChildProcess* child, std::string shares, const Limits& limits,
               const Deadlines& deadlines, const LinkedBodies* linked = nullptr);
  std::string loss(TimePoint since) override;
  TimePoint last_sign() override;

 private:
  std::string loss_of_process(TimePoint since);
  std::string why_it_left() const;

  ZmqHub& hub_;
  int peer_;
  ChildProcess* child_;
  std::string shares_;
  Limits limits_;
  Deadlines deadlines_;
  const LinkedBodies* linked_;
  TimePoint asked_{};            // whoever waits asks again and again
  Milliseconds stood_still_{0};  // before it was asked last
};

/// The solver's view of its coordinator.
class CoordinatorLiveness : public Liveness {
 public:
  /// `linked`: where its frames pass; null: by the dealer.
  CoordinatorLiveness(ZmqDealer& dealer, const std::string& endpoint, const Deadlines& deadlines,
                      const LinkedBodies* linked = nullptr);
  std::string loss(TimePoint since) override;

 private:
  ZmqDealer& dealer_;
  Milliseconds grace_;
  const LinkedBodies* linked_;
};

}  // namespace abut
