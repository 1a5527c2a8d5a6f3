#include "base/endpoint.hpp"

#include <charconv>

namespace abut {

namespace {

/// 127.0.0.0/8 in four numbers: a name of a machine may begin with 127 as well, and 0127 is 87.
bool is_loopback_address(std::string_view host) {
  for (int k = 0; k < 4; ++k) {
    int number = -1;
    const auto [end, error] = std::from_chars(host.data(), host.data() + host.size(), number);
    if (error != std::errc() || number < 0 || number > 255 || (k == 0 && number != 127))
      return false;
    if (host.size() > 1 && host[0] == '0' && host[1] >= '0' && host[1] <= '9') return false;
    host.remove_prefix(static_cast<std::size_t>(end - host.data()));
    if (k == 3) return host.empty();
    if (!host.starts_with('.')) return false;
    host.remove_prefix(1);
  }
  return false;
}

}  // namespace

std::string_view wrong_endpoint(std::string_view endpoint) {
  constexpr std::string_view ipc = "ipc://", tcp = "tcp://";
  if (endpoint.starts_with(ipc)) return endpoint.size() > ipc.size() ? "" : "name a path";
  if (!endpoint.starts_with(tcp)) return "begin with tcp:// or ipc://";
  const std::size_t colon = endpoint.rfind(':');
  if (colon <= tcp.size()) return "end with a port, as in tcp://127.0.0.1:5555";
  const std::string_view port = endpoint.substr(colon + 1);
  if (port == "*") return "";
  int number = -1;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  const bool whole = error == std::errc() && end == port.data() + port.size();
  return whole && number >= 0 && number <= 65535 ? "" : "have a port from 0 to 65535";
}

bool is_local_endpoint(std::string_view endpoint) {
  if (endpoint.starts_with("ipc://")) return true;
  constexpr std::string_view tcp = "tcp://";
  const std::size_t port = endpoint.rfind(':');
  if (!endpoint.starts_with(tcp) || port < tcp.size()) return false;
  const std::string_view host = endpoint.substr(tcp.size(), port - tcp.size());
  return host == "localhost" || is_loopback_address(host);
}

}  // namespace abut
