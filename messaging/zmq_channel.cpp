#include "messaging/zmq_channel.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

constexpr std::size_t most_strangers = 64;      // frames kept for a refusal; more are forgotten
constexpr std::size_t largest_hello = 65'536;   // [B] of which no more than this is read
constexpr std::size_t most_waiting = 64;        // frames of a peer; it repeats what it needs
constexpr std::size_t most_waiting_limits = 4;  // what waits, of all peers, in limits of a frame
constexpr std::size_t most_disconnects = 256;   // times remembered per peer

/// Everything that libzmq would otherwise choose for us.
void configure(zmq::socket_t& socket, const Limits& limits) {
  socket.set(zmq::sockopt::linger, 500);  // [ms] a refusal or a last reply may still leave
  socket.set(zmq::sockopt::sndtimeo, 0);  // never blocks: requests are repeated by whoever waits
  // Frames above the limit are refused by size and name; far above it the connection ends before
  // memory does.
  socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(2 * limits.frame_bytes));
  socket.set(zmq::sockopt::handshake_ivl, 5'000);       // [ms]
  socket.set(zmq::sockopt::heartbeat_ivl, 2'000);       // [ms] answered by the peer's I/O thread,
  socket.set(zmq::sockopt::heartbeat_timeout, 10'000);  // [ms] also while its body is solving
  socket.set(zmq::sockopt::heartbeat_ttl, 10'000);      // [ms]
  socket.set(zmq::sockopt::tcp_keepalive, 1);
  socket.set(zmq::sockopt::ipv6, 0);
}

/// Of a connection that so many bodies share; heeded by connections that begin later. One request
/// is under way per body, with a sign of progress now and then, which whoever waits reads at once.
void set_queues(zmq::socket_t& socket, std::size_t bodies) {
  socket.set(zmq::sockopt::sndhwm, static_cast<int>(64 * bodies));
  socket.set(zmq::sockopt::rcvhwm, static_cast<int>(16 * bodies));
}

void set_receive_timeout(zmq::socket_t& socket, Milliseconds wait, int& current) {
  const int wanted = static_cast<int>(std::clamp<Milliseconds::rep>(wait.count(), 0, 60'000));
  if (wanted == current) return;
  socket.set(zmq::sockopt::rcvtimeo, wanted);
  current = wanted;
}

/// False when nothing came in time or a signal interrupted the wait: the caller looks around.
bool receive_part(zmq::socket_t& socket, zmq::message_t& part) {
  if (zmq_msg_recv(part.handle(), socket.handle(), 0) >= 0) return true;
  if (zmq_errno() == EAGAIN || zmq_errno() == EINTR) return false;
  throw RunError(fmt::format("a socket failed: {}", zmq_strerror(zmq_errno())), "messaging",
                 "look at the limits of open files and memory of this machine");
}

/// What is left of a message: the frame, and before it the body's name where bodies share the
/// connection. More parts are not ours: the last one is no frame of that body. False as above.
bool receive_frame(zmq::socket_t& socket, zmq::message_t& body, zmq::message_t& frame) {
  if (!receive_part(socket, frame)) return false;
  while (frame.more()) {
    body = std::move(frame);
    frame.rebuild();
    if (!receive_part(socket, frame)) return false;
  }
  return true;
}

/// False when the transport cannot take the part now (no such peer, full queue, signal).
bool send_part(zmq::socket_t& socket, const void* data, std::size_t size, int flags) {
  return zmq_send(socket.handle(), data, size, flags | ZMQ_DONTWAIT) >= 0;
}

/// Below this a copy costs less than the bookkeeping of two threads.
constexpr std::size_t worth_sharing = 8192;

void release(void*, void* hint) { delete static_cast<std::shared_ptr<const void>*>(hint); }

/// The same without a copy: libzmq's thread sends from where the bytes are, and lets them go then.
bool send_part(zmq::socket_t& socket, Bytes frame, std::shared_ptr<const void> owner) {
  if (frame.size() < worth_sharing) return send_part(socket, frame.data(), frame.size(), 0);
  auto held = std::make_unique<std::shared_ptr<const void>>(std::move(owner));
  zmq_msg_t message;
  void* data = const_cast<std::byte*>(frame.data());  // libzmq only reads what it sends
  if (zmq_msg_init_data(&message, data, frame.size(), &release, held.get()) != 0) return false;
  (void)held.release();
  if (zmq_msg_send(&message, socket.handle(), ZMQ_DONTWAIT) >= 0) return true;
  const int error = zmq_errno();
  zmq_msg_close(&message);
  errno = error;
  return false;
}

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

std::string_view text_of(const zmq::message_t& message) {
  return {static_cast<const char*>(message.data()), message.size()};
}

Bytes bytes_of(const zmq::message_t& message) {
  return Bytes(static_cast<const std::byte*>(message.data()), message.size());
}

}  // namespace

// ---- hub
// --------------------------------------------------------------------------------------------

/// With one process; of one body, or of several that are named in every message.
struct ZmqHub::Connection {
  std::string routing_id;
  bool shared = false;
  int number = 0;
  std::map<std::string, Peer*, std::less<>> peers;
  int descriptor = -1;  // once a frame has come through it
  std::optional<TimePoint> gone;
  std::vector<TimePoint> disconnects;
  TimePoint last_frame{};  // where it is shared

  /// The ROUTER knows best who can be reached: this also sees a connection that has come back.
  bool note(bool sent) {
    if (sent) {
      gone.reset();
    } else if (zmq_errno() == EHOSTUNREACH && !gone) {
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

int ZmqHub::add_peer(const std::string& name) {
  const int peer = add_peer(name, name);
  peers_.back()->connection.shared = false;
  return peer;
}

int ZmqHub::add_peer(const std::string& name, const std::string& process) {
  const int index = static_cast<int>(peers_.size());
  Connection& connection = connections_[process];
  if (connection.peers.empty()) connection.number = index;
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

/// Null: nobody that is known.
ZmqHub::Peer* ZmqHub::find_sender() {
  const auto connection = connections_.find(text_of(sender_));
  if (connection == connections_.end()) return nullptr;
  const auto& [id, found] = *connection;
  if (!found.shared) return found.peers.begin()->second;
  const auto peer = found.peers.find(text_of(addressee_));
  return peer == found.peers.end() ? nullptr : peer->second;
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
  if (incoming_.size() == 0) return;
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
      keep_stranger();
    } else {
      Connection& connection = peer->connection;
      note_descriptor(connection);
      connection.gone.reset();
      if (connection.shared) connection.last_frame = std::chrono::steady_clock::now();
      if (peer->index == wanted) {
        peer->current = std::move(incoming_);
        return true;
      }
      keep_waiting(*peer);
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
  return peers_.at(index(peer))->connection.gone;
}

TimePoint ZmqHub::last_frame(int peer) const {
  return peers_.at(index(peer))->connection.last_frame;
}

// ---- dealer
// -----------------------------------------------------------------------------------------

ZmqDealer::ZmqDealer(const std::string& endpoint, const std::string& routing_id,
                     const Limits& limits, std::size_t bodies)
    : context_(1), socket_(context_, zmq::socket_type::dealer) {
  configure(socket_, limits);
  set_queues(socket_, bodies);
  socket_.set(zmq::sockopt::connect_timeout, 2'000);  // [ms]
  socket_.set(zmq::sockopt::reconnect_ivl, 20);       // [ms] start order does not matter,
  socket_.set(zmq::sockopt::reconnect_ivl_max, 500);  // [ms] and costs little
  try {
    socket_.set(zmq::sockopt::routing_id, routing_id);
    monitor_ = std::make_unique<ZmqMonitor>(context_, socket_);
    socket_.connect(endpoint);
  } catch (const zmq::error_t& error) {
    throw InputError(
        fmt::format("cannot connect body '{}' to '{}': {}", routing_id, endpoint, error.what()),
        "--connect", "give the coordinator's endpoint, for example tcp://127.0.0.1:5555");
  }
}

ZmqDealer::~ZmqDealer() = default;

bool ZmqDealer::send(Bytes frame) { return send_part(socket_, frame.data(), frame.size(), 0); }

bool ZmqDealer::send(Bytes frame, std::shared_ptr<const void> owner) {
  return send_part(socket_, frame, std::move(owner));
}

std::optional<Bytes> ZmqDealer::receive(Milliseconds wait) {
  set_receive_timeout(socket_, wait, receive_timeout_);
  addressee_.rebuild();
  if (!receive_frame(socket_, addressee_, current_)) return std::nullopt;
  return bytes_of(current_);
}

bool ZmqDealer::send_of(std::string_view body, Bytes frame) {
  return send_part(socket_, body.data(), body.size(), ZMQ_SNDMORE) &&
         send_part(socket_, frame.data(), frame.size(), 0);
}

bool ZmqDealer::send_of(std::string_view body, Bytes frame, std::shared_ptr<const void> owner) {
  return send_part(socket_, body.data(), body.size(), ZMQ_SNDMORE) &&
         send_part(socket_, frame, std::move(owner));
}

std::string_view ZmqDealer::addressee() const { return text_of(addressee_); }

void ZmqDealer::read_monitor() {
  while (const std::optional<ZmqMonitor::Event> event = monitor_->next()) {
    connected_ = event->kind != ZmqMonitor::Kind::ended;
    if (connected_) {
      gone_since_.reset();
    } else if (!gone_since_) {  // attempts to reconnect that fail do not begin the wait anew
      gone_since_ = std::chrono::steady_clock::now();
    }
  }
}

bool ZmqDealer::connected() {
  read_monitor();
  return connected_;
}

std::optional<TimePoint> ZmqDealer::gone_since() {
  read_monitor();
  return gone_since_;
}

}  // namespace abut
