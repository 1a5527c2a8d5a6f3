#include "base/endpoint.hpp"

#include <charconv>

namespace abut {

namespace {

/// 127.0.0.0/8 in four numbers: a name of a machine may begin with 127 as well.
bool is_loopback_address(std::string_view host) {
  for (int k = 0; k < 4; ++k) {
    int number = -1;
    const auto [end, error] = std::from_chars(host.data(), host.data() + host.size(), number);
    if (error != std::errc() || number < 0 || number > 255 || (k == 0 && number != 127))
      return false;
    host.remove_prefix(static_cast<std::size_t>(end - host.data()));
    if (k == 3) return host.empty();
    if (!host.starts_with('.')) return false;
    host.remove_prefix(1);
  }
  return false;
}

}  // namespace

bool is_local_endpoint(std::string_view endpoint) {
  if (endpoint.starts_with("ipc://")) return true;
  constexpr std::string_view tcp = "tcp://";
  const std::size_t port = endpoint.rfind(':');
  if (!endpoint.starts_with(tcp) || port < tcp.size()) return false;
  const std::string_view host = endpoint.substr(tcp.size(), port - tcp.size());
  return host == "localhost" || is_loopback_address(host);
}

}  // namespace abut
