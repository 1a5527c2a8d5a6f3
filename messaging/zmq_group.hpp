#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/body_group.hpp"
#include "messaging/channel.hpp"
#include "messaging/zmq_dealer.hpp"

namespace abut {

/// The bodies of one process behind its one connection, each with a channel of its own: a part with
/// the body's name stands before every frame.
class ZmqGroup : public BodyGroup {
 public:
  /// The dealer must outlive this object.
  ZmqGroup(ZmqDealer& dealer, const std::vector<std::string>& bodies);
  ~ZmqGroup() override;
  ZmqGroup(const ZmqGroup&) = delete;
  ZmqGroup& operator=(const ZmqGroup&) = delete;

  /// Bodies are numbered in the order of the constructor. A channel receives what wait() has
  /// brought, and never waits itself.
  Channel& channel(std::size_t body) override;
  std::optional<std::size_t> wait(Milliseconds time) override;

 private:
  struct Member;
  ZmqDealer& dealer_;
  std::vector<std::unique_ptr<Member>> members_;
  std::map<std::string, std::size_t, std::less<>> numbers_;  // of the members, by name
};

}  // namespace abut
