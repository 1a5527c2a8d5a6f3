#include "messaging/memory_channel.hpp"

#include <utility>

namespace abut {

MemoryLink::MemoryLink() : near_(*this, to_near_, to_far_), far_(*this, to_far_, to_near_) {}

void MemoryLink::on_idle(std::function<void()> work) { work_ = std::move(work); }

bool MemoryLink::End::send(Bytes frame) {
  {
    const std::lock_guard<std::mutex> lock(out_.mutex);
    out_.frames.emplace_back(frame.begin(), frame.end());
  }
  out_.arrived.notify_one();
  return true;
}

bool MemoryLink::End::take() {
  if (in_.frames.empty()) return false;
  current_ = std::move(in_.frames.front());
  in_.frames.pop_front();
  return true;
}

std::optional<Bytes> MemoryLink::End::receive(Milliseconds wait) {
  if (link_.work_ && this == &link_.near_ && in_.frames.empty()) link_.work_();
  std::unique_lock<std::mutex> lock(in_.mutex);
  if (take()) return Bytes(current_);
  if (link_.work_) {
    if (this == &link_.near_) link_.time_ += wait;
    return std::nullopt;
  }
  in_.arrived.wait_for(lock, wait, [this] { return !in_.frames.empty(); });
  if (!take()) return std::nullopt;
  return Bytes(current_);
}

TimePoint MemoryLink::End::now() const {
  return link_.work_ ? link_.time_ : std::chrono::steady_clock::now();
}

}  // namespace abut
