#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Recoil) == 2 * sizeof(double));
static_assert(sizeof(Reaction) == sizeof(Waveform));
static_assert(sizeof(PortResponse) == sizeof(Waveform) + 3 * sizeof(std::vector<double>) +
                                          3 * sizeof(double) + sizeof(std::optional<Recoil>));

const Want everything;

/// What is wanted of a port's trace.
const Want& wanted(const Advance& asked, std::size_t port) {
  return asked.want.empty() ? everything : asked.want[port];
}

/// A trace without the fields that nobody wants.
void encode_trace(const Waveform& from, const Want& want, v1::Waveform& to) {
  to.set_width(from.width);
  to.set_support(encode(from.support));
  copy(from.points, *to.mutable_points());
  copy(from.time, *to.mutable_time());
  const auto choose = [](bool chosen, const std::vector<double>& values,
                         google::protobuf::RepeatedField<double>& wire) {
    if (chosen) {
      copy(values, wire);
    } else {
      wire.Clear();
    }
  };
  choose(want.u, from.u, *to.mutable_u());
  choose(want.v, from.v, *to.mutable_v());
  choose(want.a, from.a, *to.mutable_a());
  choose(want.f, from.f, *to.mutable_f());
}

void encode(const PortResponse& from, const Want& want, v1::PortResponse& to) {
  if (from.trace.empty()) {
    to.clear_trace();
  } else {
    encode_trace(from.trace, want, *to.mutable_trace());
  }
  resize(*to.mutable_reactions(), from.reactions.size());
  for (int i = 0; i < to.reactions_size(); ++i) {
    const Waveform& force = from.reactions[index(i)].force;
    if (force.empty()) {
      to.mutable_reactions(i)->clear_force();
    } else {
      encode(force, *to.mutable_reactions(i)->mutable_force());
    }
  }
  copy(from.lower, *to.mutable_lower());
  copy(from.upper, *to.mutable_upper());
  to.set_speed_bound(from.speed_bound);
  to.set_acceleration_bound(from.acceleration_bound);
  to.set_work(from.work);
  to.clear_recoil();
  if (!from.recoil) return;
  to.mutable_recoil()->set_velocity(from.recoil->velocity);
  to.mutable_recoil()->set_mobility(from.recoil->mobility);
}

/// A body tells of the whole window and of nothing else.
void check_span(const Waveform& wave, const TimeWindow& window, const FieldPath& path) {
  if (wave.time.front() == window.begin && wave.time.back() == window.end) return;
  FieldPath{&path, "time"}.fail(fmt::format("is from {} to {} s in a window from {} to {} s",
                                            wave.time.front(), wave.time.back(), window.begin,
                                            window.end));
}

void decode_trace(const v1::PortResponse& from, const Port& port, const Advance& asked,
                  const Want& want, const FieldPath& path, Waveform& to) {
  to.clear();
  if (!from.has_trace()) return;
  decode(from.trace(), size_of(port.geometry), path, to);
  if (to.empty()) path.fail("is present but empty");
  if (to.points != want.points) FieldPath{&path, "points"}.fail("is not the list that was wanted");
  check_span(to, asked.window, path);
  if (want.u) require_field(to, to.u, "u", path);
  if (want.v) require_field(to, to.v, "v", path);
  if (want.a) require_field(to, to.a, "a", path);
  if (want.f) require_field(to, to.f, "f", path);
}

/// Each obstacle has its reaction, on the points that it listed.
void decode_reactions(const v1::PortResponse& from, const BoundaryData& asked, int dim,
                      const TimeWindow& window, const FieldPath& parent,
                      std::vector<Reaction>& to) {
  if (index(from.reactions_size()) > asked.obstacles.size()) {
    FieldPath{&parent, "reactions"}.fail(fmt::format(
        "has {} entries for {} obstacles", from.reactions_size(), asked.obstacles.size()));
  }
  for (Reaction& reaction : to) reaction.force.clear();
  if (to.size() < asked.obstacles.size()) to.resize(asked.obstacles.size());
  for (std::size_t i = 0; i < asked.obstacles.size(); ++i) {
    const int k = static_cast<int>(i);
    const FieldPath reaction{&parent, "reactions", k};
    const FieldPath path{&reaction, "force"};
    const bool there = k < from.reactions_size() && from.reactions(k).has_force();
    const Waveform& motion = asked.obstacles[i].motion;
    if (motion.empty()) {
      if (there) path.fail("answers an obstacle that is absent");
      continue;
    }
    if (!there) path.fail("is missing");
    // Its points are those of the obstacle, which the list below holds it against.
    const int most = motion.points.empty() ? motion.width / dim : motion.points.back() + 1;
    decode(from.reactions(k).force(), SurfaceSize{most, dim}, path, to[i].force);
    if (to[i].force.empty()) path.fail("is present but empty");
    if (to[i].force.points != motion.points) {
      FieldPath{&path, "points"}.fail("is not that of the obstacle");
    }
    require_field(to[i].force, to[i].force.f, "f", path);
    check_span(to[i].force, window, path);
  }
}

void decode(const v1::PortResponse& from, const Port& port, std::size_t place, const Advance& asked,
            const FieldPath& path, PortResponse& to) {
  decode_trace(from, port, asked, wanted(asked, place), FieldPath{&path, "trace"}, to.trace);
  const std::size_t dim = index(port.geometry.dim);
  decode_reactions(from, asked.boundary[place], port.geometry.dim, asked.window, path,
                   to.reactions);
  const std::size_t boxes = index(asked.records) * dim;
  take(from.lower(), boxes, true, FieldPath{&path, "lower"}, to.lower);
  take(from.upper(), to.lower.size(), false, FieldPath{&path, "upper"}, to.upper);
  to.speed_bound = number(from.speed_bound(), FieldPath{&path, "speed_bound"}, Allow::infinite);
  to.acceleration_bound =
      number(from.acceleration_bound(), FieldPath{&path, "acceleration_bound"}, Allow::infinite);
  to.work = number(from.work(), FieldPath{&path, "work"});
  to.recoil.reset();
  if (!from.has_recoil()) return;
  const FieldPath at{&path, "recoil"};
  to.recoil = Recoil{.velocity = number(from.recoil().velocity(), at),
                     .mobility = number(from.recoil().mobility(), at, Allow::not_negative)};
}

}  // namespace

void encode(const Response& from, const Advance& asked, v1::Advanced& to) {
  resize(*to.mutable_ports(), from.ports.size());
  for (std::size_t i = 0; i < from.ports.size(); ++i) {
    encode(from.ports[i], wanted(asked, i), *to.mutable_ports(static_cast<int>(i)));
  }
  resize(*to.mutable_records(), from.records.size());
  for (std::size_t i = 0; i < from.records.size(); ++i) {
    encode(from.records[i], *to.mutable_records(static_cast<int>(i)));
  }
  to.set_steps(from.steps);
  to.set_compute_seconds(from.compute_seconds);
}

void decode(const v1::Advanced& from, const Description& body, const Advance& asked, Response& to) {
  const FieldPath path{nullptr, "advanced"};
  if (!from.has_steps()) FieldPath{&path, "steps"}.fail("is missing");
  if (from.steps() < 0) FieldPath{&path, "steps"}.fail("is negative");
  require_count(from.ports_size(), body.ports.size(), "ports", FieldPath{&path, "ports"});
  to.ports.resize(body.ports.size());
  for (int p = 0; p < from.ports_size(); ++p) {
    decode(from.ports(p), body.ports[index(p)], index(p), asked, FieldPath{&path, "ports", p},
           to.ports[index(p)]);
  }
  require_count(from.records_size(), index(asked.records), "records that were asked for",
                FieldPath{&path, "records"});
  to.records.resize(index(from.records_size()));
  for (int i = 0; i < from.records_size(); ++i) {
    decode(from.records(i), body, FieldPath{&path, "records", i}, to.records[index(i)]);
  }
  to.steps = from.steps();
  to.compute_seconds = number(from.compute_seconds(), FieldPath{&path, "compute_seconds"});
}

}  // namespace abut
