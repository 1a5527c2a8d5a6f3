#include "messaging/zmq_channel.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <utility>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "messaging/zmq_socket.hpp"

namespace abut {

namespace {

constexpr std::size_t most_strangers = 64;      // frames kept for a refusal; more are forgotten
constexpr std::size_t largest_hello = 65'536;   // [B] of which no more than this is read
constexpr std::size_t most_waiting = 64;        // frames of a peer; it repeats what it needs
constexpr std::size_t most_waiting_limits = 4;  // what waits, of all peers, in limits of a frame
constexpr std::size_t most_disconnects = 256;   // times remembered per peer

/// libzmq removes whatever lies where its socket is to be: a file of somebody else.
void refuse_existing_file(const std::string& endpoint) {
  constexpr std::string_view local = "ipc://";
  if (!endpoint.starts_with(local)) return;
  const std::string path = endpoint.substr(local.size());
  struct stat there {};
  if (path.starts_with('@') || lstat(path.c_str(), &there) != 0) return;  // @: a name, no file
  throw InputError(fmt::format("cannot listen at {}: this file exists", endpoint),
                   "network.endpoint",
                   "name a path that is not there; a socket that a killed run has left can be "
                   "removed by hand");
}

}  // namespace

/// With one process; of one body, or of several that are named in every message.
struct ZmqHub::Connection {
  std::string name;        // of its body or process, as keys say it
  std::string routing_id;  // of one with a key: as it is now
  std::string earlier_id;  // of one with a key: before it came back
  bool shared = false;
  bool keyed = false;
  int number = 0;
  std::map<std::string, Peer*, std::less<>> peers;
  int descriptor = -1;  // once a frame has come through it
  std::optional<TimePoint> gone;
  std::vector<TimePoint> disconnects;
  TimePoint last_frame{};  // where it is shared

  /// The ROUTER knows best who can be reached: this also sees a connection that has come back. One
  /// with a key comes back under another routing id.
  bool note(bool sent) {
    if (sent) {
      gone.reset();
    } else if (zmq_errno() == EHOSTUNREACH && !gone && !keyed) {
      gone = std::chrono::steady_clock::now();
    }
    return sent;
  }
};

struct ZmqHub::Peer : Channel {
  Peer(ZmqHub& owner, Connection& its, int number, std::string own_name)
      : hub(owner), connection(its), index(number), name(std::move(own_name)) {}

  bool send(Bytes frame) override {
    return connection.note(hub.send_head(connection, name) &&
                           send_part(hub.socket_, frame.data(), frame.size(), 0));
  }
  bool send(Bytes frame, std::shared_ptr<const void> owner) override {
    return connection.note(hub.send_head(connection, name) &&
                           send_part(hub.socket_, frame, std::move(owner)));
  }
  std::optional<Bytes> receive(Milliseconds wait) override {
    if (!waiting.empty()) {
      current = std::move(waiting.front());
      waiting.pop_front();
      hub.waiting_bytes_ -= current.size();
      return bytes_of(current);
    }
    if (!hub.receive_for(index, wait)) return std::nullopt;
    return bytes_of(current);
  }

  ZmqHub& hub;
  Connection& connection;
  int index;
  std::string name;
  zmq::message_t current;
  std::deque<zmq::message_t> waiting;
};

ZmqHub::ZmqHub(const Limits& limits)
    : context_(1),
      socket_(context_, zmq::socket_type::router),
      most_waiting_bytes_(most_waiting_limits * limits.frame_bytes) {
  configure(socket_, limits);
  socket_.set(zmq::sockopt::router_mandatory, true);  // an unknown peer is an error, not silence
  socket_.set(zmq::sockopt::router_handover, true);   // a reconnecting solver takes its name back
  socket_.set(zmq::sockopt::backlog, 128);
  guard_ = std::make_unique<ConnectionGuard>(context_, socket_, largest_hello);
}

ZmqHub::~ZmqHub() = default;

std::string ZmqHub::bind(const std::string& endpoint) {
  refuse_existing_file(endpoint);
  std::size_t bodies = 1;
  for (const auto& [id, connection] : connections_)
    bodies = std::max(bodies, connection.peers.size());
  set_queues(socket_, bodies);
  try {
    socket_.bind(endpoint);
  } catch (const zmq::error_t& error) {
    throw InputError(fmt::format("cannot listen at {}: {}", endpoint, error.what()),
                     "network.endpoint",
                     "name an address of this machine and a free port, for example "
                     "tcp://127.0.0.1:5555 or tcp://*:5555");
  }
  return socket_.get(zmq::sockopt::last_endpoint);
}

std::string ZmqHub::bind(const std::string& endpoint, const CoordinatorKeys& keys) {
  ABUT_ASSERT(!gate_);
  for (const auto& [key, body] : keys.bodies) {
    Connection& connection = connections_.at(body);
    connection.keyed = true;
    connection.routing_id.clear();
  }
  gate_ = std::make_unique<KeyGate>(context_, keys.bodies);
  // A name is handed over to nobody: who comes back with its key has another routing id.
  socket_.set(zmq::sockopt::router_handover, false);
  socket_.set(zmq::sockopt::curve_server, true);
  socket_.set(zmq::sockopt::curve_secretkey, keys.own.secret_key);
  socket_.set(zmq::sockopt::zap_domain, "abut");
  return bind(endpoint);
}

int ZmqHub::add_peer(const std::string& name) {
  const int peer = add_peer(name, name);
  peers_.back()->connection.shared = false;
  return peer;
}

int ZmqHub::add_peer(const std::string& name, const std::string& process) {
  const int index = static_cast<int>(peers_.size());
  Connection& connection = connections_[process];
  if (connection.peers.empty()) connection.number = index;
  connection.name = process;
  connection.routing_id = process;
  connection.shared = true;
  peers_.push_back(std::make_unique<Peer>(*this, connection, index, name));
  connection.peers.emplace(name, peers_.back().get());
  return index;
}

Channel& ZmqHub::channel(int peer) { return *peers_.at(index(peer)); }

bool ZmqHub::send_to(const std::string& routing_id, Bytes frame) {
  return send_part(socket_, routing_id.data(), routing_id.size(), ZMQ_SNDMORE) &&
         send_part(socket_, frame.data(), frame.size(), 0);
}

bool ZmqHub::send_head(const Connection& connection, const std::string& name) {
  const std::string& id = connection.routing_id;
  return send_part(socket_, id.data(), id.size(), ZMQ_SNDMORE) &&
         (!connection.shared || send_part(socket_, name.data(), name.size(), ZMQ_SNDMORE));
}

bool ZmqHub::receive_message(Milliseconds wait) {
  set_receive_timeout(socket_, wait, receive_timeout_);
  if (!receive_part(socket_, sender_)) return false;
  // Parts of one message arrive together, so the second one never waits.
  addressee_.rebuild();
  const bool whole = sender_.more() && receive_frame(socket_, addressee_, incoming_);
  if (!whole) incoming_.rebuild();
  return true;
}

/// Null: nobody that is known. Of a message that came with a key, the key alone says whose it is;
/// a routing id that nobody has given, which is drawn by libzmq, begins with a zero.
ZmqHub::Connection* ZmqHub::find_connection() {
  const char* user = gate_ ? zmq_msg_gets(sender_.handle(), "User-Id") : nullptr;
  const std::string_view name = user != nullptr ? std::string_view(user) : text_of(sender_);
  const auto found = connections_.find(name);
  if (found == connections_.end() || found->second.keyed != (user != nullptr)) return nullptr;
  Connection& connection = found->second;
  const std::string_view id = text_of(sender_);
  if (connection.keyed && id != name && !id.starts_with('\0')) return nullptr;  // says another name
  if (connection.keyed && id != connection.routing_id && id != connection.earlier_id) {
    connection.earlier_id = std::exchange(connection.routing_id, std::string(id));
  }
  return &connection;
}

ZmqHub::Peer* ZmqHub::find_sender() {
  Connection* connection = find_connection();
  if (connection == nullptr) return nullptr;
  const bool announced = connection->keyed && incoming_.size() == 0;  // of the whole connection
  if (!connection->shared || announced) return connection->peers.begin()->second;
  const auto peer = connection->peers.find(text_of(addressee_));
  return peer == connection->peers.end() ? nullptr : peer->second;
}

void ZmqHub::keep_stranger() {
  if (strangers_.size() >= most_strangers) return;
  const Bytes whole = bytes_of(incoming_);
  const Bytes frame = whole.first(std::min(whole.size(), largest_hello));
  strangers_.emplace_back(std::string(static_cast<const char*>(sender_.data()), sender_.size()),
                          std::vector<std::byte>(frame.begin(), frame.end()));
}

/// Over which connection the frame came. While there are unknown ones, a descriptor may be that of
/// another connection than the last time.
void ZmqHub::note_descriptor(Connection& connection) {
  if (incoming_.size() == 0 && !connection.keyed) return;
  const int descriptor = zmq_msg_get(incoming_.handle(), ZMQ_SRCFD);
  const bool changed = descriptor != connection.descriptor;
  connection.descriptor = descriptor;
  if (descriptor >= 0 && (changed || guard_->unknown() > 0))
    guard_->know(descriptor, connection.number);
}

/// What is too much is as good as lost: who waits for it repeats its request.
void ZmqHub::keep_waiting(Peer& peer) {
  if (peer.waiting.size() >= most_waiting) return;
  if (waiting_bytes_ + incoming_.size() > most_waiting_bytes_) return;
  waiting_bytes_ += incoming_.size();
  peer.waiting.push_back(std::move(incoming_));
}

bool ZmqHub::receive_for(int wanted, Milliseconds wait) {
  const TimePoint until = std::chrono::steady_clock::now() + wait;
  while (receive_message(wait)) {
    if (Peer* peer = find_sender(); peer == nullptr) {
      if (!gate_) keep_stranger();  // where there are keys, nobody is refused in words
    } else {
      Connection& connection = peer->connection;
      note_descriptor(connection);
      connection.gone.reset();
      if (connection.shared) connection.last_frame = std::chrono::steady_clock::now();
      const bool announced = connection.keyed && incoming_.size() == 0;  // only: here it is again
      if (peer->index == wanted && !announced) {
        peer->current = std::move(incoming_);
        return true;
      }
      if (!announced) keep_waiting(*peer);
      if (wanted < 0) return true;
    }
    wait = std::max(Milliseconds(0),
                    std::chrono::ceil<Milliseconds>(until - std::chrono::steady_clock::now()));
  }
  return false;
}

bool ZmqHub::pump(Milliseconds wait) { return receive_for(-1, wait); }

bool ZmqHub::has_frame(int peer) const { return !peers_.at(index(peer))->waiting.empty(); }

std::optional<std::pair<std::string, std::vector<std::byte>>> ZmqHub::take_stranger() {
  if (strangers_.empty()) return std::nullopt;
  std::pair<std::string, std::vector<std::byte>> first = std::move(strangers_.front());
  strangers_.pop_front();
  return first;
}

void ZmqHub::read_monitor() {
  while (const std::optional<int> ended = guard_->next_ended()) {
    for (auto& [id, connection] : connections_) {
      // A connection that ended before its first frame belongs to one who was trying to come back.
      const bool nameless = connection.descriptor < 0 && !connection.disconnects.empty();
      if (connection.descriptor != *ended && !nameless) continue;
      connection.descriptor = -1;
      connection.gone = std::chrono::steady_clock::now();
      if (connection.disconnects.size() < most_disconnects)
        connection.disconnects.push_back(*connection.gone);
    }
  }
}

int ZmqHub::disconnects(int peer, TimePoint since) {
  read_monitor();
  const std::vector<TimePoint>& times = peers_.at(index(peer))->connection.disconnects;
  return static_cast<int>(std::count_if(times.begin(), times.end(),
                                        [since](const TimePoint& time) { return time >= since; }));
}

std::optional<TimePoint> ZmqHub::gone_since(int peer) {
  read_monitor();
  Connection& connection = peers_.at(index(peer))->connection;
  if (connection.keyed && connection.gone && gate_->admitted(connection.name) > connection.gone)
    connection.gone.reset();  // it is back, and busy: it has not said so yet
  return connection.gone;
}

TimePoint ZmqHub::last_frame(int peer) const {
  return peers_.at(index(peer))->connection.last_frame;
}

}  // namespace abut
