#pragma once

#include <optional>

#include <zmq.hpp>

namespace abut {

/// Reads libzmq's own reports on the connections of a socket, without ever waiting.
class ZmqMonitor {
 public:
  struct Event {
    bool connected = false;  // the handshake succeeded; else the connection ended
    int descriptor = -1;     // of the connection
  };

  ZmqMonitor(zmq::context_t& context, zmq::socket_t& watched);
  ~ZmqMonitor();
  ZmqMonitor(const ZmqMonitor&) = delete;
  ZmqMonitor& operator=(const ZmqMonitor&) = delete;

  std::optional<Event> next();

 private:
  zmq::socket_t& watched_;
  zmq::socket_t reports_;
  zmq::message_t message_;
};

}  // namespace abut
