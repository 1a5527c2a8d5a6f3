#include "messaging/liveness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "messaging/zmq_socket.hpp"

namespace abut {

namespace {
// A broken connection heals by reconnecting; one that breaks at every repeat of a request does not.
constexpr int disconnects_of_the_living = 3;
// A process that ends closes its socket a moment before it can be waited for.
constexpr Milliseconds time_to_exit{1'000};
}  // namespace

BodyLiveness::BodyLiveness(ZmqHub& hub, int peer, ChildProcess* child, std::string shares,
                           const Limits& limits, const Deadlines& deadlines,
                           const LinkedBodies* linked)
    : hub_(hub),
      peer_(peer),
      child_(child),
      shares_(std::move(shares)),
      limits_(limits),
      deadlines_(deadlines),
      linked_(linked) {}

TimePoint BodyLiveness::last_sign() {
  const TimePoint by_hub = hub_.last_frame(peer_);
  return linked_ != nullptr ? std::max(by_hub, linked_->last_frame()) : by_hub;
}

std::string BodyLiveness::loss(TimePoint since) {
  const TimePoint now = std::chrono::steady_clock::now();
  stood_still_ = std::chrono::duration_cast<Milliseconds>(now - std::max(since, asked_));
  asked_ = now;
  const std::string what = loss_of_process(since);
  if (what.empty() || shares_.empty()) return what;
  return fmt::format("shares a process with {}, which {}", shares_, what);
}

/// Of a solver that believes its coordinator gone.
std::string BodyLiveness::why_it_left() const {
  const double silence = static_cast<double>(longest_silence.count()) / 1000.0;
  if (stood_still_ >= longest_silence)
    return fmt::format(
        "as this process stood still for {:.0f} s: solvers leave a coordinator that answers "
        "nothing for {:g} s",
        static_cast<double>(stood_still_.count()) / 1000.0, silence);
  return fmt::format(
      "as solvers do whose connection ends (a frame far above the limit of {} bytes ends it, and "
      "so does a coordinator that is stopped for {:g} s)",
      limits_.frame_bytes, silence);
}

std::string BodyLiveness::loss_of_process(TimePoint since) {
  const std::string hint = fmt::format(
      "(a frame far above the limit of {} bytes ends a connection)", limits_.frame_bytes);
  if (linked_ != nullptr && !linked_->fault().empty()) return linked_->fault();
  if (child_ != nullptr && child_->ended(Milliseconds(0))) {
    // Code 3 is a solver that believes its coordinator gone: it was this end that hung up.
    return child_->exited_with(3) ? child_->ending() + ", " + why_it_left() : child_->ending();
  }
  if (hub_.disconnects(peer_, since) >= disconnects_of_the_living) {
    return fmt::format("lost its connection {} times ", disconnects_of_the_living) + hint;
  }
  const std::optional<TimePoint> gone = hub_.gone_since(peer_);
  const Milliseconds grace = child_ != nullptr ? time_to_exit : deadlines_.reconnect;
  if (gone && std::chrono::steady_clock::now() - *gone > grace) {
    return fmt::format("closed its connection and did not come back within {} s",
                       static_cast<double>(grace.count()) / 1000.0);
  }
  return {};
}

CoordinatorLiveness::CoordinatorLiveness(ZmqDealer& dealer, const std::string& endpoint,
                                         const Deadlines& deadlines, const LinkedBodies* linked)
    : dealer_(dealer),
      // On one machine a closed socket is a dead coordinator; a network may come back.
      grace_(endpoint.starts_with("ipc:") ? Milliseconds(0) : deadlines.reconnect),
      linked_(linked) {}

std::string CoordinatorLiveness::loss(TimePoint) {
  if (linked_ != nullptr && !linked_->fault().empty()) return linked_->fault();
  const std::optional<TimePoint> gone = dealer_.gone_since();
  if (!gone || std::chrono::steady_clock::now() - *gone < grace_) return {};
  return "is gone";
}

}  // namespace abut
