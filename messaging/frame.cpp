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
  const std::size_t payload = message.ByteSizeLong();
  ABUT_ASSERT(payload <= UINT32_MAX / 2);  // protobuf's own limit
  size_ = frame_header_bytes + payload;
  if (storage_.size() < size_) storage_.resize(size_);
  std::byte* data = storage_.data();
  // The sizes that ByteSizeLong has just cached are still valid.
  message.SerializeWithCachedSizesToArray(
      reinterpret_cast<std::uint8_t*>(data + frame_header_bytes));
  const std::uint32_t size = static_cast<std::uint32_t>(payload);
  const std::uint64_t checksum = hash_bytes(Bytes(data + frame_header_bytes, payload));
  std::memcpy(data, magic, sizeof magic);
  std::memcpy(data + 4, &size, sizeof size);
  std::memcpy(data + 8, &checksum, sizeof checksum);
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
