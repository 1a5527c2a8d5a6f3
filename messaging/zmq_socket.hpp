#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include <zmq.hpp>

#include "messaging/channel.hpp"
#include "messaging/protocol.hpp"

namespace abut {

// What both ends do with a socket.

/// For so long an end may answer no heartbeat before the other one takes it for gone.
inline constexpr Milliseconds longest_silence{10'000};

/// Everything that libzmq would otherwise choose for us.
void configure(zmq::socket_t& socket, const Limits& limits);
/// Of a connection that so many bodies share; heeded by connections that begin later. One request
/// is under way per body, with a sign of progress now and then, which whoever waits reads at once.
/// What arrives is bounded otherwise: of who is unknown, by a ConnectionGuard.
void set_queues(zmq::socket_t& socket, std::size_t bodies);
/// `current` [ms]: as it is set now.
void set_receive_timeout(zmq::socket_t& socket, Milliseconds wait, int& current);

/// False when nothing came in time or a signal interrupted the wait: the caller looks around.
/// Throws RunError.
bool receive_part(zmq::socket_t& socket, zmq::message_t& part);
/// What is left of a message: the frame, and before it the body's name where bodies share the
/// connection. More parts are not ours: the last one is no frame of that body. False as above.
bool receive_frame(zmq::socket_t& socket, zmq::message_t& body, zmq::message_t& frame);

/// False when the transport cannot take the part now (no such peer, full queue, signal).
bool send_part(zmq::socket_t& socket, const void* data, std::size_t size, int flags);
/// The same without a copy: libzmq's thread sends from where the bytes are, and lets them go then.
bool send_part(zmq::socket_t& socket, Bytes frame, std::shared_ptr<const void> owner);

inline std::string_view text_of(const zmq::message_t& message) {
  return {static_cast<const char*>(message.data()), message.size()};
}
inline Bytes bytes_of(const zmq::message_t& message) {
  return Bytes(static_cast<const std::byte*>(message.data()), message.size());
}

}  // namespace abut
