#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Recoil) == 2 * sizeof(double));
static_assert(sizeof(Reaction) ==
              sizeof(Waveform) + sizeof(double) + sizeof(std::vector<std::int32_t>));
static_assert(sizeof(PortResponse) == 2 * sizeof(Waveform) + 5 * sizeof(std::vector<double>) +
                                          3 * sizeof(double) + sizeof(std::optional<Recoil>));

using WireResponse = v1::PortResponse;

const Want everything;
const Want places{.v = false, .a = false, .f = false, .points = {}};

/// What is wanted of a port's trace.
const Want& wanted(const Advance& asked, std::size_t port) {
  return asked.want.empty() ? everything : asked.want[port];
}

void encode(const PortResponse& from, const Want& want, WireWriter& to) {
  to.numbers(WireResponse::kFastestFieldNumber, from.fastest);
  to.numbers(WireResponse::kSlowestFieldNumber, from.slowest);
  if (!from.ahead.empty()) encode(from.ahead, places, WireResponse::kAheadFieldNumber, to);
  std::size_t reactions = from.reactions.size();
  while (reactions > 0 && from.reactions[reactions - 1].force.empty()) --reactions;
  while (reactions-- > 0) {
    const std::size_t before = to.size();
    const Waveform& force = from.reactions[reactions].force;
    if (!force.empty()) {
      to.integers(v1::Reaction::kSlidFieldNumber, from.reactions[reactions].slid);
      to.number(v1::Reaction::kDissipatedFieldNumber, from.reactions[reactions].dissipated);
      encode(force, Want{}, v1::Reaction::kForceFieldNumber, to);
    }
    to.close(WireResponse::kReactionsFieldNumber, before);
  }
  to.number(WireResponse::kWorkFieldNumber, from.work);
  if (from.recoil) {
    const std::size_t before = to.size();
    to.number(v1::Recoil::kMobilityFieldNumber, from.recoil->mobility);
    to.number(v1::Recoil::kVelocityFieldNumber, from.recoil->velocity);
    to.close(WireResponse::kRecoilFieldNumber, before);
  }
  to.number(WireResponse::kAccelerationBoundFieldNumber, from.acceleration_bound);
  to.number(WireResponse::kSpeedBoundFieldNumber, from.speed_bound);
  to.numbers(WireResponse::kUpperFieldNumber, from.upper);
  to.numbers(WireResponse::kLowerFieldNumber, from.lower);
  if (!from.trace.empty()) encode(from.trace, want, WireResponse::kTraceFieldNumber, to);
}

/// A body tells of the whole window and of nothing else.
void check_span(const Waveform& wave, const TimeWindow& window, const FieldPath& path) {
  if (wave.time.front() == window.begin && wave.time.back() == window.end) return;
  FieldPath{&path, "time"}.fail(fmt::format("is from {} to {} s in a window from {} to {} s",
                                            wave.time.front(), wave.time.back(), window.begin,
                                            window.end));
}

void decode_trace(Bytes from, const Port& port, const Advance& asked, const Want& want,
                  const FieldPath& path, Waveform& to) {
  decode(from, size_of(port.geometry), path, to);
  if (to.empty()) path.fail("is present but empty");
  if (to.points != want.points) FieldPath{&path, "points"}.fail("is not the list that was wanted");
  check_span(to, asked.window, path);
  if (want.u) require_field(to, to.u, "u", path);
  if (want.v) require_field(to, to.v, "v", path);
  if (want.a) require_field(to, to.a, "a", path);
  if (want.f) require_field(to, to.f, "f", path);
}

/// What a body saw when it looked on after the window.
void decode_ahead(Bytes from, const Port& port, const Advance& asked, const FieldPath& path,
                  Waveform& to) {
  decode(from, size_of(port.geometry), path, to);
  if (to.empty()) path.fail("is present but empty");
  if (asked.ahead <= 0.0) path.fail("was not asked for");
  if (!to.points.empty()) FieldPath{&path, "points"}.fail("is not of all points");
  check_span(to, {0, asked.window.end, asked.window.end + asked.ahead}, path);
  require_field(to, to.u, "u", path);
}

/// The force inside a reaction; empty: absent. Reads the rest of it.
Bytes force_of(Bytes bytes, const FieldPath& path, Reaction& to) {
  Bytes force;
  to.dissipated = 0.0;
  to.slid.clear();
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case v1::Reaction::kForceFieldNumber:
        force = from.message();
        break;
      case v1::Reaction::kDissipatedFieldNumber:
        to.dissipated = number(from.number(), FieldPath{&path, "dissipated"});
        break;
      case v1::Reaction::kSlidFieldNumber:
        from.integers(to.slid);
        break;
      default:
        from.skip();
    }
  }
  return force;
}

/// The reaction to one obstacle of the request: on the points that it listed; where it is of all,
/// on those that the reply lists.
void decode_reaction(Bytes bytes, const Waveform& motion, int dim, const TimeWindow& window,
                     const FieldPath& parent, Reaction& reaction) {
  Waveform& to = reaction.force;
  const Bytes from = force_of(bytes, parent, reaction);
  if (from.empty()) return to.clear();  // absent
  const FieldPath path{&parent, "force"};
  if (motion.empty()) path.fail("answers an obstacle that is absent");
  // Points of a list are those of the list, which it is held against below.
  const int most = motion.points.empty() ? motion.width / dim : motion.points.back() + 1;
  decode(from, SurfaceSize{most, dim}, path, to);
  if (to.empty()) path.fail("is present but empty");
  if (!motion.points.empty() && to.points != motion.points)
    FieldPath{&path, "points"}.fail("is not that of the obstacle");
  require_field(to, to.f, "f", path);
  check_span(to, window, path);
}

/// Points that slid are of the port, at the end of a substep but the last.
void check_slid(const Response& reply, const Description& body, int steps, const FieldPath& path) {
  for (std::size_t p = 0; p < reply.ports.size(); ++p) {
    const FieldPath port{&path, "ports", static_cast<int>(p)};
    const std::int64_t most = std::int64_t{std::max(0, steps - 1)} * body.ports[p].geometry.count();
    for (std::size_t k = 0; k < reply.ports[p].reactions.size(); ++k) {
      const FieldPath reaction{&port, "reactions", static_cast<int>(k)};
      check_slid(reply.ports[p].reactions[k].slid, most, FieldPath{&reaction, "slid"});
    }
  }
}

/// Each obstacle of the request has its reaction.
void require_reactions(const BoundaryData& asked, const FieldPath& path,
                       const std::vector<Reaction>& reactions) {
  for (std::size_t i = 0; i < asked.obstacles.size(); ++i) {
    if (asked.obstacles[i].empty() || !reactions[i].force.empty()) continue;
    const FieldPath reaction{&path, "reactions", static_cast<int>(i)};
    FieldPath{&reaction, "force"}.fail("is missing");
  }
}

Recoil decode_recoil(Bytes bytes, const FieldPath& path) {
  Recoil to;
  for (WireReader from(bytes, path); from.next();) {
    if (from.field() == v1::Recoil::kVelocityFieldNumber) {
      to.velocity = number(from.number(), path);
    } else if (from.field() == v1::Recoil::kMobilityFieldNumber) {
      to.mobility = number(from.number(), path, Allow::not_negative);
    } else {
      from.skip();
    }
  }
  return to;
}

/// Forgets all but the waveforms, which are overwritten where they are.
void clear(PortResponse& port, std::size_t obstacles) {
  if (port.reactions.size() < obstacles) port.reactions.resize(obstacles);
  port.lower.clear();
  port.upper.clear();
  port.slowest.clear();
  port.fastest.clear();
  port.speed_bound = port.acceleration_bound = port.work = 0.0;
  port.ahead.width = 1;  // of a waveform that is not told
  port.recoil.reset();
}

void decode_port_response(Bytes bytes, const Port& port, std::size_t place, const Advance& asked,
                          const FieldPath& path, PortResponse& to) {
  const std::vector<Obstacle>& obstacles = asked.boundary[place].obstacles;
  clear(to, obstacles.size());
  std::size_t reactions = 0;
  bool traced = false, looked = false;
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case WireResponse::kAheadFieldNumber:
        decode_ahead(from.message(), port, asked, FieldPath{&path, "ahead"}, to.ahead);
        looked = true;
        break;
      case WireResponse::kTraceFieldNumber:
        decode_trace(from.message(), port, asked, wanted(asked, place), FieldPath{&path, "trace"},
                     to.trace);
        traced = true;
        break;
      case WireResponse::kReactionsFieldNumber:
        if (reactions >= obstacles.size()) {
          FieldPath{&path, "reactions"}.fail(
              fmt::format("has more entries than the {} obstacles", obstacles.size()));
        }
        decode_reaction(from.message(), obstacles[reactions].motion, port.geometry.dim,
                        asked.window, FieldPath{&path, "reactions", static_cast<int>(reactions)},
                        to.reactions[reactions]);
        ++reactions;
        break;
      case WireResponse::kLowerFieldNumber:
        from.numbers(to.lower);
        break;
      case WireResponse::kUpperFieldNumber:
        from.numbers(to.upper);
        break;
      case WireResponse::kSlowestFieldNumber:
        from.numbers(to.slowest);
        break;
      case WireResponse::kFastestFieldNumber:
        from.numbers(to.fastest);
        break;
      case WireResponse::kSpeedBoundFieldNumber:
        to.speed_bound = number(from.number(), FieldPath{&path, "speed_bound"}, Allow::infinite);
        break;
      case WireResponse::kAccelerationBoundFieldNumber:
        to.acceleration_bound =
            number(from.number(), FieldPath{&path, "acceleration_bound"}, Allow::infinite);
        break;
      case WireResponse::kRecoilFieldNumber:
        to.recoil = decode_recoil(from.message(), FieldPath{&path, "recoil"});
        break;
      case WireResponse::kWorkFieldNumber:
        to.work = number(from.number(), FieldPath{&path, "work"});
        break;
      default:
        from.skip();
    }
  }
  if (!traced) to.trace.clear();
  if (!looked) to.ahead.clear();
  for (; reactions < to.reactions.size(); ++reactions) {
    to.reactions[reactions].force.clear();
    to.reactions[reactions].slid.clear();
  }
  require_reactions(asked.boundary[place], path, to.reactions);
  check(to.lower, index(asked.records * port.geometry.dim), true, FieldPath{&path, "lower"});
  check(to.upper, to.lower.size(), false, FieldPath{&path, "upper"});
  check(to.slowest, index(port.geometry.dim), true, FieldPath{&path, "slowest"});
  check(to.fastest, to.slowest.size(), false, FieldPath{&path, "fastest"});
}

}  // namespace

void encode(const Response& from, const Advance& asked, WireWriter& to) {
  to.numbers(v1::Advanced::kUnbalancedFieldNumber, from.unbalanced);
  to.number(v1::Advanced::kComputeSecondsFieldNumber, from.compute_seconds);
  to.integer(v1::Advanced::kStepsFieldNumber, from.steps, Zero::told);
  for (std::size_t i = from.records.size(); i-- > 0;) {
    const std::size_t before = to.size();
    encode(from.records[i], to);
    to.close(v1::Advanced::kRecordsFieldNumber, before);
  }
  for (std::size_t i = from.ports.size(); i-- > 0;) {
    const std::size_t before = to.size();
    encode(from.ports[i], wanted(asked, i), to);
    to.close(v1::Advanced::kPortsFieldNumber, before);
  }
}

void decode(Bytes bytes, const Description& body, const Advance& asked, Response& to) {
  const FieldPath path{nullptr, "advanced"};
  const FieldPath all_ports{&path, "ports"}, all_records{&path, "records"};
  to.ports.resize(body.ports.size());
  to.records.resize(index(asked.records));
  to.compute_seconds = 0.0;
  to.unbalanced.clear();
  std::size_t ports = 0, records = 0;
  std::int64_t steps = -1;
  for (WireReader from(bytes, path); from.next();) {
    switch (from.field()) {
      case v1::Advanced::kPortsFieldNumber:
        if (ports >= to.ports.size()) {
          all_ports.fail(fmt::format("has more entries than the body's {} ports", ports));
        }
        decode_port_response(from.message(), body.ports[ports], ports, asked,
                             FieldPath{&path, "ports", static_cast<int>(ports)}, to.ports[ports]);
        ++ports;
        break;
      case v1::Advanced::kRecordsFieldNumber:
        if (records >= to.records.size()) {
          all_records.fail(fmt::format("has more entries than the {} asked for", records));
        }
        decode(from.message(), body, FieldPath{&path, "records", static_cast<int>(records)},
               to.records[records]);
        ++records;
        break;
      case v1::Advanced::kStepsFieldNumber:
        steps = from.integer();
        if (steps < 0 || steps > std::numeric_limits<int>::max()) {
          FieldPath{&path, "steps"}.fail(fmt::format("is {}", steps));
        }
        break;
      case v1::Advanced::kComputeSecondsFieldNumber:
        to.compute_seconds = number(from.number(), FieldPath{&path, "compute_seconds"});
        break;
      case v1::Advanced::kUnbalancedFieldNumber:
        from.numbers(to.unbalanced);
        break;
      default:
        from.skip();
    }
  }
  if (steps < 0) FieldPath{&path, "steps"}.fail("is missing");
  require_count(ports, body.ports.size(), "ports", all_ports);
  require_count(records, to.records.size(), "records that were asked for", all_records);
  to.steps = static_cast<int>(steps);
  check_slid(to, body, to.steps, path);
  check(to.unbalanced, index(steps) * index(loose_motions(body)), false,
        FieldPath{&path, "unbalanced"});
}

}  // namespace abut
