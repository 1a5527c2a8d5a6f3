#include "messaging/zmq_socket.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "base/error.hpp"

namespace abut {

namespace {

/// Below this a copy costs less than the bookkeeping of two threads.
constexpr std::size_t worth_sharing = 8192;

void release(void*, void* hint) { delete static_cast<std::shared_ptr<const void>*>(hint); }

}  // namespace

void configure(zmq::socket_t& socket, const Limits& limits) {
  socket.set(zmq::sockopt::linger, 500);  // [ms] a refusal or a last reply may still leave
  socket.set(zmq::sockopt::sndtimeo, 0);  // never blocks: requests are repeated by whoever waits
  // Frames above the limit are refused by size and name; far above it the connection ends before
  // memory does.
  socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(2 * limits.frame_bytes));
  socket.set(zmq::sockopt::handshake_ivl, 5'000);  // [ms]
  const int silence = static_cast<int>(longest_silence.count());
  socket.set(zmq::sockopt::heartbeat_ivl, 2'000);        // [ms] answered by the peer's I/O thread,
  socket.set(zmq::sockopt::heartbeat_timeout, silence);  // also while its body is solving
  socket.set(zmq::sockopt::heartbeat_ttl, silence);
  socket.set(zmq::sockopt::tcp_keepalive, 1);
  socket.set(zmq::sockopt::ipv6, 0);
}

void set_queues(zmq::socket_t& socket, std::size_t bodies) {
  socket.set(zmq::sockopt::sndhwm, static_cast<int>(64 * bodies));
  // Without a bound: once a queue is full, libzmq (4.3.4, and later ones) stops reading, takes the
  // peer's hanging up for nothing, and its next heartbeat to that peer aborts the whole process.
  socket.set(zmq::sockopt::rcvhwm, 0);
}

void set_receive_timeout(zmq::socket_t& socket, Milliseconds wait, int& current) {
  const int wanted = static_cast<int>(std::clamp<Milliseconds::rep>(wait.count(), 0, 60'000));
  if (wanted == current) return;
  socket.set(zmq::sockopt::rcvtimeo, wanted);
  current = wanted;
}

bool receive_part(zmq::socket_t& socket, zmq::message_t& part) {
  if (zmq_msg_recv(part.handle(), socket.handle(), 0) >= 0) return true;
  if (zmq_errno() == EAGAIN || zmq_errno() == EINTR) return false;
  throw RunError(fmt::format("a socket failed: {}", zmq_strerror(zmq_errno())), "messaging",
                 "look at the limits of open files and memory of this machine");
}

bool receive_frame(zmq::socket_t& socket, zmq::message_t& body, zmq::message_t& frame) {
  if (!receive_part(socket, frame)) return false;
  while (frame.more()) {
    body = std::move(frame);
    frame.rebuild();
    if (!receive_part(socket, frame)) return false;
  }
  return true;
}

bool send_part(zmq::socket_t& socket, const void* data, std::size_t size, int flags) {
  return zmq_send(socket.handle(), data, size, flags | ZMQ_DONTWAIT) >= 0;
}

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

}  // namespace abut
