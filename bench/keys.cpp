// What keys cost an exchange over TCP on one machine: with them it is encrypted and signed (CURVE),
// without them it is not. Both are measured in turns, block by block; medians, one line per size.
// The cipher passes about 1 GB/s, so that of long frames it is the bytes that cost: no limit there.
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/exchange.hpp"

namespace {

using namespace abut;
using namespace abut::bench;

constexpr int blocks = 60;
constexpr int exchanges_per_block = 100;
constexpr double accepted_ratio = 1.25;

/// "tcp://127.0.0.1:PORT" where nobody listens now.
std::string free_endpoint() {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (probe < 0 || bind(probe, any, size) != 0 || getsockname(probe, any, &size) != 0) std::abort();
  close(probe);
  return fmt::format("tcp://127.0.0.1:{}", ntohs(address.sin_port));
}

/// Prints one line; answers the ratio.
double measure(OurExchange& open, OurExchange& keyed, int substeps) {
  const std::pair<std::size_t, std::size_t> sizes = open.prepare(substeps);
  keyed.prepare(substeps);
  std::vector<double> without, with;               // [us]
  for (int block = 0; block <= blocks; ++block) {  // the first one warms up
    for (int i = 0; i < exchanges_per_block; ++i) {
      const double time = open.once();
      if (block > 0) without.push_back(time);
    }
    for (int i = 0; i < exchanges_per_block; ++i) {
      const double time = keyed.once();
      if (block > 0) with.push_back(time);
    }
  }
  const double ratio = quantile(with, 0.5) / quantile(without, 0.5);
  fmt::print(
      "{:>8} {:>7} {:>7}   {:>6.1f} ({:.1f} to {:.1f})   {:>6.1f} ({:.1f} to {:.1f})   {:.2f}\n",
      substeps, sizes.first, sizes.second, quantile(without, 0.5), quantile(without, 0.1),
      quantile(without, 0.9), quantile(with, 0.5), quantile(with, 0.1), quantile(with, 0.9), ratio);
  return ratio;
}

}  // namespace

int main() {
  std::string directory = "/tmp/abut-bench-XXXXXX";
  if (mkdtemp(directory.data()) == nullptr) return 1;
  const std::string keys = directory + "/keys";
  write_keys(keys, std::vector<std::string>{"body"});
  const std::string open_at = free_endpoint(), keyed_at = free_endpoint();
  const pid_t without = start_process([&] { solve(open_at, 1); });
  const pid_t with = start_process([&] { solve(keyed_at, 1, Access{keys, false}); });
  stay_on_core(0);
  bool accepted = true;
  {
    OurExchange open(open_at), keyed(keyed_at, keys);
    fmt::print("Exchange over loopback TCP, {} of each, in microseconds: median (10 % to 90 %)\n",
               blocks * exchanges_per_block);
    fmt::print(
        "substeps   bytes   bytes   without keys             with keys                ratio\n");
    fmt::print("           there    back\n");
    for (const int substeps : {1, 10, 100})
      accepted = measure(open, keyed, substeps) <= accepted_ratio && accepted;
    measure(open, keyed, 1000);
  }
  end_process(without);
  end_process(with);
  std::filesystem::remove_all(directory);
  fmt::print("limit {:.2f} up to 100 substeps: {}\n", accepted_ratio,
             accepted ? "kept" : "EXCEEDED");
  return accepted ? 0 : 1;
}
