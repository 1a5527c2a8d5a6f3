#include "messaging/linked_bodies.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <utility>

namespace abut {

namespace {
constexpr std::size_t most_waiting_frames = 64;       // frames of a body; it repeats what it needs
constexpr std::size_t most_waiting_frame_limits = 4;  // what waits, of all, in limits of a frame

SharedLink::Bounds bounds_of(const std::vector<Channel*>& sockets, const Limits& limits) {
  return {static_cast<std::uint32_t>(sockets.size()), limits.frame_bytes};
}
}  // namespace

struct LinkedBodies::Member : Channel {
  Member(LinkedBodies& its, std::uint32_t own_number, Channel& its_socket)
      : group(its), number(own_number), socket(its_socket) {}
  /// From when on all goes through the memory: a solver says Hello until it hears something. Asked
  /// once, as the other end could take its word back.
  bool by_memory() {
    open = open || (group.end_ == SharedLink::End::coordinator && group.link_->joined());
    return open;
  }
  bool send(Bytes frame) override { return send(frame, nullptr); }
  bool send(Bytes frame, std::shared_ptr<const void> owner) override {
    if (by_memory()) return group.link_->send(number, frame, std::move(owner));
    return owner ? socket.send(frame, std::move(owner)) : socket.send(frame);
  }
  std::optional<Bytes> receive(Milliseconds wait) override;
  bool take_waiting();

  LinkedBodies& group;
  std::uint32_t number;
  Channel& socket;
  bool open = false;
  FrameBuffer current;
  std::deque<FrameBuffer> waiting;
};

bool LinkedBodies::Member::take_waiting() {
  if (waiting.empty()) return false;
  current = std::move(waiting.front());
  waiting.pop_front();
  group.waiting_bytes_ -= current.size;
  return true;
}

std::optional<Bytes> LinkedBodies::Member::receive(Milliseconds wait) {
  if (take_waiting()) return current.bytes();
  if (group.end_ == SharedLink::End::coordinator && !by_memory()) return socket.receive(wait);
  const bool waits = wait.count() > 0;
  const TimePoint until = waits ? std::chrono::steady_clock::now() + wait : TimePoint{};
  while (Member* const to = group.receive_one(wait)) {
    if (to == this) {
      std::swap(current, group.received_);
      return current.bytes();
    }
    group.keep_for(*to);
    if (waits)
      wait = std::max(Milliseconds(0),
                      std::chrono::ceil<Milliseconds>(until - std::chrono::steady_clock::now()));
  }
  return std::nullopt;
}

std::unique_ptr<LinkedBodies> LinkedBodies::make(const std::vector<Channel*>& sockets,
                                                 const Limits& limits,
                                                 std::chrono::microseconds spin) {
  std::unique_ptr<SharedLink> link = SharedLink::make(bounds_of(sockets, limits), spin);
  if (!link) return nullptr;
  return std::unique_ptr<LinkedBodies>(
      new LinkedBodies(std::move(link), SharedLink::End::coordinator, sockets, limits));
}

std::unique_ptr<LinkedBodies> LinkedBodies::join(int descriptor,
                                                 const std::vector<Channel*>& sockets,
                                                 const Limits& limits) {
  std::unique_ptr<SharedLink> link = SharedLink::take(descriptor, bounds_of(sockets, limits));
  if (!link) return nullptr;
  return std::unique_ptr<LinkedBodies>(
      new LinkedBodies(std::move(link), SharedLink::End::solver, sockets, limits));
}

LinkedBodies::LinkedBodies(std::unique_ptr<SharedLink> link, SharedLink::End end,
                           const std::vector<Channel*>& sockets, const Limits& limits)
    : link_(std::move(link)),
      end_(end),
      most_waiting_bytes_(most_waiting_frame_limits * limits.frame_bytes) {
  for (Channel* const socket : sockets) {
    const std::uint32_t number = static_cast<std::uint32_t>(members_.size());
    members_.push_back(std::make_unique<Member>(*this, number, *socket));
  }
}

LinkedBodies::~LinkedBodies() = default;

Channel& LinkedBodies::channel(std::size_t body) { return *members_.at(body); }

/// The frame is in `received_`.
LinkedBodies::Member* LinkedBodies::receive_one(Milliseconds wait) {
  const std::optional<std::uint32_t> body = link_->receive(wait, received_);
  if (!body) return nullptr;
  if (members_.size() > 1) last_frame_ = std::chrono::steady_clock::now();
  Member& member = *members_.at(*body);
  member.open = true;
  return &member;
}

/// What is too much is as good as lost: who waits for it repeats its request.
void LinkedBodies::keep_for(Member& member) {
  if (member.waiting.size() >= most_waiting_frames) return;
  if (waiting_bytes_ + received_.size > most_waiting_bytes_) return;
  waiting_bytes_ += received_.size;
  member.waiting.push_back(std::exchange(received_, {}));
}

std::optional<std::size_t> LinkedBodies::wait(Milliseconds time) {
  Member* const member = receive_one(time);
  if (member == nullptr) return std::nullopt;
  keep_for(*member);
  return member->number;
}

}  // namespace abut
