// What one exchange with a body in another process costs beyond the solve, against a bare ZeroMQ
// ROUTER/DEALER round trip of the same frame sizes over the same kind of socket (ipc). Both are
// measured in turns, block by block, so that a change of the machine's mood meets both; medians,
// one line per size.
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zmq.hpp>

#include "base/index.hpp"
#include "messaging/codec.hpp"
#include "messaging/codec/wire.hpp"
#include "messaging/frame.hpp"
#include "messaging/liveness.hpp"
#include "messaging/remote_subdomain.hpp"
#include "messaging/serve.hpp"
#include "messaging/zmq_channel.hpp"
#include "messaging/zmq_dealer.hpp"

namespace {

using namespace abut;
using Clock = std::chrono::steady_clock;

constexpr int blocks = 60;
constexpr int exchanges_per_block = 100;
constexpr double accepted_ratio = 1.5;

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

double quantile(std::vector<double> values, double part) {
  const std::size_t at = static_cast<std::size_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// Fills a waveform with numbers that no codec could shorten.
Waveform wave(int substeps) {
  Waveform w(1);
  for (int i = 0; i <= substeps; ++i) {
    w.time.push_back(1.0e-7 * i);
    for (std::vector<double>* field : {&w.u, &w.v, &w.a, &w.f}) field->push_back(1.0 / (3.0 + i));
  }
  return w;
}

/// The same on a surface of points in space: one field, a substep.
Waveform wave_of_surface(int points, std::vector<double> Waveform::*field) {
  Waveform w(3 * points);
  w.time = {0.0, 1.0e-7};
  for (int i = 0; i < 2 * w.width; ++i) (w.*field).push_back(1.0 / (3.0 + i));
  return w;
}

/// Answers every window with the same response: all that is left of an exchange is its overhead. Of
/// one point it answers forces by motion, of several the motion of an obstacle by the reaction.
class InstantBody : public Subdomain {
 public:
  explicit InstantBody(int points) : points_(points) {
    description_.dim = points > 1 ? 3 : 1;
    description_.mass = 1.0;
    description_.ports.resize(1);
    description_.ports[0].name = "tip";
    PortGeometry& geometry = description_.ports[0].geometry;
    geometry.dim = description_.dim;
    geometry.points.assign(index(points * geometry.dim), 0.0);
    geometry.normals.assign(geometry.points.size(), 0.0);  // points without facets face nothing
    if (points == 1) geometry.normals = {1.0};
    description_.can.obstacle = points > 1;
  }
  const Description& describe() const override { return description_; }
  void save() override {}
  void restore() override {}
  void start(const Advance& request) override { request_ = &request; }
  Outcome finish(Response& response) override {
    const Clock::time_point begin = Clock::now();
    if (points_ > 1) {
      answer_obstacle(response);
      response.compute_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
      return Advanced{};
    }
    const int substeps = static_cast<int>(request_->boundary[0].forces[0].size()) - 1;
    if (response.steps != substeps) {
      response.ports.resize(1);
      response.ports[0].trace = wave(substeps);
      response.ports[0].lower = {-1.0};  // holds the wave
      response.ports[0].upper = {1.0};
      response.records.resize(1);
      response.records[0].momentum = {0.0};
      response.records[0].time = request_->window.end;
      response.steps = substeps;
    }
    response.compute_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return Advanced{};
  }
  void meet(const Meeting&) override {}
  PortKernel probe(const Probing&) override { return {}; }
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte>) override {}
  std::uint64_t state_hash() override { return 0; }

 private:
  void answer_obstacle(Response& response) {
    if (response.steps == 1) return;
    response.ports.resize(1);
    PortResponse& port = response.ports[0];
    port.trace = Waveform(3 * points_);
    port.trace.time = {0.0, 1.0e-7};
    port.reactions = {Reaction{wave_of_surface(points_, &Waveform::f)}};
    port.lower = port.upper = {0.0, 0.0, 0.0};
    response.records.resize(1);
    response.records[0].momentum = {0.0, 0.0, 0.0};
    response.records[0].time = request_->window.end;
    response.steps = 1;
  }

  int points_;
  Description description_;
  const Advance* request_ = nullptr;
};

/// The solver's process: our own server, as abut-solver runs it.
template <int points>
[[noreturn]] void solver_process(const std::string& endpoint) {
  const Limits limits;
  const Deadlines deadlines;
  ZmqDealer dealer(endpoint, "body", limits);
  CoordinatorLiveness coordinator(dealer, endpoint, deadlines);
  const MakeBody make = [](const Specification&, const ProgressHook&) {
    return std::unique_ptr<Subdomain>(std::make_unique<InstantBody>(points));
  };
  Server server("body", make, dealer, coordinator, limits, deadlines);
  serve(server, Milliseconds(10'000));
  std::_Exit(0);
}

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

/// Where the kernel puts threads makes a factor of two. Both kinds of exchange get the same places:
/// the near end with its I/O threads on one core, the far ends on another, where there are two.
void stay_on_core(std::size_t core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  if (sysconf(_SC_NPROCESSORS_ONLN) > 1) sched_setaffinity(0, sizeof cores, &cores);
}

pid_t start_process(void (*run)(const std::string&), const std::string& endpoint) {
  const pid_t id = fork();
  if (id != 0) return id;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  stay_on_core(1);
  run(endpoint);
  std::_Exit(1);
}

/// Ours: start and finish of an advance through a RemoteSubdomain, minus the time inside the body.
class OurExchange {
 public:
  explicit OurExchange(const std::string& endpoint)
      : hub_(limits_),
        peer_(hub_.add_peer("body")),
        liveness_(hub_, peer_, nullptr, "", limits_, Deadlines{}),
        caller_("body", CallContext{hub_.channel(peer_), liveness_, nullptr, limits_, Deadlines{}}),
        body_(caller_) {
    hub_.bind(endpoint);
    std::optional<Bytes> frame;
    while (!(frame = hub_.channel(peer_).receive(Milliseconds(100)))) {
    }
    v1::Reply hello;
    Bytes bulk;
    if (!parse_into(hello, *open_frame(*frame), bulk)) std::abort();
    caller_.accept_session(hello.session());
    body_.start_configure(Specification{});
    body_.finish_configure();
  }
  /// Sizes of the two frames.
  std::pair<std::size_t, std::size_t> prepare(int substeps) {
    advance_.window = TimeWindow{0, 0.0, 1.0e-7 * substeps};
    advance_.boundary.resize(1);
    advance_.boundary[0].forces = {wave(substeps)};
    Waveform& force = advance_.boundary[0].forces[0];
    for (std::vector<double>* field : {&force.u, &force.v, &force.a})
      field->clear();  // one field there, four back: as two bars do it
    return sizes();
  }
  /// The motion of an obstacle there, the reaction back.
  std::pair<std::size_t, std::size_t> prepare_surface(int points) {
    body_.meet({0, 0, &body_.describe().ports[0].geometry});
    advance_.window = TimeWindow{0, 0.0, 1.0e-7};
    advance_.want = {Want{false, false, false, false, {}}};
    advance_.boundary.resize(1);
    advance_.boundary[0].obstacles = {Obstacle{wave_of_surface(points, &Waveform::u), {}}};
    return sizes();
  }
  double once() {
    const Clock::time_point begin = Clock::now();
    body_.save();
    const Outcome outcome = body_.advance(advance_, response_);
    const double wall = microseconds(Clock::now() - begin);
    if (!std::holds_alternative<Advanced>(outcome)) std::abort();
    return wall - 1.0e6 * response_.compute_seconds;
  }

 private:
  std::pair<std::size_t, std::size_t> sizes() {
    once();
    Frame request, reply;
    encode(advance_, request.open());
    request.seal();
    encode(response_, advance_, reply.open());
    reply.seal();
    constexpr std::size_t envelope = 20;  // number, session, the length inside
    return {request.bytes().size() + envelope, reply.bytes().size() + envelope};
  }

  Limits limits_;
  ZmqHub hub_;
  int peer_;
  BodyLiveness liveness_;
  Caller caller_;
  RemoteSubdomain body_;
  Advance advance_;
  Response response_;
};

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
  const pid_t solver = start_process(solver_process<1>, ours_at);
  const pid_t small = start_process(solver_process<10'000>, small_at);
  const pid_t large = start_process(solver_process<100'000>, large_at);
  const pid_t echo = start_process(echo_process, bare_at);
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
  for (const pid_t id : {solver, small, large, echo}) {
    kill(id, SIGKILL);
    waitpid(id, nullptr, 0);
  }
  for (const char* name : {"/ours", "/small", "/large", "/bare", ""}) {
    if (std::remove((directory + name).c_str()) != 0) continue;  // libzmq removes its own
  }
  fmt::print("limit {:.1f}: {}\n", accepted_ratio, accepted ? "kept" : "EXCEEDED");
  return accepted ? 0 : 1;
}
