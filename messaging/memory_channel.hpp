#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <vector>

#include "messaging/channel.hpp"

namespace abut {

/// Two queues: the wire path inside one process. Each end may live in its own thread; with
/// `on_idle` both ends run in one thread under a clock that moves only when nothing is left to do.
class MemoryLink {
 public:
  MemoryLink();
  MemoryLink(const MemoryLink&) = delete;
  MemoryLink& operator=(const MemoryLink&) = delete;

  Channel& near() { return near_; }
  Channel& far() { return far_; }
  /// Called instead of waiting when the near end has nothing to receive; it lets the far end work.
  void on_idle(std::function<void()> work);

 private:
  struct Queue {
    std::mutex mutex;
    std::condition_variable arrived;
    std::deque<std::vector<std::byte>> frames;
  };
  class End : public Channel {
   public:
    End(MemoryLink& link, Queue& in, Queue& out) : link_(link), in_(in), out_(out) {}
    using Channel::send;
    bool send(Bytes frame) override;
    std::optional<Bytes> receive(Milliseconds wait) override;
    TimePoint now() const override;

   private:
    bool take();
    MemoryLink& link_;
    Queue& in_;
    Queue& out_;
    std::vector<std::byte> current_;
  };

  Queue to_near_, to_far_;
  End near_, far_;
  std::function<void()> work_;
  TimePoint time_{};  // of the hand-run clock
};

}  // namespace abut
