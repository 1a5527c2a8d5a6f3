#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <zmq.hpp>

#include "messaging/channel.hpp"
#include "messaging/protocol.hpp"
#include "messaging/zmq_monitor.hpp"

namespace abut {

/// The coordinator's socket: one ROUTER that serves all bodies, each through a channel of its own.
/// A frame that arrives for another body than the one waited for is kept for it.
class ZmqHub {
 public:
  explicit ZmqHub(const Limits& limits);
  ~ZmqHub();
  ZmqHub(const ZmqHub&) = delete;
  ZmqHub& operator=(const ZmqHub&) = delete;

  /// Listens at "ipc://path" or "tcp://interface:port"; answers the endpoint with its port filled
  /// in. Throws InputError when the endpoint cannot be had.
  std::string bind(const std::string& endpoint);
  /// Adds the peer whose routing id is `name`; peers are numbered from 0 in the order of these
  /// calls.
  int add_peer(const std::string& name);
  Channel& channel(int peer);

  /// Receives at most one frame and keeps it for its peer; false when none came within `wait`.
  bool pump(Milliseconds wait);
  /// A frame from a routing id that is no peer's, or nothing.
  std::optional<std::pair<std::string, std::vector<std::byte>>> take_stranger();
  bool send_to(const std::string& routing_id, Bytes frame);
  bool send_to(const std::string& routing_id, Bytes frame, std::shared_ptr<const void> owner);

  /// How often a peer's connection has ended since `since`.
  int disconnects(int peer, TimePoint since);
  /// Since when the peer has had no connection; nothing while it has one.
  std::optional<TimePoint> gone_since(int peer);

 private:
  struct Peer;
  bool receive_for(int wanted, Milliseconds wait);
  bool receive_message(Milliseconds wait);
  int find_sender() const;
  void keep_stranger();
  void read_monitor();

  zmq::context_t context_;
  zmq::socket_t socket_;
  std::unique_ptr<ZmqMonitor> monitor_;
  int receive_timeout_ = -1;  // [ms] as set on the socket
  std::vector<std::unique_ptr<Peer>> peers_;
  std::deque<std::pair<std::string, std::vector<std::byte>>> strangers_;
  zmq::message_t sender_, incoming_;
};

/// A solver's socket: one DEALER whose routing id is the body's name.
class ZmqDealer : public Channel {
 public:
  ZmqDealer(const std::string& endpoint, const std::string& body, const Limits& limits);
  ~ZmqDealer() override;
  bool send(Bytes frame) override;
  bool send(Bytes frame, std::shared_ptr<const void> owner) override;
  std::optional<Bytes> receive(Milliseconds wait) override;

  bool connected();
  /// Since when there has been no connection; nothing while there is one or before the first.
  std::optional<TimePoint> gone_since();

 private:
  void read_monitor();

  zmq::context_t context_;
  zmq::socket_t socket_;
  std::unique_ptr<ZmqMonitor> monitor_;
  int receive_timeout_ = -1;  // [ms] as set on the socket
  bool connected_ = false;
  std::optional<TimePoint> gone_since_;
  zmq::message_t current_;
};

}  // namespace abut
