#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include <zmq.hpp>

#include "messaging/zmq_monitor.hpp"

namespace abut {

/// Ends connections over TCP of which nobody known has sent anything and that send more than a
/// Hello is long. libzmq knows one limit of frames for all connections and reads whatever comes
/// below it, also while nobody asks; so a thread of its own looks at the bytes of each connection
/// as they arrive. Connections that are known cost nothing; those of one machine (ipc) lie in a
/// private directory and are not looked at.
class ConnectionGuard {
 public:
  /// `most_bytes`: that a connection may receive before it is known.
  ConnectionGuard(zmq::context_t& context, zmq::socket_t& watched, std::size_t most_bytes);
  ~ConnectionGuard();
  ConnectionGuard(const ConnectionGuard&) = delete;
  ConnectionGuard& operator=(const ConnectionGuard&) = delete;

  /// Connections of which nobody known has sent anything.
  int unknown() const { return unknown_.load(std::memory_order_relaxed); }
  /// The peer of this number has sent a frame over this connection.
  void know(int descriptor, int peer);
  /// The next connection that has ended, never waiting: of somebody known, or of somebody who may
  /// have been coming back.
  std::optional<int> next_ended();

 private:
  struct Connection {
    std::optional<int> peer;  // absent: unknown
    bool granted = false;     // may be a peer that comes back, whose first frame may be a long one
    bool watched = false;     // over TCP
  };
  struct Early {  // a frame has come before the begin has been reported
    int peer = 0;
    std::chrono::steady_clock::time_point when;
  };
  void run();
  void see(const ZmqMonitor::Event& event);
  void accept(int descriptor);
  void end(int descriptor);
  void judge(int descriptor);
  bool may_be_back(Connection& connection);
  void count_unknown();

  std::size_t most_bytes_;
  ZmqMonitor monitor_;
  int poll_ = -1, stop_ = -1;
  std::mutex mutex_;                // of what follows
  std::map<int, Connection> open_;  // by descriptor
  std::map<int, Early> early_;      // by descriptor
  std::deque<int> ended_;
  std::set<int> lost_;  // peers whose connection has ended, and that are not back
  std::atomic<int> unknown_ = 0;
  std::thread thread_;  // last: it uses the others
};

}  // namespace abut
