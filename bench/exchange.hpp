#pragma once

#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/instant_body.hpp"
#include "messaging/codec.hpp"
#include "messaging/codec/wire.hpp"
#include "messaging/frame.hpp"
#include "messaging/key_files.hpp"
#include "messaging/linked_bodies.hpp"
#include "messaging/liveness.hpp"
#include "messaging/remote_subdomain.hpp"
#include "messaging/serve.hpp"
#include "messaging/zmq_channel.hpp"
#include "messaging/zmq_dealer.hpp"

// An exchange with a body in another process that answers at once: what is left is its overhead.
namespace abut::bench {

inline double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

inline double quantile(std::vector<double> values, double part) {
  const std::size_t at = static_cast<std::size_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// The solver's process: our own server, as abut-solver runs it. `memory`: the descriptor of what
/// it shares with the coordinator; below 0: nothing.
[[noreturn]] inline void solve(const std::string& endpoint, int points, const Access& access = {},
                               int memory = -1) {
  const Limits limits;
  const Deadlines deadlines;
  ZmqDealer dealer(endpoint, "body", limits, 1, access);
  const auto linked = LinkedBodies::join(memory, {&dealer}, limits);
  CoordinatorLiveness coordinator(dealer, endpoint, deadlines, linked.get());
  const MakeBody make = [points](const Specification&, const ProgressHook&) {
    return std::unique_ptr<Subdomain>(std::make_unique<InstantBody>(points));
  };
  Channel& channel = linked ? linked->channel(0) : dealer;
  Server server("body", make, channel, coordinator, limits, deadlines);
  try {
    serve(server, Milliseconds(10'000));
  } catch (const CoordinatorLost&) {  // it has measured what it wanted
  }
  std::_Exit(0);
}

/// Where the kernel puts threads makes a factor of two. Both kinds of exchange get the same places:
/// the near end with its I/O threads on one core, the far ends on another, where there are two.
inline void stay_on_core(std::size_t core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  if (sysconf(_SC_NPROCESSORS_ONLN) > 1) sched_setaffinity(0, sizeof cores, &cores);
}

inline pid_t start_process(const std::function<void()>& run) {
  const pid_t id = fork();
  if (id != 0) return id;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  stay_on_core(1);
  run();
  std::_Exit(1);
}

/// Of processes that start_process has begun.
inline void end_process(pid_t id) {
  kill(id, SIGKILL);
  waitpid(id, nullptr, 0);
}

/// Ours: start and finish of an advance through a RemoteSubdomain, minus the time inside the body.
class OurExchange {
 public:
  /// By sockets, with a solver that is there. `keys`: the folder of both ends; empty: they have
  /// none.
  explicit OurExchange(const std::string& endpoint, const std::string& keys = "")
      : OurExchange(Way::sockets, {}) {
    if (keys.empty()) {
      hub_.bind(endpoint);
    } else {
      hub_.bind(endpoint, read_coordinator_keys(keys, std::vector<std::string>{"body"}));
    }
    greet();
  }
  /// Through memory, with a solver of its own.
  OurExchange(const std::string& endpoint, int points, std::chrono::microseconds spin)
      : OurExchange(Way::memory, spin) {
    hub_.bind(endpoint);
    const int memory = linked_->descriptor();
    solver_ = start_process([&] { solve(endpoint, points, {}, memory); });
    greet();
  }
  ~OurExchange() {
    if (solver_ > 0) end_process(solver_);
  }
  OurExchange(const OurExchange&) = delete;
  OurExchange& operator=(const OurExchange&) = delete;

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
  enum class Way { sockets, memory };
  OurExchange(Way way, std::chrono::microseconds spin)
      : hub_(limits_),
        peer_(hub_.add_peer("body")),
        linked_(way == Way::memory ? LinkedBodies::make({&hub_.channel(peer_)}, limits_, spin)
                                   : nullptr),
        liveness_(hub_, peer_, nullptr, "", limits_, Deadlines{}, linked_.get()),
        caller_("body", CallContext{linked_ ? linked_->channel(0) : hub_.channel(peer_), liveness_,
                                    nullptr, limits_, Deadlines{}}),
        body_(caller_) {}
  void greet() {
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
  std::unique_ptr<LinkedBodies> linked_;  // null: by sockets
  pid_t solver_ = -1;                     // of its own
  BodyLiveness liveness_;
  Caller caller_;
  RemoteSubdomain body_;
  Advance advance_;
  Response response_;
};

}  // namespace abut::bench
