#include "coordinator/coupling/joint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/line_watch.hpp"

namespace abut {

Joint::Joint() = default;
Joint::~Joint() = default;
Joint::Joint(Joint&&) noexcept = default;
Joint& Joint::operator=(Joint&&) noexcept = default;

void ContactState::state(Archive& archive) {
  std::int64_t now = static_cast<std::int64_t>(stage);
  archive.field("stage", now);
  stage = static_cast<Stage>(now);
  archive.field("closing_speed", closing_speed);
  archive.field("force_scale", force_scale);
  archive.field("impulse", impulse);
  for (double& heat : rubbed) archive.field("rubbed", heat);
}

void Joint::state(Archive& archive) {
  std::int64_t side = role.kinematic;
  archive.field("kinematic", side);
  role.kinematic = static_cast<int>(side);
  archive.field("role_fixed", role.fixed);
  contact.state(archive);
  if (ContactAccount* account = watch->account()) account->state(archive);
}

void Joint::memory(Archive& archive) {
  watch->state(archive);
  if (exchange != nullptr) exchange->state(archive);
}

void Joint::engage(double speed) {
  contact.stage = ContactState::Stage::near;
  contact.closing_speed = speed;
  contact.force_scale = 0.0;
}

bool Joint::tied() const { return watch->decision() == Decision::never; }

bool Joint::deciding() const { return watch->decision() == Decision::every_substep && closed(); }

Joint make_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies) {
  Joint joint;
  joint.name = std::move(name);
  joint.sides = sides;
  joint.watch = std::make_unique<PointWatch>();
  const PortGeometry& a = bodies.port(sides[0]).geometry;
  const PortGeometry& b = bodies.port(sides[1]).geometry;
  const std::string where = "interfaces." + joint.name;
  for (const Side& side : sides) {
    const Port& port = bodies.port(side);
    if (port.geometry.dim == 1 && port.geometry.points.size() == 1) continue;
    throw InputError(fmt::format("port '{}' of body '{}' has {} points, and the end of a bar one",
                                 port.name, bodies.describe(side.body).name, port.geometry.count()),
                     where, "Join surfaces with contact or tied, or ports of one point each.");
  }
  joint.line.normal = {a.normals[0], b.normals[0]};
  if (joint.line.normal[0] + joint.line.normal[1] != 0.0) {
    throw InputError("its two ports look the same way and cannot touch", where,
                     "Join a right end with a left end.");
  }
  joint.line.reference_gap = joint.line.normal[0] * (b.points[0] - a.points[0]);
  const double rounding =
      std::max(place_rounding * std::max(std::abs(a.points[0]), std::abs(b.points[0])),
               place_tolerance * std::max(a.spacing, b.spacing));
  if (joint.line.reference_gap < -rounding) {
    throw InputError(
        fmt::format("its sides overlap by {:g} m at the start", -joint.line.reference_gap), where,
        "Move a body with initial.position until the gap is zero or more.");
  }
  joint.line.reference_gap = std::max(0.0, joint.line.reference_gap);
  return joint;
}

Joint make_surface_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies) {
  Joint joint;
  joint.name = std::move(name);
  joint.sides = sides;
  for (const Side& side : sides) {
    if (!bodies.port(side).geometry.facets.empty()) continue;
    throw InputError(fmt::format("port '{}' of body '{}' has no facets, so nothing can touch it",
                                 bodies.port(side).name, bodies.describe(side.body).name),
                     "interfaces." + joint.name, "Put the port on a side of the mesh.");
  }
  return joint;
}

}  // namespace abut
