#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "messaging/channel.hpp"
#include "messaging/codec/wire.hpp"

namespace google::protobuf {
class MessageLite;
}

namespace abut {

/// A frame is a 4-byte magic, the 4-byte size of the payload, the 8-byte XXH3 checksum of the
/// payload, and the payload: one protobuf message. Integers are little-endian.
inline constexpr std::size_t frame_header_bytes = 16;

/// Buffer of an outgoing frame; keeps its memory from message to message.
class Frame {
 public:
  void seal(const google::protobuf::MessageLite& message);
  /// For messages with waveforms, which are written where they are sent from: open, write, seal.
  WireWriter& open();
  void seal();
  Bytes bytes() const { return out_.bytes(); }
  /// As long as it is held, the bytes stay as they are: a transport need not copy them.
  std::shared_ptr<const void> owner() const { return out_.owner(); }

 private:
  WireWriter out_;
};

/// The payload of a frame, or nothing when the frame is damaged or not ours.
std::optional<Bytes> open_frame(Bytes frame);

}  // namespace abut
