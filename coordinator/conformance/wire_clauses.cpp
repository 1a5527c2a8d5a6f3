// What a solver must do on the wire, whatever its body is (proto/README.md, Rules).

#include "coordinator/conformance/wire_clauses.hpp"

#include <fmt/format.h>
#include <google/protobuf/unknown_field_set.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "base/printable.hpp"

namespace abut {

namespace {

using Solver = WireTrial::Solver;
using Pushed = WireTrial::Pushed;

constexpr Milliseconds silence{400};        // that a frame which counts for nothing is given
constexpr Milliseconds time_to_end{3'000};  // of a process that is told to
constexpr Milliseconds time_to_miss{20'000};
constexpr int unknown_field = 1000;  // of the schema: no request of this version

void require_silence(WireTrial& wire, const std::string& what, const std::string& look) {
  if (wire.reply(silence)) throw BrokenClause("answers " + what, look);
}

void require_fault(WireTrial& wire, const v1::Request& request, const std::string& what) {
  const v1::Reply reply = wire.call(request, what);
  if (!reply.has_fault())
    throw BrokenClause(fmt::format("takes {} as if that were sound", what),
                       "What a body does not take, or is not sound, is a Fault that says so.");
  if (reply.fault().what().empty())
    throw BrokenClause(fmt::format("answers {} by a Fault without words", what),
                       "`what`, `where` and `remedy` are printed as they are.");
}

void require_pong(WireTrial& wire, const std::string& after) {
  v1::Request ping = wire.next();
  ping.mutable_ping();
  if (!wire.call(ping, "Ping after " + after).has_pong())
    throw BrokenClause("answers no Ping after " + after, "A solver serves on.");
}

std::uint64_t hash_of(WireTrial& wire) {
  v1::Request request = wire.next();
  request.mutable_hash();
  return wire.call(request, "Hash").hash().hash();
}

std::string greeting(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  const v1::Hello& hello = wire.hello();
  const char* look = "proto/README.md, A run: the first frame of a solver is its Hello.";
  if (hello.protocol() != protocol_version)
    throw BrokenClause(
        fmt::format("speaks protocol {}, not {}", hello.protocol(), protocol_version), look);
  if (hello.body() != solver.body)
    throw BrokenClause("says Hello as " + printable(hello.body(), 100), look);
  if (hello.session() == 0) throw BrokenClause("its Hello has no session", look);
  if (hello.last_request() != 0)
    throw BrokenClause("a new process has executed requests already", look);
  const WireTrial second(solver);
  if (second.hello().session() == hello.session())
    throw BrokenClause("two processes have the same session",
                       "A session is drawn by chance when a process starts.");
  wire.configure();
  return "";
}

std::string damage(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  wire.configure();
  v1::Request ping = wire.next();
  ping.mutable_ping();
  std::vector<std::byte> frame = WireTrial::frame_of(ping);
  frame.back() ^= std::byte{1};
  wire.send(frame);
  const char* look = "A frame that fails the checksum counts as lost; the request comes again.";
  require_silence(wire, "a damaged frame", look);
  if (!wire.call(ping, "a request that was damaged first").has_pong())
    throw BrokenClause("answers a request that was damaged first otherwise", look);
  return "";
}

std::string session(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  wire.configure();
  v1::Request ping = wire.next();
  ping.mutable_ping();
  v1::Request foreign = ping;
  foreign.set_session(ping.session() ^ 2U);
  wire.send(foreign);
  const char* look = "What carries another session is for a process that had this name before.";
  require_silence(wire, "a request of another session", look);
  if (!wire.call(ping, "a request, after one of another session").has_pong())
    throw BrokenClause("answers otherwise after a request of another session", look);
  return "";
}

std::string repeats(const Solver& solver, const Pushed& pushed) {
  WireTrial wire(solver);
  wire.configure();
  const v1::Request request = wire.advance(pushed);
  wire.call(request, "Advance");
  const std::vector<std::byte> once = wire.payload();
  const char* look = "A number is executed once; the last reply is kept, and sent again.";
  wire.call(request, "a repeated Advance");
  if (wire.payload() != once) throw BrokenClause("answers a repeated request by other bytes", look);
  const std::uint64_t hash = hash_of(wire);
  wire.send(request);
  require_silence(wire, "a request that is older than the last one",
                  "It was answered long ago, and its answer is kept no more.");
  if (hash_of(wire) != hash) throw BrokenClause("an old request changes the state", look);
  return "";
}

std::string gaps(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  wire.configure();
  wire.next();
  v1::Request ping = wire.next();
  ping.mutable_ping();
  require_fault(wire, ping, "a request whose number leaves one out");
  return "";
}

/// Save and restore ride on requests; a state is returned to over the wire as it is in place.
std::string riding(const Solver& solver, const Pushed& pushed) {
  WireTrial wire(solver);
  wire.configure();
  v1::Request request = wire.advance(pushed);
  request.set_restore_first(true);
  require_fault(wire, request, "restore_first before any save_first");
  request = wire.advance(pushed);
  request.set_save_first(true);
  wire.call(request, "Advance with save_first");
  const std::uint64_t first = hash_of(wire);
  request = wire.advance(pushed);
  request.set_restore_first(true);
  request.set_save_first(true);  // restores, then saves what it has restored
  wire.call(request, "Advance with restore_first and save_first");
  const std::uint64_t second = hash_of(wire);
  request = wire.advance(pushed);
  request.set_restore_first(true);
  wire.call(request, "Advance with restore_first");
  if (second != first || hash_of(wire) != first)
    throw BrokenClause("a window that is restored and repeated ends in another state",
                       "A request restores first, then saves, then is executed.");
  return "";
}

std::string unknown(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  v1::Request early = wire.next();
  early.mutable_hash();
  require_fault(wire, early, "Hash before Configure");
  wire.configure();
  require_fault(wire, wire.next(), "a request that is empty");
  v1::Request later = wire.next();
  later.GetReflection()->MutableUnknownFields(&later)->AddLengthDelimited(unknown_field,
                                                                          "of a later version");
  require_fault(wire, later, "a request that it does not know");
  require_pong(wire, "requests that it does not know");
  return "";
}

/// Parts that the description says no to, each with the name of what it is.
std::vector<std::pair<const char*, v1::Request>> not_taken(WireTrial& wire, const Description& body,
                                                           const Pushed& pushed) {
  std::vector<std::pair<const char*, v1::Request>> all;
  const Pushed free{pushed.begin, pushed.step, pushed.steps, 0, 0.0};
  const auto with = [&](const char* what, const auto& change) {
    v1::Request request = wire.advance(free);
    change(*request.mutable_advance()->mutable_boundary(0), body.ports[0].geometry);
    all.emplace_back(what, std::move(request));
  };
  const auto fill = [&free](v1::Waveform& wave, std::size_t width, auto&& values) {
    wave.set_width(static_cast<int>(width));
    wave.set_support(v1::FORCE_SUPPORT_STEP);
    wave.add_time(free.begin);
    wave.add_time(free.begin + free.steps * free.step);
    for (std::size_t k = 0; k < 2 * width; ++k) values(wave);
  };
  const auto zeros = [](v1::Waveform& wave) { wave.add_u(0.0), wave.add_v(0.0), wave.add_a(0.0); };
  const auto forces = [](v1::Waveform& wave) { wave.add_f(0.0); };
  if (!body.can.motion)
    with("motion, which its description does not take", [&](auto& to, const PortGeometry& port) {
      fill(*to.mutable_motion(), port.points.size(), zeros);
    });
  if (!body.can.force)
    with("a force, which its description does not take", [&](auto& to, const PortGeometry& port) {
      fill(*to.add_forces(), port.points.size(), forces);
    });
  if (!body.can.impulse)
    with("an impulse, which its description does not take", [](auto& to, const PortGeometry& port) {
      for (std::size_t k = 0; k < port.points.size(); ++k) to.add_impulse(1.0e-9);
    });
  if (!body.can.impedance)
    with("an impedance, which its description does not take",
         [](auto& to, const PortGeometry&) { to.mutable_impedance()->set_value(1.0e-9); });
  with("an obstacle of a partner that it never met", [&](auto& to, const PortGeometry& port) {
    fill(*to.add_obstacles()->mutable_motion(), port.points.size(), zeros);
  });
  if (!body.can.force) return all;
  with("a force of other than its points", [&](auto& to, const PortGeometry& port) {
    fill(*to.add_forces(), port.points.size() + 1, forces);
  });
  with("a force that is no number", [&](auto& to, const PortGeometry& port) {
    fill(*to.add_forces(), port.points.size(),
         [](v1::Waveform& wave) { wave.add_f(std::numeric_limits<double>::quiet_NaN()); });
  });
  return all;
}

std::string refusals(const Solver& solver, const Pushed& pushed) {
  WireTrial wire(solver);
  const Description body = wire.configure();
  if (body.ports.empty()) return "the body has no ports";
  const std::uint64_t hash = hash_of(wire);
  for (const auto& [what, request] : not_taken(wire, body, pushed))
    require_fault(wire, request, what);
  v1::Request backwards = wire.advance(pushed);
  backwards.mutable_advance()->mutable_window()->set_end(pushed.begin - pushed.step);
  require_fault(wire, backwards, "a window that ends before it begins");
  v1::Request half = wire.advance(pushed);
  half.mutable_advance()->clear_boundary();
  require_fault(wire, half, "an Advance without entries for its ports");
  if (hash_of(wire) != hash)
    throw BrokenClause("what it refuses changes its state", "A refused request does nothing.");
  require_pong(wire, "what it refuses");
  return "";
}

/// A long window: signs of progress come meanwhile.
std::string alive(const Solver& solver, const Pushed& pushed) {
  constexpr double wanted = 1.6, enough = 1.0;  // [s]
  constexpr int most_steps = 3'000'000;
  WireTrial wire(solver);
  wire.configure();
  Pushed longer{pushed.begin, pushed.step, 20, 0, 0.0};
  for (int attempt = 0; attempt < 6; ++attempt) {
    const int before = wire.signs();
    const TimePoint begin = std::chrono::steady_clock::now();
    const v1::Reply reply = wire.call(wire.advance(longer), "Advance");
    if (!reply.has_advanced()) return "no long window ends well";
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    if (wire.signs() > before) return "";
    if (taken.count() > enough)
      throw BrokenClause(
          fmt::format("gives no sign of progress in a window that takes {:.2g} s", taken.count()),
          "A request that takes longer than network.request_deadline needs Progress in between.");
    longer.begin += longer.steps * longer.step;
    if (longer.steps == most_steps) break;
    const double more = std::clamp(wanted / std::max(1.0e-3, taken.count()), 2.0, 100.0);
    longer.steps = static_cast<int>(std::min<double>(most_steps, std::ceil(longer.steps * more)));
  }
  return "no window takes long";
}

void require_end(WireTrial& wire, bool well, Milliseconds wait, const std::string& what,
                 const std::string& look) {
  if (!wire.process().ended(wait))
    throw BrokenClause(
        fmt::format("runs on {} s after {}", static_cast<double>(wait.count()) / 1000.0, what),
        look);
  if (wire.process().exited_with(0) != well)
    throw BrokenClause(fmt::format("{} after {}", wire.process().ending(), what), look);
}

std::string finish(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  wire.configure();
  v1::Request request = wire.next();
  request.mutable_finish();
  const char* look = "Finish is answered by Finished, and the process ends with exit code 0.";
  if (!wire.call(request, "Finish").has_finished())
    throw BrokenClause("answers Finish otherwise than by Finished", look);
  require_end(wire, true, time_to_end, "Finish", look);
  return "";
}

std::string refused(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  v1::Request refuse;
  refuse.set_session(wire.hello().session());
  refuse.mutable_refuse()->set_reason("this is a trial of conformance");
  wire.send(refuse);
  require_end(wire, false, time_to_end, "it is refused",
              "A solver that is refused says why on standard error, and ends with exit code 3 or "
              "another one above 0.");
  return "";
}

std::string lost(const Solver& solver, const Pushed&) {
  WireTrial wire(solver);
  wire.configure();
  wire.vanish();
  require_end(wire, false, time_to_miss, "its coordinator is gone",
              "Whose local connection ends leaves by itself; nothing is left behind.");
  return "";
}

struct WireClause {
  const char* name;
  const char* says;
  std::string (*hold)(const Solver& solver, const Pushed& pushed);
};

constexpr WireClause clauses_on_wire[] = {
    {"greeting", "a new process says Hello, with a session of its own", greeting},
    {"damage", "a damaged frame counts as lost", damage},
    {"session", "requests of another session are nobody's", session},
    {"repeats", "a repeated request has the same reply, and is executed once", repeats},
    {"gaps", "a request that leaves a number out is a Fault", gaps},
    {"riding", "a request restores, saves, and is executed, in this order", riding},
    {"unknown", "an unknown request, or one before Configure, is a Fault", unknown},
    {"refusals", "what the body does not take, or is not sound, is a Fault", refusals},
    {"alive", "a long window shows signs of progress", alive},
    {"finish", "Finish ends the process with exit code 0", finish},
    {"refused", "a solver that is refused ends", refused},
    {"lost", "a solver whose coordinator is gone ends", lost},
};

}  // namespace

std::vector<std::string> names_of_wire_clauses() {
  std::vector<std::string> names;
  for (const WireClause& clause : clauses_on_wire) names.emplace_back(clause.name);
  return names;
}

void hold_wire(const Solver& solver, const Pushed& pushed, const Wanted& wanted,
               std::vector<Verdict>& verdicts) {
  for (const WireClause& clause : clauses_on_wire)
    if (wants(wanted, clause.name))
      verdicts.push_back(
          judged(clause.name, clause.says, [&] { return clause.hold(solver, pushed); }));
}

}  // namespace abut
