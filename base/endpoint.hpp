#pragma once

#include <string_view>

namespace abut {

/// Whether an endpoint of ZeroMQ ("ipc://path", "tcp://host:port") is one that no other machine can
/// reach. In doubt it is not.
bool is_local_endpoint(std::string_view endpoint);

/// What keeps it from being one of the kinds "ipc://path" and "tcp://host:port", after the words
/// "must ..."; empty: nothing. The port is 0 (any that is free) to 65535, or * alike.
std::string_view wrong_endpoint(std::string_view endpoint);

}  // namespace abut
