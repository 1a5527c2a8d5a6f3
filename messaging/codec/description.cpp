#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(Capabilities) == 12 * sizeof(bool));
static_assert(sizeof(Port) == sizeof(std::string) + sizeof(PortGeometry) + sizeof(double));
static_assert(sizeof(Member) ==
              sizeof(std::string) + sizeof(double) + sizeof(std::vector<std::int32_t>));

void encode(const Capabilities& from, v1::Capabilities& to) {
  to.set_motion(from.motion);
  to.set_force(from.force);
  to.set_obstacle(from.obstacle);
  to.set_impulse(from.impulse);
  to.set_kernel(from.kernel);
  to.set_impedance(from.impedance);
  to.set_yielding(from.yielding);
  to.set_friction(from.friction);
  to.set_neighbours(from.neighbours);
  to.set_passive(from.passive);
  to.set_only_passive(from.only_passive);
  to.set_bands(from.bands);
}

Capabilities decode(const v1::Capabilities& from) {
  return {.motion = from.motion(),
          .force = from.force(),
          .obstacle = from.obstacle(),
          .impulse = from.impulse(),
          .kernel = from.kernel(),
          .impedance = from.impedance(),
          .yielding = from.yielding(),
          .friction = from.friction(),
          .neighbours = from.neighbours(),
          .passive = from.passive(),
          .only_passive = from.only_passive(),
          .bands = from.bands()};
}

void decode_described_port(const v1::Port& from, const Description& body, const FieldPath& path,
                           Port& to) {
  to.name = from.name();
  if (to.name.empty()) FieldPath{&path, "name"}.fail("is empty");
  for (const Port& earlier : body.ports) {
    if (&earlier == &to) break;
    if (earlier.name != to.name) continue;
    FieldPath{&path, "name"}.fail(fmt::format("is {}, as that of another port", to.name));
  }
  const FieldPath surface{&path, "surface"};
  if (!from.has_surface()) surface.fail("is missing");
  decode(from.surface(), surface, to.geometry);
  if (to.geometry.points.empty()) FieldPath{&surface, "points"}.fail("is empty");
  if (to.geometry.dim != body.dim) {
    FieldPath{&surface, "dim"}.fail(
        fmt::format("is {}, but the body's is {}", to.geometry.dim, body.dim));
  }
  to.tied = from.tied();
}

void decode_members(const v1::Description& from, const FieldPath& path, std::vector<Member>& to) {
  if (from.members_size() > most_names) FieldPath{&path, "members"}.fail("has too many entries");
  to.resize(index(from.members_size()));
  for (int i = 0; i < from.members_size(); ++i) {
    const FieldPath member{&path, "members", i};
    Member& ours = to[i];
    ours.name = from.members(i).name();
    ours.mass =
        number(from.members(i).mass(), FieldPath{&member, "mass"}, Allow::not_negative_or_inf);
    ours.ports.assign(from.members(i).ports().begin(), from.members(i).ports().end());
    for (const std::int32_t port : ours.ports) {
      if (port >= 0 && port < from.ports_size()) continue;
      FieldPath{&member, "ports"}.fail(fmt::format("names port {}", port));
    }
  }
}

}  // namespace

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
  to.set_linear(from.linear);
  to.set_quasi_static(from.quasi_static);
  copy(from.loose, *to.mutable_loose());
  to.set_stabilised(from.stabilised);
  for (const Port& port : from.ports) {
    v1::Port& wire = *to.add_ports();
    wire.set_name(port.name);
    wire.set_tied(port.tied);
    encode(port.geometry, *wire.mutable_surface());
  }
  encode(from.can, *to.mutable_can());
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
  to.mass = number(from.mass(), FieldPath{&path, "mass"}, Allow::not_negative_or_inf);
  to.step = number(from.step(), FieldPath{&path, "step"}, Allow::not_negative);
  to.stable_step =
      number(from.stable_step(), FieldPath{&path, "stable_step"}, Allow::not_negative_or_inf);
  to.conserves = from.conserves();
  to.linear = from.linear();
  to.quasi_static = from.quasi_static();
  take(from.loose(), FieldPath{&path, "loose"}, to.loose);
  if (to.loose.size() % index(to.dim == 2 ? 3 : 6) != 0)
    FieldPath{&path, "loose"}.fail(fmt::format("has {} values", to.loose.size()));
  to.stabilised = from.stabilised();
  if (from.ports_size() > most_ports) FieldPath{&path, "ports"}.fail("has too many entries");
  to.ports.resize(index(from.ports_size()));
  for (int i = 0; i < from.ports_size(); ++i) {
    decode_described_port(from.ports(i), to, FieldPath{&path, "ports", i}, to.ports[i]);
  }
  if (!from.has_can()) FieldPath{&path, "can"}.fail("is missing");
  to.can = decode(from.can());
  take_names(from.measures(), FieldPath{&path, "measures"}, to.measures);
  take_names(from.columns(), FieldPath{&path, "columns"}, to.columns);
  take(from.frequencies(), FieldPath{&path, "frequencies"}, to.frequencies);
  decode(from, path, to.fields);
  decode_members(from, path, to.members);
}

}  // namespace abut
