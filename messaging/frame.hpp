#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "messaging/channel.hpp"

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
  Bytes bytes() const { return Bytes(storage_.data(), size_); }

 private:
  std::vector<std::byte> storage_;
  std::size_t size_ = 0;
};

/// The payload of a frame, or nothing when the frame is damaged or not ours.
std::optional<Bytes> open_frame(Bytes frame);

}  // namespace abut
