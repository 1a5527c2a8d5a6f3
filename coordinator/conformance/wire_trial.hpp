#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "abut/v1/subdomain.pb.h"
#include "contract/subdomain.hpp"
#include "messaging/child_process.hpp"
#include "messaging/codec.hpp"
#include "messaging/frame.hpp"
#include "messaging/protocol.hpp"
#include "messaging/zmq_channel.hpp"

namespace abut {

/// A process of one body and the frames that go to it and come from it, as they are: a coordinator
/// that may do what it should not.
class WireTrial {
 public:
  struct Solver {
    std::string program, body;
    Specification specification;  // of the body
    Milliseconds deadline;        // for any reply
  };
  /// A request to advance under a force that moves the body, of some substeps.
  struct Pushed {
    double begin = 0.0, step = 0.0;  // [s]
    int steps = 4;
    int port = 0;
    double force = 0.0;  // [N] on each value of the port
  };

  /// Starts the program and waits for its Hello. Throws BrokenClause where none comes.
  explicit WireTrial(const Solver& solver);
  ~WireTrial();
  WireTrial(const WireTrial&) = delete;
  WireTrial& operator=(const WireTrial&) = delete;

  const v1::Hello& hello() const { return hello_; }
  ChildProcess& process() { return process_; }
  /// Welcomes and configures. Throws BrokenClause where it gives no sound description.
  const Description& configure();

  /// With the next number and the session.
  v1::Request next();
  /// Of a window from the body's begin, with nothing on its ports.
  v1::Request advance(const Pushed& pushed);
  void send(const v1::Request& request);
  void send(const std::vector<std::byte>& frame);
  /// What travels for a request.
  static std::vector<std::byte> frame_of(const v1::Request& request);

  /// The next frame that is neither Hello nor Progress; nothing: none came in time. Signs of
  /// progress are counted, and extend the wait.
  std::optional<v1::Reply> reply(Milliseconds wait);
  /// Sends it, and waits for its reply. Throws BrokenClause where none comes, or another one's.
  v1::Reply call(const v1::Request& request, const std::string& what);
  /// Payload of the last reply.
  const std::vector<std::byte>& payload() const { return payload_; }
  int signs() const { return signs_; }
  /// The coordinator is gone, without a word.
  void vanish() { hub_.reset(); }

 private:
  Solver solver_;
  std::string directory_;  // of the socket
  std::optional<ZmqHub> hub_;
  int peer_;
  std::string endpoint_;
  ChildProcess process_;
  v1::Hello hello_;
  Description description_;
  std::uint64_t number_ = 0;  // of the last request
  std::vector<std::byte> payload_;
  int signs_ = 0;
};

}  // namespace abut
