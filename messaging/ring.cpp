#include "messaging/ring.hpp"

#include <algorithm>
#include <cstring>

namespace abut {

std::size_t RingWriter::room() {
  const std::uint64_t used = written_ - counts_.read.load(std::memory_order_acquire);
  sound_ = sound_ && used <= ring_.size();
  return sound_ ? ring_.size() - static_cast<std::size_t>(used) : 0;
}

void RingWriter::put(Bytes& rest, std::size_t most) {
  const std::size_t count = std::min({rest.size(), room(), most});
  if (count == 0) return;
  const std::size_t at = static_cast<std::size_t>(written_ % ring_.size());
  const std::size_t first = std::min(count, ring_.size() - at);
  std::memcpy(ring_.data() + at, rest.data(), first);
  std::memcpy(ring_.data(), rest.data() + first, count - first);
  written_ += count;
  rest = rest.subspan(count);
}

std::size_t RingReader::there() {
  const std::uint64_t count = counts_.written.load(std::memory_order_acquire) - read_;
  sound_ = sound_ && count <= ring_.size();
  return sound_ ? static_cast<std::size_t>(count) : 0;
}

std::size_t RingReader::get(std::span<std::byte> to) {
  const std::size_t count = std::min(to.size(), there());
  if (count == 0) return 0;
  const std::size_t at = static_cast<std::size_t>(read_ % ring_.size());
  const std::size_t first = std::min(count, ring_.size() - at);
  std::memcpy(to.data(), ring_.data() + at, first);
  std::memcpy(to.data() + first, ring_.data(), count - first);
  read_ += count;
  counts_.read.store(read_, std::memory_order_release);
  return count;
}

}  // namespace abut
