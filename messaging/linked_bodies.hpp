#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/body_group.hpp"
#include "messaging/channel.hpp"
#include "messaging/protocol.hpp"
#include "messaging/shared_link.hpp"

namespace abut {

/// The bodies of a process that the coordinator has started, behind the memory that both share. A
/// solver says its Hello by its socket, and all else goes through the memory; a solver that has not
/// joined it is talked to by its socket alone.
class LinkedBodies : public BodyGroup {
 public:
  /// The coordinator's end. `sockets`: of the bodies, in their order; must outlive this object.
  /// `spin`: as SharedLink::make has it. Null where this machine gives no such memory.
  static std::unique_ptr<LinkedBodies> make(const std::vector<Channel*>& sockets,
                                            const Limits& limits, std::chrono::microseconds spin);
  /// The solver's end of what was handed over as this descriptor. Null where it was nothing.
  static std::unique_ptr<LinkedBodies> join(int descriptor, const std::vector<Channel*>& sockets,
                                            const Limits& limits);
  ~LinkedBodies() override;
  LinkedBodies(const LinkedBodies&) = delete;
  LinkedBodies& operator=(const LinkedBodies&) = delete;

  Channel& channel(std::size_t body) override;
  std::optional<std::size_t> wait(Milliseconds time) override;
  /// To hand over to the process.
  int descriptor() const { return link_->descriptor(); }
  void handed_over() { link_->handed_over(); }
  /// When a frame last came through the memory; the clock's begin: never.
  TimePoint last_frame() const { return last_frame_; }
  /// What is wrong with the other end, as a predicate; empty: nothing.
  const std::string& fault() const { return link_->fault(); }

 private:
  struct Member;
  LinkedBodies(std::unique_ptr<SharedLink> link, SharedLink::End end,
               const std::vector<Channel*>& sockets, const Limits& limits);
  Member* receive_one(Milliseconds wait);
  void keep_for(Member& member);

  std::unique_ptr<SharedLink> link_;
  SharedLink::End end_;
  std::vector<std::unique_ptr<Member>> members_;
  std::size_t waiting_bytes_ = 0, most_waiting_bytes_;  // of all members
  FrameBuffer received_;
  TimePoint last_frame_{};
};

}  // namespace abut
