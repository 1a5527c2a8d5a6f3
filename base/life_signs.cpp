#include "base/life_signs.hpp"

#include <utility>

namespace abut {

LifeSigns::LifeSigns(std::function<void()> hook, std::chrono::milliseconds every)
    : hook_(std::move(hook)), thread_([this, every] { run(every); }) {}

LifeSigns::~LifeSigns() { stop(); }

void LifeSigns::end() {
  stop();
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void LifeSigns::stop() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void LifeSigns::run(std::chrono::milliseconds every) {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, every, [this] { return ended_; })) {
    try {
      hook_();
    } catch (...) {
      thrown_ = std::current_exception();
      return;
    }
  }
}

}  // namespace abut
