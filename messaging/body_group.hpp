#pragma once

#include <cstddef>
#include <optional>

#include "messaging/channel.hpp"

namespace abut {

/// The bodies of one process, numbered from 0, each with a channel of its own.
class BodyGroup {
 public:
  virtual ~BodyGroup() = default;
  virtual Channel& channel(std::size_t body) = 0;
  /// Waits for a frame of any of them, which its channel then has without a wait; tells whose it
  /// is. Nothing when none came.
  virtual std::optional<std::size_t> wait(Milliseconds time) = 0;
};

}  // namespace abut
