#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/channel.hpp"
#include "messaging/zmq_dealer.hpp"

namespace abut {

/// The bodies of one process behind its one connection, each with a channel of its own: a part with
/// the body's name stands before every frame.
class ZmqGroup {
 public:
  /// The dealer must outlive this object.
  ZmqGroup(ZmqDealer& dealer, const std::vector<std::string>& bodies);
  ~ZmqGroup();
  ZmqGroup(const ZmqGroup&) = delete;
  ZmqGroup& operator=(const ZmqGroup&) = delete;

  /// Bodies are numbered from 0 in the order of the constructor. A channel receives what wait() has
  /// brought, and never waits itself.
  Channel& channel(std::size_t body);
  /// Waits for a frame of any of them; tells whose it is. Nothing when none came.
  std::optional<std::size_t> wait(Milliseconds time);

 private:
  struct Member;
  ZmqDealer& dealer_;
  std::vector<std::unique_ptr<Member>> members_;
  std::map<std::string, std::size_t, std::less<>> numbers_;  // of the members, by name
};

}  // namespace abut
