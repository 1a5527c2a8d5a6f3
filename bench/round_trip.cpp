// What one exchange with a body in another process costs beyond the solve: through memory that both
// processes share, and through sockets (ipc), against a bare ZeroMQ ROUTER/DEALER round trip of the
// same frame sizes. All are measured in turns, block by block, so that a change of the machine's
// mood meets all; medians, one line per size.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zmq.hpp>

#include "bench/exchange.hpp"

namespace {

using namespace abut;
using namespace abut::bench;

int blocks = 60;  // another number as argument: sooner, and less sure
constexpr int exchanges_per_block = 100;
constexpr double accepted_ratio = 1.5;
constexpr int usual_spin = 50;  // [us] as the coordinator has it

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

/// The ways of an exchange, side by side.
struct Ways {
  BareExchange& bare;
  OurExchange& sockets;
  OurExchange& looking;   // through memory, as where each process has a core
  OurExchange& sleeping;  // through memory, as where it has none: nobody looks before it sleeps
};

struct Measured {
  std::vector<double> bare, sockets, looking, sleeping;  // [us]
};

template <class Exchange>
void take(Exchange& exchange, int each, bool counts, std::vector<double>& times) {
  for (int i = 0; i < each; ++i) {
    const double time = exchange.once();
    if (counts) times.push_back(time);
  }
}

/// In turns; the first block warms up.
Measured measure(const Ways& ways, int count, int each) {
  Measured out;
  for (int block = 0; block <= count; ++block) {
    take(ways.bare, each, block > 0, out.bare);
    take(ways.sockets, each, block > 0, out.sockets);
    take(ways.looking, each, block > 0, out.looking);
    take(ways.sleeping, each, block > 0, out.sleeping);
  }
  return out;
}

std::string words(const std::vector<double>& times) {
  return fmt::format("{:.1f} ({:.1f} to {:.1f})", quantile(times, 0.5), quantile(times, 0.1),
                     quantile(times, 0.9));
}

void print(int first, const std::pair<std::size_t, std::size_t>& sizes, const Measured& m) {
  fmt::print("{:>8} {:>7} {:>7}   {:26} {:26} {:26} {:26}", first, sizes.first, sizes.second,
             words(m.bare), words(m.sockets), words(m.looking), words(m.sleeping));
}

/// Prints one line; true when the ratio of sockets is accepted.
bool measure_substeps(const Ways& ways, int substeps) {
  const std::pair<std::size_t, std::size_t> sizes = ways.sockets.prepare(substeps);
  ways.looking.prepare(substeps);
  ways.sleeping.prepare(substeps);
  ways.bare.prepare(sizes);
  const Measured m = measure(ways, blocks, exchanges_per_block);
  const double ratio = quantile(m.sockets, 0.5) / quantile(m.bare, 0.5);
  print(substeps, sizes, m);
  fmt::print(" {:.2f}  {:.2f}  {:.2f}\n", ratio, quantile(m.looking, 0.5) / quantile(m.bare, 0.5),
             quantile(m.sleeping, 0.5) / quantile(m.bare, 0.5));
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

/// A surface of points at both ends of a substep: milliseconds beyond the four copies.
void measure_surface(const Ways& ways, int points, double goal) {
  const std::pair<std::size_t, std::size_t> sizes = ways.sockets.prepare_surface(points);
  ways.looking.prepare_surface(points);
  ways.sleeping.prepare_surface(points);
  ways.bare.prepare(sizes);
  const Measured m = measure(ways, std::min(blocks, 10), 20);
  const double least = copies(sizes.first);
  print(points, sizes, m);
  fmt::print(" {:.2f}  {:.2f}  (goal {:.1f})\n", (quantile(m.sockets, 0.5) - least) / 1000.0,
             (quantile(m.looking, 0.5) - least) / 1000.0, goal);
}

constexpr const char* columns =
    "bare ZeroMQ                sockets                    memory                     memory, "
    "without looking   ";

bool measure_all(const std::string& directory, const std::vector<std::string>& at) {
  const auto through = [&](int points, int spin) {
    return std::make_unique<OurExchange>(fmt::format("ipc://{}/{}_{}", directory, points, spin),
                                         points, std::chrono::microseconds(spin));
  };
  BareExchange bare(at[0]);
  const double goals[] = {0.1, 1.5};  // [ms] of surfaces
  fmt::print("Exchange of surfaces, in microseconds: median (10 % to 90 %)\n");
  fmt::print("  points   bytes   bytes   {}ms beyond four copies: sockets, memory\n", columns);
  for (const int which : {0, 1}) {
    const int points = which == 0 ? 10'000 : 100'000;
    OurExchange sockets(at[index(2 + which)]);
    const auto looking = through(points, usual_spin), sleeping = through(points, 0);
    measure_surface({bare, sockets, *looking, *sleeping}, points, goals[which]);
  }
  OurExchange sockets(at[1]);
  const auto looking = through(1, usual_spin), sleeping = through(1, 0);
  fmt::print("Exchange less solving, {} of each, in microseconds: median (10 % to 90 %)\n",
             blocks * exchanges_per_block);
  fmt::print("substeps   bytes   bytes   {}over the bare one\n", columns);
  bool accepted = true;
  for (const int substeps : {1, 10, 100, 1000})
    accepted = measure_substeps({bare, sockets, *looking, *sleeping}, substeps) && accepted;
  return accepted;
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 1) blocks = std::max(1, std::atoi(arguments[1]));
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // each line as it comes
  std::string directory = "/tmp/abut-bench-XXXXXX";
  if (mkdtemp(directory.data()) == nullptr) return 1;
  std::vector<std::string> at;
  for (const char* name : {"/bare", "/one", "/small", "/large"})
    at.push_back("ipc://" + directory + name);
  std::vector<pid_t> others{start_process([&] { echo_process(at[0]); })};
  for (const int which : {1, 2, 3})
    others.push_back(start_process([&] {
      solve(at[index(which)], which == 1 ? 1 : which == 2 ? 10'000 : 100'000);
    }));
  stay_on_core(0);
  const bool accepted = measure_all(directory, at);
  for (const pid_t id : others) end_process(id);
  std::filesystem::remove_all(directory);
  fmt::print("sockets over bare ZeroMQ, limit {:.1f}: {}\n", accepted_ratio,
             accepted ? "kept" : "EXCEEDED");
  return accepted ? 0 : 1;
}
