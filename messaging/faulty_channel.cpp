#include "messaging/faulty_channel.hpp"

#include <cstddef>

namespace abut {

FaultyChannel::FaultyChannel(Channel& inner, const Chances& chances, std::uint64_t seed)
    : inner_(inner), chances_(chances), random_(seed) {}

bool FaultyChannel::happens(double chance) {
  // Not a standard distribution: those differ between libraries, and a seed is to mean one thing.
  return static_cast<double>(random_() >> 11) * 0x1.0p-53 < chance;
}

std::vector<std::byte> FaultyChannel::damaged(Bytes frame) {
  std::vector<std::byte> bytes(frame.begin(), frame.end());
  if (bytes.empty()) return bytes;
  const std::size_t at = random_() % bytes.size();
  if (happens(0.5)) {
    bytes.resize(at);
  } else {
    bytes[at] ^= std::byte{1} << (random_() % 8);
  }
  return bytes;
}

void FaultyChannel::release_due() {
  for (std::size_t i = 0; i < held_.size();) {
    if (--held_[i].first > 0) {
      ++i;
      continue;
    }
    inner_.send(held_[i].second);
    held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

bool FaultyChannel::send(Bytes frame) {
  release_due();
  ++counts_.sent;
  if (happens(chances_.drop) || counts_.sent == chances_.lose) {
    ++counts_.dropped;
    return true;
  }
  std::vector<std::byte> bytes(frame.begin(), frame.end());
  if (happens(chances_.corrupt)) {
    ++counts_.corrupted;
    bytes = damaged(frame);
  }
  if (happens(chances_.duplicate)) {
    ++counts_.duplicated;
    inner_.send(bytes);
  }
  if (happens(chances_.delay)) {
    ++counts_.delayed;
    held_.emplace_back(1 + static_cast<int>(random_() % longest_delay), std::move(bytes));
    return true;
  }
  return inner_.send(bytes);
}

std::optional<Bytes> FaultyChannel::receive(Milliseconds wait) {
  release_due();
  return inner_.receive(wait);
}

}  // namespace abut
