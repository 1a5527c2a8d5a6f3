#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <zmq.hpp>

#include "messaging/channel.hpp"
#include "messaging/connection_guard.hpp"
#include "messaging/protocol.hpp"
#include "messaging/zmq_monitor.hpp"

namespace abut {

/// The coordinator's socket: one ROUTER that serves all bodies, each through a channel of its own.
/// A frame that arrives for another body than the one waited for is kept for it. Bodies that share
/// a process share its connection, where a part with the body's name stands before the frame.
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
  /// calls, all of them before bind().
  int add_peer(const std::string& name);
  /// Adds the peer `name` behind the connection whose routing id is `process`.
  int add_peer(const std::string& name, const std::string& process);
  Channel& channel(int peer);

  /// Receives at most one frame and keeps it for its peer; false when none came within `wait`.
  bool pump(Milliseconds wait);
  /// Whether a frame is kept for the peer.
  bool has_frame(int peer) const;
  /// A frame from a routing id that is no peer's, or nothing.
  std::optional<std::pair<std::string, std::vector<std::byte>>> take_stranger();
  bool send_to(const std::string& routing_id, Bytes frame);

  /// When a frame last came over the connection that the peer shares with others; the clock's
  /// begin: never, or it shares none.
  TimePoint last_frame(int peer) const;
  /// How often a peer's connection has ended since `since`.
  int disconnects(int peer, TimePoint since);
  /// Since when the peer has had no connection; nothing while it has one.
  std::optional<TimePoint> gone_since(int peer);

 private:
  struct Connection;
  struct Peer;
  bool send_head(const Connection& connection, const std::string& name);
  bool receive_for(int wanted, Milliseconds wait);
  bool receive_message(Milliseconds wait);
  Peer* find_sender();
  void keep_stranger();
  void keep_waiting(Peer& peer);
  void note_descriptor(Connection& connection);
  void read_monitor();

  zmq::context_t context_;
  zmq::socket_t socket_;
  std::unique_ptr<ConnectionGuard> guard_;
  int receive_timeout_ = -1;  // [ms] as set on the socket
  std::map<std::string, Connection, std::less<>> connections_;  // by routing id
  std::vector<std::unique_ptr<Peer>> peers_;
  std::size_t waiting_bytes_ = 0, most_waiting_bytes_;  // of all peers
  std::deque<std::pair<std::string, std::vector<std::byte>>> strangers_;
  zmq::message_t sender_, addressee_, incoming_;
};

/// A solver's socket: one DEALER whose routing id is the body's name, or that of a process with
/// several bodies (zmq_group.hpp).
class ZmqDealer : public Channel {
 public:
  ZmqDealer(const std::string& endpoint, const std::string& routing_id, const Limits& limits,
            std::size_t bodies = 1);
  ~ZmqDealer() override;
  bool send(Bytes frame) override;
  bool send(Bytes frame, std::shared_ptr<const void> owner) override;
  std::optional<Bytes> receive(Milliseconds wait) override;

  /// The same in a process of several bodies: the frame is of `body`.
  bool send_of(std::string_view body, Bytes frame);
  bool send_of(std::string_view body, Bytes frame, std::shared_ptr<const void> owner);
  /// For which body the last frame was; empty: its message named none.
  std::string_view addressee() const;

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
  zmq::message_t addressee_, current_;
};

}  // namespace abut
