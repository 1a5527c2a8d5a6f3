#include "messaging/codec.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "messaging/codec_parts.hpp"

namespace abut {

namespace {

constexpr int most_ports = 4096;
constexpr int most_members = 4096;

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(TimeWindow) == 3 * sizeof(double));
static_assert(sizeof(Energy) == 4 * sizeof(double));
static_assert(sizeof(BodyRecord) ==
              sizeof(Energy) + sizeof(double) + 4 * sizeof(std::vector<double>));
static_assert(sizeof(MemberRecord) == sizeof(Energy) + sizeof(std::vector<double>));
static_assert(sizeof(Member) ==
              sizeof(std::string) + sizeof(double) + sizeof(std::vector<std::int32_t>));
static_assert(sizeof(Recoil) == 2 * sizeof(double));
static_assert(sizeof(PortResponse) == sizeof(Waveform) + 2 * sizeof(std::vector<double>) +
                                          3 * sizeof(double) + sizeof(std::optional<Recoil>));
static_assert(sizeof(Capabilities) == 7 * sizeof(bool));
static_assert(sizeof(PortKernel) == 3 * sizeof(double) + 2 * sizeof(std::vector<double>));
static_assert(sizeof(Obstacle) == sizeof(Waveform) + sizeof(std::vector<double>) + sizeof(double));
static_assert(sizeof(Impedance) == 2 * sizeof(double));
static_assert(sizeof(BoundaryData) == 2 * sizeof(Waveform) + sizeof(Obstacle) + sizeof(Impedance) +
                                          sizeof(std::vector<double>));
static_assert(sizeof(PortGeometry) == 4 * sizeof(std::vector<double>) + 3 * sizeof(double));
static_assert(sizeof(Port) == sizeof(std::string) + sizeof(PortGeometry) + sizeof(double));

constexpr std::array<std::pair<Failed::Cause, v1::FailureCause>, 4> causes{{
    {Failed::Cause::no_convergence, v1::FAILURE_CAUSE_NO_CONVERGENCE},
    {Failed::Cause::inverted_element, v1::FAILURE_CAUSE_INVERTED_ELEMENT},
    {Failed::Cause::step_too_small, v1::FAILURE_CAUSE_STEP_TOO_SMALL},
    {Failed::Cause::non_finite, v1::FAILURE_CAUSE_NON_FINITE},
}};

int dimension(int dim, const FieldPath& path) {
  if (dim < 1 || dim > 3) path.fail(fmt::format("is {}, not 1, 2 or 3", dim));
  return dim;
}

/// Sizes a repeated message and keeps the memory of the entries.
template <class T>
void resize(google::protobuf::RepeatedPtrField<T>& field, std::size_t count) {
  while (field.size() > static_cast<int>(count)) field.RemoveLast();
  while (field.size() < static_cast<int>(count)) field.Add();
}

void encode(const BoundaryData& from, v1::BoundaryData& to) {
  if (from.motion.empty()) {
    to.clear_motion();
  } else {
    abut::encode(from.motion, *to.mutable_motion());
  }
  if (from.force.empty()) {
    to.clear_force();
  } else {
    abut::encode(from.force, *to.mutable_force());
  }
  if (from.obstacle.empty()) {
    to.clear_obstacle();
  } else {
    abut::encode(from.obstacle.motion, *to.mutable_obstacle()->mutable_motion());
    copy(from.obstacle.offset, *to.mutable_obstacle()->mutable_offset());
    to.mutable_obstacle()->set_bilateral(from.obstacle.bilateral);
  }
  if (from.impedance.empty()) {
    to.clear_impedance();
  } else {
    to.mutable_impedance()->set_value(from.impedance.value);
    to.mutable_impedance()->set_bilateral(from.impedance.bilateral);
  }
  copy(from.impulse, *to.mutable_impulse());
}

/// An absent waveform is an empty one; a present one must hold something.
void decode_optional(bool present, const v1::Waveform& from, const FieldPath& path, Waveform& to) {
  if (!present) {
    to.clear();
    return;
  }
  abut::decode(from, path, to);
  if (to.empty()) path.fail("is present but empty");
}

void decode(const v1::BoundaryData& from, const FieldPath& path, BoundaryData& to) {
  decode_optional(from.has_motion(), from.motion(), FieldPath{&path, "motion"}, to.motion);
  decode_optional(from.has_force(), from.force(), FieldPath{&path, "force"}, to.force);
  const FieldPath obstacle{&path, "obstacle"};
  decode_optional(from.has_obstacle(), from.obstacle().motion(), FieldPath{&obstacle, "motion"},
                  to.obstacle.motion);
  take(from.obstacle().offset(), FieldPath{&obstacle, "offset"}, to.obstacle.offset);
  to.obstacle.bilateral = from.obstacle().bilateral();
  if (from.has_obstacle() && to.obstacle.offset.size() != index(to.obstacle.motion.width)) {
    obstacle.fail(fmt::format("has {} offsets for a width of {}", to.obstacle.offset.size(),
                              to.obstacle.motion.width));
  }
  to.impedance = {};
  if (from.has_impedance()) {
    const FieldPath impedance{&path, "impedance"};
    to.impedance = {number(from.impedance().value(), impedance), from.impedance().bilateral()};
    if (to.impedance.value <= 0.0) impedance.fail("is not positive");
  }
  take(from.impulse(), FieldPath{&path, "impulse"}, to.impulse);
}

void decode(const v1::PortResponse& from, const Port& port, std::size_t records,
            const FieldPath& path, PortResponse& to) {
  decode_optional(from.has_trace(), from.trace(), FieldPath{&path, "trace"}, to.trace);
  const std::size_t dim = index(port.geometry.dim);
  const int width = port.geometry.count() * port.geometry.dim;
  if (from.has_trace() && to.trace.width != width) {
    FieldPath{&path, "trace"}.fail(
        fmt::format("has width {} where port '{}' has {}", to.trace.width, port.name, width));
  }
  take(from.lower(), records * dim, true, FieldPath{&path, "lower"}, to.lower);
  take(from.upper(), records * dim, true, FieldPath{&path, "upper"}, to.upper);
  to.approach_bound =
      number(from.approach_bound(), FieldPath{&path, "approach_bound"}, Allow::infinite);
  to.approach_acceleration = number(from.approach_acceleration(),
                                    FieldPath{&path, "approach_acceleration"}, Allow::infinite);
  to.work = number(from.work(), FieldPath{&path, "work"});
  to.recoil.reset();
  if (!from.has_recoil()) return;
  const FieldPath at{&path, "recoil"};
  to.recoil = Recoil{.velocity = number(from.recoil().velocity(), at),
                     .mobility = number(from.recoil().mobility(), at)};
}

/// Of a body's record or a member's: both have the same fields.
template <class Wire>
void encode_energy(const Energy& from, Wire& to) {
  to.set_kinetic(from.kinetic);
  to.set_stored(from.stored);
  to.set_dissipated(from.dissipated);
  to.set_external_work(from.external_work);
}

template <class Wire>
Energy decode_energy(const Wire& from, const FieldPath& path) {
  return Energy{.kinetic = number(from.kinetic(), FieldPath{&path, "kinetic"}),
                .stored = number(from.stored(), FieldPath{&path, "stored"}),
                .dissipated = number(from.dissipated(), FieldPath{&path, "dissipated"}),
                .external_work = number(from.external_work(), FieldPath{&path, "external_work"})};
}

void decode(const v1::BodyRecord& from, const Description& body, const FieldPath& path,
            BodyRecord& to) {
  const std::size_t dim = index(body.dim);
  to.time = number(from.time(), FieldPath{&path, "time"});
  to.energy = decode_energy(from, path);
  take(from.momentum(), dim, true, FieldPath{&path, "momentum"}, to.momentum);
  take(from.angular_momentum(), dim < 3 ? dim - 1 : dim, true, FieldPath{&path, "angular_momentum"},
       to.angular_momentum);
  take(from.columns(), body.columns.size(), false, FieldPath{&path, "columns"}, to.columns);
  if (index(from.members_size()) != body.members.size()) {
    FieldPath{&path, "members"}.fail(
        fmt::format("has {} entries for {} members", from.members_size(), body.members.size()));
  }
  to.members.resize(body.members.size());
  for (std::size_t i = 0; i < to.members.size(); ++i) {
    const v1::MemberRecord& wire = from.members(static_cast<int>(i));
    const FieldPath member{&path, "members", static_cast<int>(i)};
    to.members[i].energy = decode_energy(wire, member);
    take(wire.momentum(), dim, true, FieldPath{&member, "momentum"}, to.members[i].momentum);
  }
}

void decode(const v1::Port& from, const FieldPath& path, Port& to) {
  to.name = from.name();
  PortGeometry& geometry = to.geometry;
  geometry.dim = dimension(from.dim(), FieldPath{&path, "dim"});
  take(from.points(), FieldPath{&path, "points"}, geometry.points);
  if (geometry.points.size() % index(geometry.dim) != 0) {
    FieldPath{&path, "points"}.fail("is no whole number of points");
  }
  take(from.normals(), geometry.points.size(), false, FieldPath{&path, "normals"},
       geometry.normals);
  geometry.facets.assign(from.facets().begin(), from.facets().end());
  geometry.offsets.assign(from.offsets().begin(), from.offsets().end());
  for (const std::int32_t point : geometry.facets) {
    if (point >= 0 && point < geometry.count()) continue;
    FieldPath{&path, "facets"}.fail(fmt::format("names point {}", point));
  }
  geometry.spacing = number(from.spacing(), FieldPath{&path, "spacing"});
  geometry.transit = number(from.transit(), FieldPath{&path, "transit"});
  to.tied = from.tied();
}

void decode_names(const google::protobuf::RepeatedPtrField<std::string>& from,
                  const FieldPath& path, std::vector<std::string>& to) {
  if (from.size() > most_members) path.fail("has too many entries");
  to.assign(from.begin(), from.end());
}

}  // namespace

void encode(const Advance& from, v1::Advance& to) {
  v1::TimeWindow& window = *to.mutable_window();
  window.set_index(from.window.index);
  window.set_begin(from.window.begin);
  window.set_end(from.window.end);
  to.set_records(from.records);
  to.set_sampling(from.sampling == Sampling::substeps ? v1::SAMPLING_SUBSTEPS
                                                      : v1::SAMPLING_RECORDS);
  resize(*to.mutable_boundary(), from.boundary.size());
  for (std::size_t i = 0; i < from.boundary.size(); ++i) {
    encode(from.boundary[i], *to.mutable_boundary(static_cast<int>(i)));
  }
}

void decode(const v1::Advance& from, std::size_t ports, Advance& to) {
  const FieldPath path{nullptr, "advance"};
  const FieldPath window{&path, "window"};
  if (!from.has_window()) window.fail("is missing");
  to.window.index = from.window().index();
  to.window.begin = number(from.window().begin(), window);
  to.window.end = number(from.window().end(), window);
  if (to.window.end < to.window.begin) window.fail("ends before its begin");
  if (from.records() < 1 || from.records() > most_records) {
    FieldPath{&path, "records"}.fail(
        fmt::format("is {}, not 1 to {}", from.records(), most_records));
  }
  to.records = from.records();
  if (from.sampling() != v1::SAMPLING_SUBSTEPS && from.sampling() != v1::SAMPLING_RECORDS) {
    FieldPath{&path, "sampling"}.fail("has an unknown value");
  }
  to.sampling = from.sampling() == v1::SAMPLING_SUBSTEPS ? Sampling::substeps : Sampling::records;
  if (index(from.boundary_size()) != ports) {
    FieldPath{&path, "boundary"}.fail(
        fmt::format("has {} entries for {} ports", from.boundary_size(), ports));
  }
  to.boundary.resize(ports);
  for (std::size_t i = 0; i < ports; ++i) {
    const int p = static_cast<int>(i);
    decode(from.boundary(p), FieldPath{&path, "boundary", p}, to.boundary[i]);
  }
}

void encode(const Response& from, v1::Advanced& to) {
  resize(*to.mutable_ports(), from.ports.size());
  for (std::size_t i = 0; i < from.ports.size(); ++i) {
    const PortResponse& port = from.ports[i];
    v1::PortResponse& wire = *to.mutable_ports(static_cast<int>(i));
    if (port.trace.empty()) {
      wire.clear_trace();
    } else {
      encode(port.trace, *wire.mutable_trace());
    }
    copy(port.lower, *wire.mutable_lower());
    copy(port.upper, *wire.mutable_upper());
    wire.set_approach_bound(port.approach_bound);
    wire.set_approach_acceleration(port.approach_acceleration);
    wire.set_work(port.work);
    wire.clear_recoil();
    if (!port.recoil) continue;
    wire.mutable_recoil()->set_velocity(port.recoil->velocity);
    wire.mutable_recoil()->set_mobility(port.recoil->mobility);
  }
  resize(*to.mutable_records(), from.records.size());
  for (std::size_t i = 0; i < from.records.size(); ++i) {
    const BodyRecord& record = from.records[i];
    v1::BodyRecord& wire = *to.mutable_records(static_cast<int>(i));
    wire.set_time(record.time);
    encode_energy(record.energy, wire);
    copy(record.momentum, *wire.mutable_momentum());
    copy(record.angular_momentum, *wire.mutable_angular_momentum());
    copy(record.columns, *wire.mutable_columns());
    resize(*wire.mutable_members(), record.members.size());
    for (std::size_t m = 0; m < record.members.size(); ++m) {
      v1::MemberRecord& member = *wire.mutable_members(static_cast<int>(m));
      encode_energy(record.members[m].energy, member);
      copy(record.members[m].momentum, *member.mutable_momentum());
    }
  }
  to.set_steps(from.steps);
  to.set_compute_seconds(from.compute_seconds);
}

void decode(const v1::Advanced& from, const Description& body, Response& to) {
  const FieldPath path{nullptr, "advanced"};
  if (!from.has_steps()) FieldPath{&path, "steps"}.fail("is missing");
  if (from.steps() < 0) FieldPath{&path, "steps"}.fail("is negative");
  if (index(from.ports_size()) != body.ports.size()) {
    FieldPath{&path, "ports"}.fail(
        fmt::format("has {} entries for {} ports", from.ports_size(), body.ports.size()));
  }
  to.ports.resize(body.ports.size());
  for (std::size_t i = 0; i < to.ports.size(); ++i) {
    const int p = static_cast<int>(i);
    decode(from.ports(p), body.ports[i], index(from.records_size()), FieldPath{&path, "ports", p}, to.ports[i]);
  }
  if (from.records_size() > most_records) FieldPath{&path, "records"}.fail("has too many entries");
  to.records.resize(index(from.records_size()));
  for (int i = 0; i < from.records_size(); ++i) {
    decode(from.records(i), body, FieldPath{&path, "records", i}, to.records[index(i)]);
  }
  to.steps = from.steps();
  to.compute_seconds = number(from.compute_seconds(), FieldPath{&path, "compute_seconds"});
}

void encode(const Failed& from, v1::Failed& to) {
  to.Clear();
  for (const auto& [ours, wire] : causes) {
    if (ours == from.cause) to.set_cause(wire);
  }
  to.set_time(from.time);
  to.set_detail(from.detail);
}

void decode(const v1::Failed& from, Failed& to) {
  bool known = false;
  for (const auto& [ours, wire] : causes) {
    if (wire != from.cause()) continue;
    to.cause = ours;
    known = true;
  }
  const FieldPath path{nullptr, "failed"};
  if (!known) FieldPath{&path, "cause"}.fail("has an unknown value");
  to.time = from.time();  // may be anything: it is the report of a failure
  to.detail = from.detail();
}

void encode(const PortKernel& from, v1::KernelReply& to) {
  to.Clear();
  to.set_step(from.step);
  to.set_support(encode(from.support));
  to.set_compliance(from.compliance);
  copy(from.displacement, *to.mutable_displacement());
  copy(from.begin, *to.mutable_begin());
}

void decode(const v1::KernelReply& from, PortKernel& to) {
  const FieldPath path{nullptr, "kernel"};
  to.step = number(from.step(), FieldPath{&path, "step"});
  to.support = decode(from.support(), FieldPath{&path, "support"});
  to.compliance = number(from.compliance(), FieldPath{&path, "compliance"});
  take(from.displacement(), FieldPath{&path, "displacement"}, to.displacement);
  take(from.begin(), to.displacement.size(), true, FieldPath{&path, "begin"}, to.begin);
}

void encode(const Description& from, v1::Description& to) {
  to.Clear();
  to.set_name(from.name);
  to.set_model(from.model);
  to.set_dim(from.dim);
  to.set_dofs(from.dofs);
  to.set_mass(from.mass);
  to.set_step(from.step);
  to.set_stable_step(from.stable_step);
  to.set_conserves(from.conserves);
  for (const Port& port : from.ports) {
    v1::Port& wire = *to.add_ports();
    wire.set_name(port.name);
    wire.set_dim(port.geometry.dim);
    copy(port.geometry.points, *wire.mutable_points());
    copy(port.geometry.normals, *wire.mutable_normals());
    wire.mutable_facets()->Add(port.geometry.facets.begin(), port.geometry.facets.end());
    wire.mutable_offsets()->Add(port.geometry.offsets.begin(), port.geometry.offsets.end());
    wire.set_spacing(port.geometry.spacing);
    wire.set_transit(port.geometry.transit);
    wire.set_tied(port.tied);
  }
  v1::Capabilities& can = *to.mutable_can();
  can.set_motion(from.can.motion);
  can.set_force(from.can.force);
  can.set_obstacle(from.can.obstacle);
  can.set_impulse(from.can.impulse);
  can.set_kernel(from.can.kernel);
  can.set_impedance(from.can.impedance);
  can.set_complete(from.can.complete);
  to.mutable_measures()->Assign(from.measures.begin(), from.measures.end());
  to.mutable_columns()->Assign(from.columns.begin(), from.columns.end());
  copy(from.frequencies, *to.mutable_frequencies());
  encode(from.fields, to);
  for (const Member& member : from.members) {
    v1::Member& wire = *to.add_members();
    wire.set_name(member.name);
    wire.set_mass(member.mass);
    wire.mutable_ports()->Add(member.ports.begin(), member.ports.end());
  }
}

void decode(const v1::Description& from, Description& to) {
  const FieldPath path{nullptr, "description"};
  to.name = from.name();
  to.model = from.model();
  to.dim = dimension(from.dim(), FieldPath{&path, "dim"});
  to.dofs = from.dofs();
  to.mass = number(from.mass(), FieldPath{&path, "mass"}, Allow::infinite);
  to.step = number(from.step(), FieldPath{&path, "step"});
  to.conserves = from.conserves();
  to.stable_step = number(from.stable_step(), FieldPath{&path, "stable_step"}, Allow::infinite);
  if (from.ports_size() > most_ports) FieldPath{&path, "ports"}.fail("has too many entries");
  to.ports.resize(index(from.ports_size()));
  for (int i = 0; i < from.ports_size(); ++i) {
    decode(from.ports(i), FieldPath{&path, "ports", i}, to.ports[index(i)]);
  }
  if (!from.has_can()) FieldPath{&path, "can"}.fail("is missing");
  const v1::Capabilities& can = from.can();
  to.can = Capabilities{.motion = can.motion(),
                        .force = can.force(),
                        .obstacle = can.obstacle(),
                        .impulse = can.impulse(),
                        .kernel = can.kernel(),
                        .impedance = can.impedance(),
                        .complete = can.complete()};
  decode_names(from.measures(), FieldPath{&path, "measures"}, to.measures);
  decode_names(from.columns(), FieldPath{&path, "columns"}, to.columns);
  take(from.frequencies(), FieldPath{&path, "frequencies"}, to.frequencies);
  decode(from, path, to.fields);
  if (from.members_size() > most_members) FieldPath{&path, "members"}.fail("has too many entries");
  to.members.resize(index(from.members_size()));
  for (int i = 0; i < from.members_size(); ++i) {
    const FieldPath member{&path, "members", i};
    Member& ours = to.members[index(i)];
    ours.name = from.members(i).name();
    ours.mass = number(from.members(i).mass(), FieldPath{&member, "mass"}, Allow::infinite);
    ours.ports.assign(from.members(i).ports().begin(), from.members(i).ports().end());
    for (const std::int32_t port : ours.ports) {
      if (port >= 0 && port < from.ports_size()) continue;
      FieldPath{&member, "ports"}.fail(fmt::format("names port {}", port));
    }
  }
}

}  // namespace abut
