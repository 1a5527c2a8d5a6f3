#include "messaging/shared_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <span>
#include <utility>

namespace abut {

namespace {

constexpr std::uint32_t layout = 1;                // of what follows: both ends must have the same
constexpr std::uint32_t frame_mark = 0x74756261u;  // "abut": where a frame begins
constexpr std::size_t page = 4096;
constexpr std::chrono::microseconds most_spin{200};
/// Without the other end reading anything; then the rest waits until it is looked after again.
constexpr std::chrono::milliseconds patience{5};
constexpr int looks_between_clocks = 32;
/// [B] that a buffer keeps when frames are much shorter again.
constexpr std::size_t always_kept = std::size_t{16} << 20;

}  // namespace

/// What lies at the begin of the memory; the rings follow.
struct SharedLink::Shared {
  std::uint32_t layout_version = layout;
  std::uint32_t spin = 0;  // [us]
  std::atomic<std::uint32_t> joined = 0;
  RingCounts to_solver, to_coordinator;
  alignas(64) Doorbell of_solver;
  alignas(64) Doorbell of_coordinator;
};

/// What stands before every frame.
struct SharedLink::FrameHead {
  std::uint32_t mark = 0;
  std::uint32_t body = 0;
  std::uint64_t bytes = 0;
};

void FrameBuffer::hold(std::size_t bytes) {
  const bool wasteful = memory.size() > always_kept && bytes < memory.size() / 8;
  if (memory.size() < bytes || wasteful) memory = std::vector<std::byte>(bytes);
  size = bytes;
}

std::size_t SharedLink::bytes_for(std::size_t ring) {
  static_assert(sizeof(Shared) <= page && sizeof(FrameHead) == head_bytes);
  return page + 2 * ring;
}

std::unique_ptr<SharedLink> SharedLink::make(const Bounds& bounds, std::chrono::microseconds spin,
                                             std::size_t ring) {
  std::unique_ptr<SharedMemory> memory = SharedMemory::make(bytes_for(ring));
  if (!memory) return nullptr;
  Shared* const shared = new (memory->data()) Shared;
  shared->spin = static_cast<std::uint32_t>(spin.count());
  return std::unique_ptr<SharedLink>(new SharedLink(std::move(memory), End::coordinator, bounds));
}

std::unique_ptr<SharedLink> SharedLink::take(int descriptor, const Bounds& bounds) {
  std::unique_ptr<SharedMemory> memory = SharedMemory::take(descriptor);
  if (!memory || memory->size() < bytes_for(2 * head_bytes)) return nullptr;
  Shared* const shared = std::launder(reinterpret_cast<Shared*>(memory->data()));
  if (shared->layout_version != layout) return nullptr;
  std::unique_ptr<SharedLink> link(new SharedLink(std::move(memory), End::solver, bounds));
  shared->joined.store(1, std::memory_order_release);
  return link;
}

namespace {

/// The ring to the solver is the first.
std::span<std::byte> ring_of(SharedMemory& memory, bool to_solver) {
  const std::size_t ring = (memory.size() - page) / 2;
  return std::span(memory.data() + page + (to_solver ? 0 : ring), ring);
}

}  // namespace

SharedLink::SharedLink(std::unique_ptr<SharedMemory> memory, End end, const Bounds& bounds)
    : memory_(std::move(memory)),
      shared_(*std::launder(reinterpret_cast<Shared*>(memory_->data()))),
      bounds_(bounds),
      piece_(std::max<std::size_t>(1, ring_of(*memory_, true).size() / 4)),
      out_(end == End::coordinator ? shared_.to_solver : shared_.to_coordinator,
           ring_of(*memory_, end == End::coordinator)),
      in_(end == End::coordinator ? shared_.to_coordinator : shared_.to_solver,
          ring_of(*memory_, end == End::solver)),
      mine_(end == End::coordinator ? shared_.of_coordinator : shared_.of_solver),
      theirs_(end == End::coordinator ? shared_.of_solver : shared_.of_coordinator),
      spin_(std::min(std::chrono::microseconds(shared_.spin), most_spin)) {}

SharedLink::~SharedLink() = default;

bool SharedLink::joined() const { return shared_.joined.load(std::memory_order_acquire) == 1; }

bool SharedLink::send(std::uint32_t body, Bytes frame, std::shared_ptr<const void> owner) {
  push();
  if (unsent()) wait_for_room();
  if (unsent() || !fault_.empty()) return false;
  const FrameHead head{frame_mark, body, frame.size()};
  std::memcpy(out_head_.data(), &head, sizeof head);
  head_rest_ = out_head_;
  frame_rest_ = frame;
  push();
  if (unsent()) wait_for_room();
  if (unsent() && !owner) {
    kept_.assign(frame_rest_.begin(), frame_rest_.end());
    frame_rest_ = kept_;
  }
  owner_ = unsent() ? std::move(owner) : nullptr;
  return true;
}

/// As much as fits; the other end sees the first piece while the next one is copied.
void SharedLink::push() {
  while (unsent()) {
    const std::size_t before = head_rest_.size() + frame_rest_.size();
    out_.put(head_rest_, head_bytes);
    if (head_rest_.empty()) out_.put(frame_rest_, piece_);
    if (head_rest_.size() + frame_rest_.size() == before) {
      look_at_counts();
      return;
    }
    out_.show();
    theirs_.ring();
  }
  owner_.reset();
}

/// While the other end goes on reading.
void SharedLink::wait_for_room() {
  TimePoint until = std::chrono::steady_clock::now() + patience;
  while (unsent() && fault_.empty()) {
    const std::size_t before = frame_rest_.size();
    push();
    if (!unsent()) return;
    const TimePoint now = std::chrono::steady_clock::now();
    if (frame_rest_.size() != before) until = now + patience;
    if (now >= until) return;
    const TimePoint looked = std::min(until, now + spin_);
    while (out_.room() == 0 && std::chrono::steady_clock::now() < looked) spare_the_core();
    if (out_.room() > 0) continue;
    mine_.lie_down(Sleeper::for_frames_or_room);
    if (out_.room() == 0) mine_.sleep(until - now);
    mine_.get_up();
  }
}

std::optional<std::uint32_t> SharedLink::receive(Milliseconds wait, FrameBuffer& frame) {
  push();
  bool came = take_frame();
  if (!came && wait.count() > 0) {
    const TimePoint begin = std::chrono::steady_clock::now();
    const TimePoint until = begin + wait;
    const bool soon = last_wait_ <= 2 * spin_;
    while (!came && fault_.empty()) {
      const TimePoint now = std::chrono::steady_clock::now();
      if (now >= until) break;
      const bool begun = head_got_ > 0;  // the rest of a frame is on its way: it comes at once
      if (!look(soon || begun ? std::min(until, now + spin_) : now))
        sleep(unsent() ? Sleeper::for_frames_or_room : Sleeper::for_frames, until);
      push();
      came = take_frame();
    }
    last_wait_ = std::chrono::steady_clock::now() - begin;
  }
  if (!came) return std::nullopt;
  std::swap(frame, incoming_);
  return body_;
}

/// Whether there is something to do.
bool SharedLink::stirs() {
  if (in_.there() > 0 || (unsent() && out_.room() > 0)) return true;
  look_at_counts();
  return !fault_.empty();
}

/// Without sleep; whether there is something to do.
bool SharedLink::look(TimePoint until) {
  do {
    for (int i = 0; i < looks_between_clocks; ++i) {
      if (stirs()) return true;
      spare_the_core();
    }
  } while (std::chrono::steady_clock::now() < until);
  return false;
}

void SharedLink::sleep(Sleeper what, TimePoint until) {
  mine_.lie_down(what);
  if (!stirs()) mine_.sleep(until - std::chrono::steady_clock::now());
  mine_.get_up();
}

/// True when a frame is whole.
bool SharedLink::take_frame() {
  if (!fault_.empty() || !take_head()) return false;
  while (frame_got_ < incoming_.size) {
    const std::size_t most = std::min(piece_, incoming_.size - frame_got_);
    const std::size_t count = in_.get(std::span(incoming_.memory).subspan(frame_got_, most));
    if (count == 0) {
      look_at_counts();
      return false;
    }
    frame_got_ += count;
    theirs_.ring_for_room();
  }
  head_got_ = frame_got_ = 0;
  return true;
}

bool SharedLink::take_head() {
  if (head_got_ == head_bytes) return true;
  head_got_ += in_.get(std::span(in_head_).subspan(head_got_));
  look_at_counts();
  if (head_got_ < head_bytes) return false;
  FrameHead head;
  std::memcpy(&head, in_head_.data(), sizeof head);
  if (head.mark != frame_mark || head.body >= bounds_.bodies) {
    fault_ =
        "has left the memory that it shares with this process unsound: no frame begins "
        "where the last one has ended";
    return false;
  }
  if (head.bytes > bounds_.largest()) {
    fault_ = fmt::format("sent a frame of {} bytes, far above the limit of {} bytes", head.bytes,
                         bounds_.frame_bytes);
    return false;
  }
  body_ = head.body;
  incoming_.hold(static_cast<std::size_t>(head.bytes));
  return true;
}

void SharedLink::look_at_counts() {
  if (!fault_.empty() || (in_.sound() && out_.sound())) return;
  fault_ =
      "has left the memory that it shares with this process unsound: it counts bytes that "
      "are not there";
}

}  // namespace abut
