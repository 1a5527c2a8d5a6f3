#pragma once

#include <optional>

#include <zmq.hpp>

namespace abut {

/// Reads libzmq's own reports on the connections of a socket, without ever waiting.
class ZmqMonitor {
 public:
  enum class Kind {
    accepted,   // somebody has connected to a socket that listens
    connected,  // the handshake succeeded
    ended,
    key_refused,  // by the other end
    unlike        // one end has keys, the other has none, or another protocol
  };
  struct Event {
    Kind kind = Kind::ended;
    int descriptor = -1;  // of the connection, where it is reported
  };

  ZmqMonitor(zmq::context_t& context, zmq::socket_t& watched);
  ~ZmqMonitor();
  ZmqMonitor(const ZmqMonitor&) = delete;
  ZmqMonitor& operator=(const ZmqMonitor&) = delete;

  std::optional<Event> next();
  /// To poll: readable when there may be something to read; whoever polls reads until there is not.
  int descriptor() const { return reports_.get(zmq::sockopt::fd); }

 private:
  zmq::socket_t& watched_;
  zmq::socket_t reports_;
  zmq::message_t message_;
};

}  // namespace abut
