#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "coordinator/ssh_launch.hpp"
#include "messaging/child_process.hpp"
#include "messaging/linked_bodies.hpp"

namespace abut {

/// A process that a launch starts or waits for, and the bodies in it.
struct LaunchedProcess {
  std::string program;
  bool ours = false;             // abut-solver of this machine
  bool awaited = false;          // somebody else starts it
  std::optional<SshLaunch> ssh;  // absent: on this machine
  std::string routing_id;        // of several bodies; empty: the name of its one body
  std::vector<std::string> bodies;
  std::unique_ptr<ChildProcess> child;   // over ssh: that of ssh; null: it is awaited
  std::unique_ptr<LinkedBodies> linked;  // null: its frames pass through sockets
  std::optional<TimePoint> started;      // absent: its turn has not come
  bool has_scene = false;                // its text is under way or there

  /// Starts it, to connect to the socket at this path. Throws RunError.
  void start(const std::string& socket);
  /// With whom the body shares it, for messages; empty: with nobody.
  std::string others_than(const std::string& body) const;
  /// It has ended before the body had connected: why, as far as that is known.
  RunError ended_early(const std::string& body) const;
};

}  // namespace abut
