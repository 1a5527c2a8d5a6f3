#pragma once

#include <memory>
#include <span>

#include "messaging/body_group.hpp"
#include "messaging/channel.hpp"
#include "messaging/serve.hpp"

namespace abut {

/// As serve(), for all bodies of a process: their requests are worked off in the order in which
/// they come, one at a time. Returns when all have had their Finish. `servers` are those of the
/// group's channels, in their order. Throws as Server does; an error of one ends the process of
/// all.
void serve_group(std::span<const std::unique_ptr<Server>> servers, BodyGroup& group,
                 Milliseconds patience);

}  // namespace abut
