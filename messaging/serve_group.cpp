#include "messaging/serve_group.hpp"

#include <cstddef>
#include <optional>

#include "base/denormals.hpp"

namespace abut {

void serve_group(std::span<const std::unique_ptr<Server>> servers, BodyGroup& group,
                 Milliseconds patience) {
  const FlushedDenormals flushed;  // as in the coordinator: equal bits in every placement
  const TimePoint begin = group.channel(0).now();
  for (const std::unique_ptr<Server>& server : servers) server->greet_when_due(begin, patience);
  std::size_t left = servers.size();
  while (left > 0) {
    if (const std::optional<std::size_t> body = group.wait(Milliseconds(100))) {
      Server& server = *servers[*body];
      const bool finished = server.finished();  // a Finish may be repeated
      if (!server.step(Milliseconds(0)) && !finished) --left;
      continue;
    }
    // Nothing is waiting any more, no welcome either.
    for (const std::unique_ptr<Server>& server : servers) server->greet_when_due(begin, patience);
    servers.front()->check_coordinator();
  }
}

}  // namespace abut
