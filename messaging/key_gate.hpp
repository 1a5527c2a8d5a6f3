#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <zmq.hpp>

#include "messaging/channel.hpp"

namespace abut {

/// Lets those in whose keys are listed. libzmq asks it (by ZAP, its protocol for that) in the
/// handshake of every connection to a socket with keys, and marks every message of the connection
/// with the name that it has answered, as User-Id. A thread of its own: who connects need not wait
/// for a coordinator that is computing.
class KeyGate {
 public:
  /// `names`: bodies, by public key in Z85. One gate per context, before the socket listens.
  KeyGate(zmq::context_t& context, std::map<std::string, std::string> names);
  ~KeyGate();
  KeyGate(const KeyGate&) = delete;
  KeyGate& operator=(const KeyGate&) = delete;

  /// When the body last came in.
  std::optional<TimePoint> admitted(const std::string& name) const;
  /// How many were turned away for their keys.
  int refused() const;

 private:
  void run();
  void answer();
  std::string judge(const std::string& mechanism, const zmq::message_t& key);

  std::map<std::string, std::string> names_;
  zmq::socket_t requests_;
  int stop_ = -1;
  mutable std::mutex mutex_;  // of what follows
  std::map<std::string, TimePoint> admitted_;
  int refused_ = 0;
  std::thread thread_;  // last: it uses the others
};

}  // namespace abut
