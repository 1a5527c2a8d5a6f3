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
#include "messaging/key_files.hpp"
#include "messaging/key_gate.hpp"
#include "messaging/protocol.hpp"

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
  /// The same, and the last place to listen at: for the bodies of these keys alone, who come in no
  /// other way. Whose message it is, its key says, not the routing id that it gives.
  std::string bind(const std::string& endpoint, const CoordinatorKeys& keys);
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
  /// How many were turned away for their keys.
  int refused() const { return gate_ ? gate_->refused() : 0; }

 private:
  struct Connection;
  struct Peer;
  bool send_head(const Connection& connection, const std::string& name);
  bool receive_for(int wanted, Milliseconds wait);
  bool receive_message(Milliseconds wait);
  Connection* find_connection();
  Peer* find_sender();
  void keep_stranger();
  void keep_waiting(Peer& peer);
  void note_descriptor(Connection& connection);
  void read_monitor();

  zmq::context_t context_;
  std::unique_ptr<KeyGate> gate_;  // null: nobody has keys; outlives the socket that it guards
  zmq::socket_t socket_;
  std::unique_ptr<ConnectionGuard> guard_;
  int receive_timeout_ = -1;                                    // [ms] as set on the socket
  std::map<std::string, Connection, std::less<>> connections_;  // by routing id, or body of a key
  std::vector<std::unique_ptr<Peer>> peers_;
  std::size_t waiting_bytes_ = 0, most_waiting_bytes_;  // of all peers
  std::deque<std::pair<std::string, std::vector<std::byte>>> strangers_;
  zmq::message_t sender_, addressee_, incoming_;
};

}  // namespace abut
