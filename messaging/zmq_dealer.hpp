#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <zmq.hpp>

#include "messaging/channel.hpp"
#include "messaging/protocol.hpp"
#include "messaging/zmq_monitor.hpp"

namespace abut {

/// How a solver comes in.
struct Access {
  std::string keys;       // directory with the body's keys (key_files.hpp); empty: it has none
  bool insecure = false;  // without keys to other machines, too
};

/// Says on standard error, as a program starts, that it goes to other machines without keys.
void warn_of_insecure(const std::string& endpoint, const Access& access);

/// A solver's socket: one DEALER whose routing id is the body's name, or that of a process with
/// several bodies (zmq_group.hpp). With keys it has none: the key says which body it is.
class ZmqDealer : public Channel {
 public:
  ZmqDealer(const std::string& endpoint, const std::string& routing_id, const Limits& limits,
            std::size_t bodies = 1, const Access& access = {});
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
  void come_with(const std::string& routing_id, const Access& access);
  void announce();
  void read_monitor();

  std::string endpoint_;
  zmq::context_t context_;
  zmq::socket_t socket_;
  std::unique_ptr<ZmqMonitor> monitor_;
  int receive_timeout_ = -1;  // [ms] as set on the socket
  bool keyed_ = false;
  bool came_back_ = false;  // and has not said so yet
  bool connected_ = false;
  std::optional<TimePoint> gone_since_;
  zmq::message_t addressee_, current_;
};

}  // namespace abut
