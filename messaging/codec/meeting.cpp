#include <fmt/format.h>

#include "base/index.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

namespace {

// A member added to the contract and forgotten here would silently arrive as zero.
static_assert(sizeof(FrictionLaw) == 2 * sizeof(double));
static_assert(sizeof(ContactLaw) == sizeof(double) + sizeof(FrictionLaw));  // and two flags
static_assert(sizeof(Meeting) == 3 * sizeof(double) + sizeof(ContactLaw));

void encode(const FrictionLaw& from, v1::Meet& to) {
  to.set_static_friction(from.static_friction);
  to.set_kinetic_friction(from.kinetic_friction);
}

void decode(const v1::Meet& from, const FieldPath& path, FrictionLaw& to) {
  const FieldPath sticks{&path, "static_friction"}, slides{&path, "kinetic_friction"};
  to.static_friction = number(from.static_friction(), sticks, Allow::not_negative);
  to.kinetic_friction = number(from.kinetic_friction(), slides, Allow::not_negative);
}

void decode_surface(const v1::Surface& from, int dim, const FieldPath& path, PortGeometry& to) {
  decode(from, path, to);
  if (to.dim != dim)
    FieldPath{&path, "dim"}.fail(fmt::format("is {}, but the port's is {}", to.dim, dim));
  if (to.count() == 0) FieldPath{&path, "points"}.fail("is empty");
}

/// Of a surface of this size: whole, or a part of its patterns.
void decode_kernel(const v1::Meet& from, const SurfaceSize& surface, const FieldPath& path,
                   ReceivedMeeting& to) {
  const FieldPath kernel{&path, "kernel"};
  to.kernel.points.assign(from.kernel().points().begin(), from.kernel().points().end());
  check_points(to.kernel.points, surface.points, FieldPath{&kernel, "points"});
  const int width = to.kernel.points.empty()
                        ? surface.width()
                        : static_cast<int>(to.kernel.points.size()) * surface.dim;
  to.patterns = width;
  if (from.has_first()) to.first = position(from.first(), index(width), FieldPath{&path, "first"});
  const int most = width - to.first.value_or(0), some = from.kernel().patterns();
  const int patterns = to.first && some > 0 && some < most ? some : most;
  decode(from.kernel(), patterns, width, surface.dim, kernel, to.kernel);
}

}  // namespace

void encode(const Meeting& from, std::optional<int> first, v1::Meet& to) {
  to.Clear();
  to.set_port(from.port);
  to.set_partner(from.partner);
  if (from.surface != nullptr) {
    encode(*from.surface, *to.mutable_surface());
    to.set_tied(from.law.tied);
    to.set_points(from.law.points);
    encode(from.law.friction, to);
  }
  if (from.kernel != nullptr) encode(*from.kernel, *to.mutable_kernel());
  if (first) to.set_first(*first);
}

void decode(const v1::Meet& from, const Description& body, const Partners& met,
            ReceivedMeeting& to) {
  const FieldPath path{nullptr, "meet"};
  to.first.reset();
  to.meeting = {};
  to.meeting.port = position(from.port(), body.ports.size(), FieldPath{&path, "port"});
  to.meeting.partner = from.partner();
  const PortGeometry& port = body.ports[to.meeting.port].geometry;
  const std::vector<SurfaceSize>& partners = met[to.meeting.port];
  const FieldPath partner{&path, "partner"}, surface{&path, "surface"};
  const bool own = to.meeting.partner == own_surface;
  if (!from.has_surface() && !from.has_kernel()) surface.fail("is missing, and so is kernel");
  if (from.has_surface()) {
    if (to.meeting.partner != static_cast<int>(partners.size()))
      partner.fail(fmt::format("is {}, where {} is next", to.meeting.partner, partners.size()));
    if (from.has_first()) FieldPath{&path, "first"}.fail("is of a part, which has no surface");
    decode_surface(from.surface(), port.dim, surface, to.surface);
    to.meeting.law.tied = from.tied();
    to.meeting.law.points = from.points();
    decode(from, path, to.meeting.law.friction);
    to.meeting.surface = &to.surface;
  } else if (!own) {
    position(to.meeting.partner, partners.size(), partner);
  }
  if (!from.has_kernel()) return;
  const SurfaceSize size = from.has_surface() ? size_of(to.surface)
                           : own              ? size_of(port)
                                              : partners[to.meeting.partner];
  decode_kernel(from, size, path, to);
  to.meeting.kernel = &to.kernel;
}

}  // namespace abut
