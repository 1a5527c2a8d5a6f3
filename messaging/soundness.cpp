#include "messaging/soundness.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/index.hpp"
#include "base/printable.hpp"
#include "surface/check.hpp"

namespace abut {

namespace {

/// Of the squared length of a normal: what a peer's single precision leaves, about.
constexpr double unit_error = 1.0e-5;

/// Unit normals; of points without facets, which face nothing, also none. Points inside the body
/// have none of its surface.
void require_normals(const PortGeometry& surface, const FieldPath& path) {
  std::vector<double> facing(surface.points.size(), 0.0);
  if (!surface.offsets.empty()) nodal_normals(posed(surface), facing);
  const std::size_t dim = index(surface.dim);
  for (std::size_t p = 0; p < index(surface.count() - surface.embedded); ++p) {
    double square = 0.0, along = 0.0, faces = 0.0;
    for (std::size_t i = p * dim; i < (p + 1) * dim; ++i) {
      square += surface.normals[i] * surface.normals[i];
      along += surface.normals[i] * facing[i];
      faces += facing[i] * facing[i];
    }
    if (square == 0.0 && faces == 0.0 && dim > 1) continue;
    if (!(std::abs(square - 1.0) <= unit_error))
      path.fail(fmt::format("has length {:.6g} at point {}, not 1", std::sqrt(square), p));
    if (faces > 0.0 && along <= 0.0)
      path.fail(
          fmt::format("looks against the facets at point {}: nodes of a facet turn "
                      "counterclockwise for who looks at the body from outside, in the plane "
                      "the body lies to the left",
                      p));
  }
}

/// A line stands on pages and terminals.
void require_line(const std::string& line, std::size_t most_bytes, const FieldPath& path) {
  if (line.size() > most_bytes)
    path.fail(fmt::format("has {} bytes, more than {}", line.size(), most_bytes));
  if (printable(line, line.size()) != line || line.find('\n') != std::string::npos)
    path.fail("has a control character");
}

/// A name stands in the heads of tables too.
void require_name(const std::string& name, const FieldPath& path) {
  require_line(name, 200, path);
  if (name.find_first_of(",\"") != std::string::npos) path.fail("has a comma or a quote");
}

void require_names(const std::vector<std::string>& names, const FieldPath& parent,
                   const char* field) {
  for (std::size_t i = 0; i < names.size(); ++i)
    require_name(names[i], FieldPath{&parent, field, static_cast<int>(i)});
}

bool imposed(const Advance& asked, std::size_t port) {
  return port < asked.boundary.size() &&
         (asked.boundary[port].closed() || !asked.boundary[port].impulse.empty());
}

bool moves(const Want& want) { return want.u || want.v || want.a || want.f; }

void require_trace(const PortResponse& reply, const Want& want, int steps, const Advance& asked,
                   const FieldPath& path) {
  if (!moves(want)) return;
  const FieldPath trace{&path, "trace"};
  if (reply.trace.empty()) trace.fail("is missing");
  const int most = asked.sampling == Sampling::records ? asked.records : steps;
  if (reply.trace.size() > index(std::max(most, 0)) + 1)
    FieldPath{&trace, "time"}.fail(
        fmt::format("has {} times, at most {} belong", reply.trace.size(), most + 1));
}

/// Positions of points at the window's end lie in the box of its last part.
void require_box(const PortResponse& reply, const Port& port, const Advance& asked,
                 const FieldPath& path) {
  const std::size_t dim = index(port.geometry.dim), count = index(asked.records) * dim;
  if (reply.lower.size() != count) FieldPath{&path, "lower"}.fail("is missing");
  for (std::size_t k = 0; k < count; ++k)
    if (reply.lower[k] > reply.upper[k])
      FieldPath{&path, "lower"}.fail(
          fmt::format("is above upper at entry {}: {} and {}", k, reply.lower[k], reply.upper[k]));
  for (std::size_t k = 0; k < reply.slowest.size(); ++k)
    if (reply.slowest[k] > reply.fastest[k])
      FieldPath{&path, "slowest"}.fail(fmt::format("is above fastest at entry {}: {} and {}", k,
                                                   reply.slowest[k], reply.fastest[k]));
  const Waveform& trace = reply.trace;
  if (trace.empty() || trace.u.empty() || count == 0) return;
  const std::size_t width = index(trace.width), last = (trace.size() - 1) * width;
  for (std::size_t k = 0; k < width; ++k) {
    const std::size_t axis = k % dim, box = count - dim + axis;
    const std::size_t point = trace.points.empty() ? k / dim : index(trace.points[k / dim]);
    const double at = port.geometry.points[point * dim + axis] + trace.u[last + k];
    const double size = std::max(std::abs(port.geometry.points[point * dim + axis]), std::abs(at));
    const double slack = 1.0e-9 * (size + reply.upper[box] - reply.lower[box]);  // rounding of sums
    if (at < reply.lower[box] - slack || at > reply.upper[box] + slack)
      FieldPath{&path, at > reply.upper[box] ? "upper" : "lower"}.fail(
          fmt::format("leaves out point {}, which ends the window at {} along axis {}: boxes hold "
                      "positions, not displacements",
                      point, at, axis));
  }
}

/// [m/s] of the fastest point at the window's end: outward of a port of one point, else anywhere.
double speed_of(const Waveform& trace, const PortGeometry& surface) {
  if (trace.empty() || trace.v.empty()) return 0.0;
  const std::size_t dim = index(surface.dim), width = index(trace.width);
  const std::size_t last = (trace.size() - 1) * width;
  double fastest = 0.0;
  for (std::size_t p = 0; p < width; p += dim) {
    double square = 0.0, outward = 0.0;
    for (std::size_t i = 0; i < dim; ++i) {
      square += trace.v[last + p + i] * trace.v[last + p + i];
      outward += trace.v[last + p + i] * surface.normals[i];
    }
    fastest = std::max(fastest, surface.count() == 1 ? outward : std::sqrt(square));
  }
  return fastest;
}

/// Of ports that nothing touches: contact changes velocities at once.
void require_speed(const PortResponse& reply, const PortGeometry& surface, const FieldPath& path) {
  const FieldPath bound{&path, "speed_bound"};
  if (surface.count() > 1 && reply.speed_bound < 0.0)
    bound.fail(fmt::format("is negative: {}", reply.speed_bound));
  if (!(reply.acceleration_bound >= 0.0))
    FieldPath{&path, "acceleration_bound"}.fail(
        fmt::format("is negative: {}", reply.acceleration_bound));
  // Velocities of staggered schemes are those of half a step beside: a bound that is forgotten is
  // 0, one in wrong units is off by much more than 2.
  const double speed = speed_of(reply.trace, surface);
  if (speed > 0.0 && reply.speed_bound < 0.5 * speed)
    bound.fail(fmt::format("is {} m/s, but the port moves at {} m/s", reply.speed_bound, speed));
}

void require_record(const BodyRecord& record, const Description& body, double time,
                    const TimeWindow& window, const FieldPath& path) {
  const double slack = 1.0e-9 * window.length() + 1.0e-12 * std::abs(window.end);  // rounding
  if (std::abs(record.time - time) > slack)
    FieldPath{&path, "time"}.fail(fmt::format("is {} s, where {} s belongs", record.time, time));
  if (std::isinf(body.mass)) return;
  if (record.momentum.empty()) FieldPath{&path, "momentum"}.fail("is missing");
}

/// Symmetric and positive semidefinite, as far as single values and pairs tell. Rounding in bodies
/// of very unlike stiffness is far below what is let through, a wrong sign or a wrong order of
/// values far above.
void require_compliance(const std::vector<double>& compliance, std::size_t values,
                        const FieldPath& path) {
  if (compliance.size() != values * values) {  // a diagonal that bounds it
    for (std::size_t i = 0; i < values; ++i)
      if (compliance[i] < 0.0)
        path.fail(fmt::format("moves against an impulse on value {}: {}", i, compliance[i]));
    return;
  }
  constexpr double rounding = 1.0e-3;  // of the largest value
  double largest = 0.0;
  for (std::size_t i = 0; i < values; ++i)
    largest = std::max(largest, std::abs(compliance[i * values + i]));
  const double slack = rounding * largest, most = largest + slack;
  for (std::size_t i = 0; i < values; ++i) {
    const double own = compliance[i * values + i];
    if (own < -slack) path.fail(fmt::format("moves against an impulse on value {}: {}", i, own));
    for (std::size_t j = 0; j < i; ++j) {
      const double one = compliance[i * values + j], other = compliance[j * values + i];
      if (std::abs(one - other) > slack)
        path.fail(fmt::format("is not symmetric: {} of value {} by value {}, {} the other way", one,
                              i, j, other));
      if (std::abs(one) > most)
        path.fail(fmt::format("is not definite: {} of value {} by value {}, where values have {} "
                              "of their own at most",
                              one, i, j, largest));
    }
  }
}

}  // namespace

void require_sound(const PortGeometry& surface, const FieldPath& path) {
  if (surface.dim == 1) {
    if (!surface.facets.empty()) FieldPath{&path, "facets"}.fail("is not for this dimension");
  } else if (const std::optional<UnsoundSurface> unsound = check(posed(surface))) {
    FieldPath{&path, "facets"}.fail("is unsound: " + words(*unsound));
  }
  require_normals(surface, FieldPath{&path, "normals"});
  // Partners are divided as finely as a surface says its mesh is.
  constexpr double finest = 1.0e-6;
  const double longest = surface.dim > 1 ? longest_edge(posed(surface)) : 0.0;
  if (surface.spacing > 0.0 && surface.spacing < finest * longest)
    FieldPath{&path, "spacing"}.fail(
        fmt::format("is {} m, where edges of facets are {} m", surface.spacing, longest));
}

void require_sound(const Description& body) {
  const FieldPath path{nullptr, "description"};
  if (body.mass == 0.0 && !body.quasi_static)
    FieldPath{&path, "mass"}.fail("is 0; of a body that nothing moves it is infinity");
  const int most = body.dim == 2 ? 3 : 6;
  if (loose_motions(body) > most)
    FieldPath{&path, "loose"}.fail(
        fmt::format("has {} motions, a rigid body has {}", loose_motions(body), most));
  if (body.can.only_passive && !body.can.passive)
    FieldPath{&path, "can.only_passive"}.fail("is told of a body without a passive form");
  require_line(body.model, 1000, FieldPath{&path, "model"});
  require_names(body.measures, path, "measures");
  require_names(body.columns, path, "columns");
  for (std::size_t i = 0; i < body.fields.size(); ++i)
    require_name(body.fields[i].name, FieldPath{&path, "fields", static_cast<int>(i)});
  for (std::size_t i = 0; i < body.members.size(); ++i)
    require_name(body.members[i].name, FieldPath{&path, "members", static_cast<int>(i)});
  for (std::size_t p = 0; p < body.ports.size(); ++p) {
    const FieldPath port{&path, "ports", static_cast<int>(p)};
    require_name(body.ports[p].name, FieldPath{&port, "name"});
    require_sound(body.ports[p].geometry, FieldPath{&port, "surface"});
  }
}

void require_taken(const Advance& asked, const Description& body) {
  const FieldPath path{nullptr, "advance"};
  for (std::size_t p = 0; p < asked.boundary.size(); ++p) {
    const BoundaryData& given = asked.boundary[p];
    const FieldPath boundary{&path, "boundary", static_cast<int>(p)};
    const auto require = [&boundary](bool taken, bool there, const char* part) {
      if (there && !taken) FieldPath{&boundary, part}.fail("is nothing that the body takes");
    };  // obstacles are held against the partners that it has met
    require(body.can.motion, !given.motion.empty(), "motion");
    require(body.can.force, given.pushed(), "forces");
    require(body.can.impulse, !given.impulse.empty(), "impulse");
    require(body.can.impedance, !given.impedance.empty(), "impedance");
  }
}

void require_sound(const Response& reply, const Description& body, const Advance& asked) {
  const FieldPath path{nullptr, "advanced"};
  // What an impulse does to joined sides, their velocities tell.
  const bool recoils =
      body.can.impulse && std::ranges::all_of(reply.ports, [](const PortResponse& port) {
        return port.trace.support == ForceSupport::nodal;
      });
  static const Want everything;
  for (std::size_t p = 0; p < body.ports.size(); ++p) {
    const FieldPath port{&path, "ports", static_cast<int>(p)};
    const PortResponse& response = reply.ports[p];
    const Want& want = asked.want.empty() ? everything : asked.want[p];
    require_trace(response, want, reply.steps, asked, port);
    require_box(response, body.ports[p], asked, port);
    if (!imposed(asked, p)) require_speed(response, body.ports[p].geometry, port);
    if (recoils && !response.recoil) FieldPath{&port, "recoil"}.fail("is missing");
  }
  for (int r = 0; r < asked.records; ++r) {
    const double time = asked.window.begin + asked.window.length() * (r + 1) / asked.records;
    require_record(reply.records[r], body, time, asked.window,
                   FieldPath{&path, "records", r});
  }
}

void require_sound(const PassiveReply& reply, const Description& body, const PassiveStep& asked) {
  const FieldPath path{nullptr, "passive_stepped"};
  require_record(reply.record, body, asked.end, {0, asked.begin, asked.end},
                 FieldPath{&path, "record"});
  require_compliance(reply.compliance, pressed_values(asked, body),
                     FieldPath{&path, "compliance"});
}

void require_sound(const PortKernel& kernel, const Description& body, const Probing& asked) {
  const FieldPath path{nullptr, "kernel"};
  constexpr double rounding = 1.0e-9;  // as that of steps in a window
  if (!(std::abs(kernel.step - asked.step) <= rounding * asked.step))
    FieldPath{&path, "step"}.fail(fmt::format("is {} s, where {} s was asked for, {:.2g} of it off",
                                              kernel.step, asked.step,
                                              std::abs(kernel.step / asked.step - 1.0)));
  if (kernel.support == ForceSupport::linear)
    FieldPath{&path, "support"}.fail(
        "is LINEAR: pulses of a kernel act over a substep (STEP) or over the dual cell around its "
        "end (NODAL)");
  if (!asked.seen.empty()) return;
  if (kernel.support == ForceSupport::nodal && kernel.begin.empty())
    FieldPath{&path, "begin"}.fail("is missing, which belongs to forces of NODAL support");
  const std::size_t motions = index(loose_motions(body)), width = index(kernel.width);
  if (kernel.carried.size() != motions * width) FieldPath{&path, "carried"}.fail("is missing");
  if (kernel.left.size() != motions * motions) FieldPath{&path, "left"}.fail("is missing");
  if (body.quasi_static) return;  // a static state may be unstable
  // From rest a force does no negative work while it acts: what it does first is along it.
  for (std::size_t p = 0; p < index(kernel.patterns); ++p) {
    double work = 0.0, size = 0.0;
    for (std::size_t k = p * width; k < (p + 1) * width; ++k) {
      work += asked.patterns[k] * kernel.displacement[k];
      size += std::abs(asked.patterns[k] * kernel.displacement[k]);
    }
    if (work < -1.0e-9 * size)
      FieldPath{&path, "displacement"}.fail(
          fmt::format("moves against the force in pattern {}: a sign or a normal is wrong", p));
  }
}

}  // namespace abut
