#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace abut {

using Bytes = std::span<const std::byte>;
using Milliseconds = std::chrono::milliseconds;
using TimePoint = std::chrono::steady_clock::time_point;

/// One end of a two-way connection that carries whole frames. Frames may be lost, repeated or late;
/// a damaged one is recognised by its checksum (frame.hpp). Not for use by several threads.
class Channel {
 public:
  virtual ~Channel() = default;
  /// Hands a frame to the transport; false when there is nobody to hand it to at present.
  virtual bool send(Bytes frame) = 0;
  /// The same of a frame whose bytes stay as they are while `owner` is held: no copy is needed.
  virtual bool send(Bytes frame, std::shared_ptr<const void> owner) {
    owner.reset();
    return send(frame);
  }
  /// The next frame, or nothing when none came within `wait`. The bytes are valid until the next
  /// call.
  virtual std::optional<Bytes> receive(Milliseconds wait) = 0;
  /// The clock of every deadline on this channel, so that a test can run it by hand.
  virtual TimePoint now() const { return std::chrono::steady_clock::now(); }
};

}  // namespace abut
