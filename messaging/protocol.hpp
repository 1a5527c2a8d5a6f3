#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "contract/port_role.hpp"
#include "messaging/channel.hpp"

namespace abut {

/// Version of the wire protocol (proto/README.md): both ends must speak the same one.
inline constexpr std::uint32_t protocol_version = 4;

/// Version of this build, for Hello, Welcome and --version.
const char* build_version();

/// Bounds on what a peer may make us store.
struct Limits {
  std::size_t frame_bytes = std::size_t{256} << 20;
  int corrupt_frames = 16;  // in one request; then the connection is given up
};

/// Bounds on how long anything is waited for.
struct Deadlines {
  Milliseconds request{60'000};    // without a reply or a sign of progress
  Milliseconds repeat{2'000};      // a request is sent again after this long, then twice, ...
  Milliseconds slice{100};         // between two looks at the peer's liveness
  Milliseconds reconnect{10'000};  // a lost TCP connection may come back for this long
  Milliseconds progress{250};      // least time between two signs of progress
  Milliseconds hello{1'000};       // between two attempts to greet
};

/// What a body is made from: the scene as text, and where in it the body's own keys are.
struct Specification {
  std::string document;                // name of the scene file, for error messages
  std::string text;                    // the whole scene, verbatim
  std::vector<std::string> overrides;  // "key.path=value"
  std::string path;                    // "bodies.left"
  BodyContext context = {};            // what the scene's interfaces make of the body
};

}  // namespace abut
