#include "coordinator/coupling/joint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "coordinator/coupling/row_margin.hpp"
#include "coordinator/coupling/transmission.hpp"

namespace abut {

Joint::Joint() = default;
Joint::~Joint() = default;
Joint::Joint(Joint&&) noexcept = default;
Joint& Joint::operator=(Joint&&) noexcept = default;

void Joint::state(Archive& archive) {
  std::int64_t stage = static_cast<std::int64_t>(contact), side = kinematic;
  archive.field("contact", stage);
  archive.field("kinematic", side);
  contact = static_cast<State>(stage);
  kinematic = static_cast<int>(side);
  archive.field("opened_at", opened_at);
  archive.field("touched_at", touched_at);
  archive.field("touch_speed", touch_speed);
  archive.field("closing_speed", closing_speed);
  archive.field("force_scale", force_scale);
  archive.field("debt", debt);
  archive.field("rebound_impulse", rebound_impulse);
  archive.field("impulse", impulse);
  if (how != nullptr && how->tie() != nullptr) archive.field("jump", jump);
}

void Joint::engage(double speed) {
  contact = State::near;
  closing_speed = speed;
  force_scale = 0.0;
}

namespace {

/// Surfaces of several points are joined point by point: their places must be the same.
void match_points(Joint& joint, const PortGeometry& a, const PortGeometry& b) {
  const double most = coincidence * std::max(a.spacing, b.spacing);
  bool same = a.dim == b.dim && a.points.size() == b.points.size();
  for (std::size_t k = 0; same && k < a.points.size(); ++k)
    same = std::abs(a.points[k] - b.points[k]) <= most;
  if (!same) {
    throw InputError("its sides are surfaces whose points differ", "interfaces." + joint.name,
                     "Join ports whose points are at the same places, in the same order.");
  }
  joint.width = a.count() * a.dim;
  joint.normal = {1.0, -1.0};
}

}  // namespace

Joint make_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies) {
  Joint joint;
  joint.name = std::move(name);
  joint.sides = sides;
  const PortGeometry& a = bodies.port(sides[0]).geometry;
  const PortGeometry& b = bodies.port(sides[1]).geometry;
  if (a.points.size() > 1 || b.points.size() > 1) {
    match_points(joint, a, b);
    return joint;
  }
  joint.normal = {a.normals[0], b.normals[0]};
  const std::string where = "interfaces." + joint.name;
  if (joint.normal[0] + joint.normal[1] != 0.0) {
    throw InputError("its two ports look the same way and cannot touch", where,
                     "Join a right end with a left end.");
  }
  joint.reference_gap = joint.normal[0] * (b.points[0] - a.points[0]);
  const double rounding =
      std::max(place_rounding * std::max(std::abs(a.points[0]), std::abs(b.points[0])),
               place_tolerance * std::max(a.spacing, b.spacing));
  if (joint.reference_gap < -rounding) {
    throw InputError(fmt::format("its sides overlap by {:g} m at the start", -joint.reference_gap),
                     where, "Move a body with initial.position until the gap is zero or more.");
  }
  joint.reference_gap = std::max(0.0, joint.reference_gap);
  return joint;
}

Joint make_surface_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies) {
  Joint joint;
  joint.name = std::move(name);
  joint.sides = sides;
  joint.surfaces = true;
  for (const Side& side : sides) {
    if (!bodies.port(side).geometry.facets.empty()) continue;
    throw InputError(fmt::format("port '{}' of body '{}' has no facets, so nothing can touch it",
                                 bodies.port(side).name, bodies.describe(side.body).name),
                     "interfaces." + joint.name, "Put the port on a side of the mesh.");
  }
  joint.margin = row_margin(sides, bodies);
  return joint;
}

void introduce(Joint& joint, Bodies& bodies) {
  joint.met = true;
  for (std::size_t s : {0u, 1u})
    bodies.meet(joint.sides[s], bodies.port(joint.sides[1 - s]).geometry,
                {joint.tied(), joint.points, joint.static_friction, joint.kinetic_friction});
}

}  // namespace abut
