#include "messaging/frame.hpp"

#include <google/protobuf/message_lite.h>

#include <bit>
#include <cstdint>
#include <cstring>

#include "base/archive.hpp"
#include "base/assert.hpp"

namespace abut {

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

namespace {
// The last byte is the version of the frame format, which wraps every version of the protocol.
constexpr char magic[4] = {'a', 'b', 't', '\x01'};
}  // namespace

void Frame::seal(const google::protobuf::MessageLite& message) {
  out_.clear();
  const std::size_t payload = message.ByteSizeLong();
  // The sizes that ByteSizeLong has just cached are still valid.
  message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(out_.space(payload)));
  seal();
}

WireWriter& Frame::open() {
  out_.clear();
  return out_;
}

void Frame::seal() {
  const Bytes payload = out_.bytes();
  ABUT_ASSERT(payload.size() <= UINT32_MAX / 2);  // protobuf's own limit
  const std::uint32_t size = static_cast<std::uint32_t>(payload.size());
  const std::uint64_t checksum = hash_bytes(payload);
  std::byte* header = out_.space(frame_header_bytes);
  std::memcpy(header, magic, sizeof magic);
  std::memcpy(header + 4, &size, sizeof size);
  std::memcpy(header + 8, &checksum, sizeof checksum);
}

std::optional<Bytes> open_frame(Bytes frame) {
  if (frame.size() < frame_header_bytes) return std::nullopt;
  std::uint32_t size = 0;
  std::uint64_t checksum = 0;
  std::memcpy(&size, frame.data() + 4, sizeof size);
  std::memcpy(&checksum, frame.data() + 8, sizeof checksum);
  const Bytes payload = frame.subspan(frame_header_bytes);
  if (std::memcmp(frame.data(), magic, sizeof magic) != 0 || payload.size() != size ||
      hash_bytes(payload) != checksum) {
    return std::nullopt;
  }
  return payload;
}

}  // namespace abut
