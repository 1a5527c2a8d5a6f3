#include "base/index.hpp"
#include "messaging/codec/parts.hpp"
#include "messaging/protocol.hpp"

namespace abut {

namespace {

void encode(const PortPartner& from, v1::PortPartner& to) {
  to.set_interface(from.interface);
  to.set_body(from.body);
  to.set_port(from.port);
  to.set_tied(from.tied);
  to.set_external(from.external);
  to.set_points(from.points);
  to.set_finds(from.finds);
  if (from.overlap) {
    v1::OverlapRole& overlap = *to.mutable_overlap();
    overlap.set_first(from.overlap->first);
    overlap.set_halves(from.overlap->halves);
    overlap.set_motions(from.overlap->motions);
    overlap.set_unstable(from.overlap->unstable);
  }
  to.set_keys(from.keys);
  to.set_mesh_digest(from.mesh_digest);
}

PortPartner decode(const v1::PortPartner& from) {
  PortPartner to;
  to.interface = from.interface();
  to.body = from.body();
  to.port = from.port();
  to.tied = from.tied();
  to.external = from.external();
  to.points = from.points();
  to.finds = from.finds();
  if (from.has_overlap()) {
    const v1::OverlapRole& overlap = from.overlap();
    to.overlap =
        OverlapRole{overlap.first(), overlap.halves(), overlap.motions(), overlap.unstable()};
  }
  to.keys = from.keys();
  to.mesh_digest = from.mesh_digest();
  return to;
}

}  // namespace

void encode(const Specification& from, v1::Configure& to) {
  to.Clear();
  to.set_document(from.document);
  to.set_text(from.text);
  to.mutable_overrides()->Assign(from.overrides.begin(), from.overrides.end());
  to.set_path(from.path);
  for (const PortRole& role : from.context.ports) {
    v1::PortRole& port = *to.add_ports();
    port.set_port(role.port);
    port.set_touches(role.touches);
    port.set_tied(role.tied);
    port.set_alike(role.alike);
    for (const PortPartner& partner : role.partners) encode(partner, *port.add_partners());
  }
  to.set_others_touch(from.context.others_touch);
  to.set_mesh_digest(from.context.mesh_digest);
}

void decode(const v1::Configure& from, Specification& to) {
  to.document = from.document();
  to.text = from.text();
  to.overrides.assign(from.overrides().begin(), from.overrides().end());
  to.path = from.path();
  to.context = {};
  for (const v1::PortRole& port : from.ports()) {
    PortRole role{port.port(), port.touches(), port.tied(), port.alike(), {}};
    for (const v1::PortPartner& partner : port.partners()) role.partners.push_back(decode(partner));
    to.context.ports.push_back(std::move(role));
  }
  to.context.others_touch = from.others_touch();
  to.context.mesh_digest = from.mesh_digest();
}

}  // namespace abut
