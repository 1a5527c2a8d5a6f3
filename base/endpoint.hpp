#pragma once

#include <string_view>

namespace abut {

/// Whether an endpoint of ZeroMQ ("ipc://path", "tcp://host:port") is one that no other machine can
/// reach. In doubt it is not.
bool is_local_endpoint(std::string_view endpoint);

}  // namespace abut
