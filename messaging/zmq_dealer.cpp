#include "messaging/zmq_dealer.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "base/endpoint.hpp"
#include "base/error.hpp"
#include "messaging/key_files.hpp"
#include "messaging/zmq_socket.hpp"

namespace abut {

void warn_of_insecure(const std::string& endpoint, const Access& access) {
  if (!access.insecure || !access.keys.empty() || is_local_endpoint(endpoint)) return;
  const std::string warning = fmt::format(
      "warning: --insecure: whoever is at {} can read and answer what is sent\n", endpoint);
  std::fputs(warning.c_str(), stderr);
}

ZmqDealer::ZmqDealer(const std::string& endpoint, const std::string& routing_id,
                     const Limits& limits, std::size_t bodies, const Access& access)
    : endpoint_(endpoint), context_(1), socket_(context_, zmq::socket_type::dealer) {
  configure(socket_, limits);
  set_queues(socket_, bodies);
  socket_.set(zmq::sockopt::connect_timeout, 2'000);  // [ms]
  socket_.set(zmq::sockopt::reconnect_ivl, 20);       // [ms] start order does not matter,
  socket_.set(zmq::sockopt::reconnect_ivl_max, 500);  // [ms] and costs little
  try {
    come_with(routing_id, access);
    monitor_ = std::make_unique<ZmqMonitor>(context_, socket_);
    socket_.connect(endpoint);
  } catch (const zmq::error_t& error) {
    throw InputError(
        fmt::format("cannot connect body '{}' to '{}': {}", routing_id, endpoint, error.what()),
        "--connect", "give the coordinator's endpoint, for example tcp://127.0.0.1:5555");
  }
}

ZmqDealer::~ZmqDealer() = default;

/// With its key or, where nobody else can listen, with its name.
void ZmqDealer::come_with(const std::string& routing_id, const Access& access) {
  keyed_ = !access.keys.empty();
  if (!keyed_) {
    if (!access.insecure && !is_local_endpoint(endpoint_))
      throw InputError(
          fmt::format("{} is on a network, where anybody could read and answer what is sent",
                      endpoint_),
          "--connect",
          "Give --keys DIR, with keys that abut keygen has made, or --insecure on a network that "
          "you trust.");
    socket_.set(zmq::sockopt::routing_id, routing_id);
    return;
  }
  const BodyKeys keys = read_body_keys(access.keys, routing_id);
  socket_.set(zmq::sockopt::curve_serverkey, keys.coordinator);
  socket_.set(zmq::sockopt::curve_publickey, keys.own.public_key);
  socket_.set(zmq::sockopt::curve_secretkey, keys.own.secret_key);
}

bool ZmqDealer::send(Bytes frame) { return send_part(socket_, frame.data(), frame.size(), 0); }

bool ZmqDealer::send(Bytes frame, std::shared_ptr<const void> owner) {
  return send_part(socket_, frame, std::move(owner));
}

std::optional<Bytes> ZmqDealer::receive(Milliseconds wait) {
  if (keyed_) announce();
  set_receive_timeout(socket_, wait, receive_timeout_);
  addressee_.rebuild();
  if (receive_frame(socket_, addressee_, current_)) return bytes_of(current_);
  read_monitor();
  return std::nullopt;
}

/// A new connection has a new routing id, which its first message tells.
void ZmqDealer::announce() {
  read_monitor();
  if (came_back_ && send_part(socket_, "", 0, 0)) came_back_ = false;
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
    if (event->kind == ZmqMonitor::Kind::key_refused)
      throw InputError(
          fmt::format("the coordinator at {} does not let this key in", endpoint_), "--keys",
          "Give the key of a body that the run waits for, as the coordinator's network.keys has "
          "it.");
    if (event->kind == ZmqMonitor::Kind::unlike)
      throw InputError(
          fmt::format("the coordinator at {} {}", endpoint_,
                      keyed_ ? "has no keys" : "lets nobody in without a key"),
          "--keys",
          keyed_ ? "Give its run network.keys, or leave --keys out."
                 : "Give --keys DIR, with the body's key and the coordinator's public one.");
    came_back_ =
        event->kind == ZmqMonitor::Kind::connected && (came_back_ || gone_since_.has_value());
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
