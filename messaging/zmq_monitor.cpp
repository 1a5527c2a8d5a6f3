#include "messaging/zmq_monitor.hpp"

#include <cstdint>
#include <cstring>
#include <string>

namespace abut {

ZmqMonitor::ZmqMonitor(zmq::context_t& context, zmq::socket_t& watched)
    : watched_(watched), reports_(context, zmq::socket_type::pair) {
  const std::string address = "inproc://abut-monitor";  // one monitored socket per context
  if (zmq_socket_monitor(watched.handle(), address.c_str(),
                         ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_HANDSHAKE_SUCCEEDED |
                             ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH |
                             ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL) != 0) {
    throw zmq::error_t();
  }
  reports_.set(zmq::sockopt::linger, 0);
  reports_.connect(address);
}

ZmqMonitor::~ZmqMonitor() { zmq_socket_monitor(watched_.handle(), nullptr, 0); }

std::optional<ZmqMonitor::Event> ZmqMonitor::next() {
  while (reports_.recv(message_, zmq::recv_flags::dontwait)) {
    // First part: 16-bit event, 32-bit value. Second part: the address, which nobody needs here.
    std::uint16_t event = 0;
    std::int32_t value = 0;
    if (message_.size() < sizeof event + sizeof value) continue;
    std::memcpy(&event, message_.data(), sizeof event);
    std::memcpy(&value, static_cast<const char*>(message_.data()) + sizeof event, sizeof value);
    zmq::message_t address;
    if (message_.more()) (void)reports_.recv(address, zmq::recv_flags::dontwait);
    if (event == ZMQ_EVENT_ACCEPTED) return Event{Kind::accepted, value};
    if (event == ZMQ_EVENT_HANDSHAKE_SUCCEEDED) return Event{Kind::connected, value};
    if (event == ZMQ_EVENT_DISCONNECTED) return Event{Kind::ended, value};
    if (event == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) return Event{Kind::key_refused};
    if (value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH) return Event{Kind::unlike};
  }
  return std::nullopt;
}

}  // namespace abut
