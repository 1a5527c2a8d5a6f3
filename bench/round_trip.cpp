// What one exchange with a body in another process costs beyond the solve, against a bare ZeroMQ
// ROUTER/DEALER round trip of the same frame sizes over the same kind of socket (ipc). Both are
// measured in turns, block by block, so that a change of the machine's mood meets both; medians,
// one line per size.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zmq.hpp>

#include "bench/exchange.hpp"

namespace {

using namespace abut;
using namespace abut::bench;

constexpr int blocks = 60;
constexpr int exchanges_per_block = 100;
constexpr double accepted_ratio = 1.5;

/// The other end of the bare round trip: answers with as many bytes as the first 8 of a frame say.
[[noreturn]] void echo_process(const std::string& endpoint) {
  zmq::context_t context(1);
  zmq::socket_t socket(context, zmq::socket_type::dealer);
  socket.set(zmq::sockopt::routing_id, "body");
  socket.connect(endpoint);
  std::vector<std::byte> reply(1 << 23);
  socket.send(zmq::buffer(reply.data(), 8), zmq::send_flags::none);
  zmq::message_t message;
  for (;;) {
    if (!socket.recv(message)) continue;
    std::uint64_t size = 0;
    std::memcpy(&size, message.data(), sizeof size);
    socket.send(zmq::buffer(reply.data(), size), zmq::send_flags::none);
  }
}

class BareExchange {
 public:
  explicit BareExchange(const std::string& endpoint)
      : context_(1), socket_(context_, zmq::socket_type::router) {
    socket_.bind(endpoint);
    receive();
  }
  void prepare(std::pair<std::size_t, std::size_t> sizes) {
    request_.assign(sizes.first, std::byte{1});
    const std::uint64_t reply = sizes.second;
    std::memcpy(request_.data(), &reply, sizeof reply);
  }
  double once() {
    const Clock::time_point begin = Clock::now();
    socket_.send(zmq::buffer("body", 4), zmq::send_flags::sndmore);
    socket_.send(zmq::buffer(request_), zmq::send_flags::none);
    receive();
    return microseconds(Clock::now() - begin);
  }

 private:
  void receive() {
    if (!socket_.recv(sender_) || !socket_.recv(message_)) std::abort();
  }
  zmq::context_t context_;
  zmq::socket_t socket_;
  std::vector<std::byte> request_;
  zmq::message_t sender_, message_;
};

struct Measured {
  std::vector<double> ours, bare;  // [us]
};

/// In turns; the first block warms up.
Measured measure(OurExchange& ours, BareExchange& bare, int count, int each) {
  Measured out;
  for (int block = 0; block <= count; ++block) {
    for (int i = 0; i < each; ++i) {
      const double time = bare.once();
      if (block > 0) out.bare.push_back(time);
    }
    for (int i = 0; i < each; ++i) {
      const double time = ours.once();
      if (block > 0) out.ours.push_back(time);
    }
  }
  return out;
}

void print(int first, const std::pair<std::size_t, std::size_t>& sizes, const Measured& m,
           double last) {
  fmt::print(
      "{:>8} {:>7} {:>7}   {:>6.1f} ({:.1f} to {:.1f})   {:>6.1f} ({:.1f} to {:.1f})   {:.2f}\n",
      first, sizes.first, sizes.second, quantile(m.bare, 0.5), quantile(m.bare, 0.1),
      quantile(m.bare, 0.9), quantile(m.ours, 0.5), quantile(m.ours, 0.1), quantile(m.ours, 0.9),
      last);
}

/// Prints one line; true when the ratio is accepted.
bool measure_substeps(OurExchange& ours, BareExchange& bare, int substeps) {
  const std::pair<std::size_t, std::size_t> sizes = ours.prepare(substeps);
  bare.prepare(sizes);
  const Measured m = measure(ours, bare, blocks, exchanges_per_block);
  const double ratio = quantile(m.ours, 0.5) / quantile(m.bare, 0.5);
  print(substeps, sizes, m, ratio);
  return ratio <= accepted_ratio;
}

/// [us] What the four copies of a wave take that no codec could leave out: into a frame and out of
/// it, there and back, each from and to a place of its own.
double copies(std::size_t bytes) {
  const std::vector<std::vector<std::byte>> from(4, std::vector<std::byte>(bytes));
  std::vector<std::vector<std::byte>> to = from;
  std::vector<double> times;
  for (int i = 0; i < 41; ++i) {
    const Clock::time_point begin = Clock::now();
    for (std::size_t copy = 0; copy < from.size(); ++copy) {
      std::memcpy(to[copy].data(), from[copy].data(), bytes);
      asm volatile("" : : "r"(to[copy].data()) : "memory");  // each of them counts
    }
    times.push_back(microseconds(Clock::now() - begin));
  }
  return quantile(times, 0.5);
}

/// A surface of points at both ends of a substep: milliseconds beyond the bare round trip and the
/// copies.
void measure_surface(OurExchange& ours, BareExchange& bare, int points, double goal) {
  const std::pair<std::size_t, std::size_t> sizes = ours.prepare_surface(points);
  bare.prepare(sizes);
  const Measured m = measure(ours, bare, 10, 20);
  const double beyond = quantile(m.ours, 0.5) - quantile(m.bare, 0.5) - copies(sizes.first);
  print(points, sizes, m, beyond / 1000.0);
  fmt::print("{:>86} {:.2f}\n", "goal", goal);
}

}  // namespace

int main() {
  std::string directory = "/tmp/abut-bench-XXXXXX";
  if (mkdtemp(directory.data()) == nullptr) return 1;
  const std::string ours_at = "ipc://" + directory + "/ours";
  const std::string bare_at = "ipc://" + directory + "/bare";
  const std::string small_at = "ipc://" + directory + "/small";
  const std::string large_at = "ipc://" + directory + "/large";
  const pid_t solver = start_process([&] { solve(ours_at, 1); });
  const pid_t small = start_process([&] { solve(small_at, 10'000); });
  const pid_t large = start_process([&] { solve(large_at, 100'000); });
  const pid_t echo = start_process([&] { echo_process(bare_at); });
  stay_on_core(0);
  bool accepted = true;
  {
    OurExchange ours(ours_at);
    BareExchange bare(bare_at);
    fmt::print("Exchange over ipc, in microseconds: median (10 % to 90 %)\n");
    fmt::print(
        "  points   bytes   bytes   bare ZeroMQ              surface: motion there, force back   "
        "ms beyond it and four copies\n");
    {
      OurExchange of_small(small_at), of_large(large_at);
      measure_surface(of_small, bare, 10'000, 0.15);
      measure_surface(of_large, bare, 100'000, 2.5);
    }
    fmt::print("Exchange over ipc, {} of each, in microseconds: median (10 % to 90 %)\n",
               blocks * exchanges_per_block);
    fmt::print(
        "substeps   bytes   bytes   bare ZeroMQ              exchange less solving    ratio\n");
    fmt::print("           there    back\n");
    for (const int substeps : {1, 10, 100, 1000})
      accepted = measure_substeps(ours, bare, substeps) && accepted;
  }
  for (const pid_t id : {solver, small, large, echo}) end_process(id);
  for (const char* name : {"/ours", "/small", "/large", "/bare", ""}) {
    if (std::remove((directory + name).c_str()) != 0) continue;  // libzmq removes its own
  }
  fmt::print("limit {:.1f}: {}\n", accepted_ratio, accepted ? "kept" : "EXCEEDED");
  return accepted ? 0 : 1;
}
