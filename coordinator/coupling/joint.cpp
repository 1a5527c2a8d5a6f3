#include "coordinator/coupling/joint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
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
}

void Joint::engage(double speed) {
  contact = State::near;
  closing_speed = speed;
  force_scale = 0.0;
}

namespace {

/// Surfaces of several points are joined point by point: their places must be the same.
void match_points(Joint& joint, const PortGeometry& a, const PortGeometry& b) {
  constexpr double coincidence = 1.0e-6;  // of the coarser mesh
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

namespace {

struct Facets {
  double rise = 0.0;          // [m] out of the tangent planes at their nodes, at most
  double reach_square = 0.0;  // [m^2] of the longest way between nodes of one
};

Facets facets_of(const PortGeometry& surface) {
  const std::size_t dim = index(surface.dim);
  Facets facets;
  for (std::size_t f = 0; f + 1 < surface.offsets.size(); ++f) {
    const std::size_t begin = index(surface.offsets[f]), end = index(surface.offsets[f + 1]);
    for (std::size_t a = begin; a < end; ++a) {
      for (std::size_t b = begin; b < end; ++b) {
        double off = 0.0, square = 0.0;
        for (std::size_t i = 0; i < dim; ++i) {
          const double way = surface.points[index(surface.facets[b]) * dim + i] -
                             surface.points[index(surface.facets[a]) * dim + i];
          off += surface.normals[index(surface.facets[a]) * dim + i] * way;
          square += way * way;
        }
        facets.rise = std::max(facets.rise, std::abs(off));
        facets.reach_square = std::max(facets.reach_square, square);
      }
    }
  }
  return facets;
}

/// [m] by which rows see a side nearer than its facets are. A dual row of facets of length h of a
/// flat side takes the rise k h^2/2 of the other's curvature k for -k h^2/12: a sixth. Half as much
/// again is added, for meshes that are not uniform.
double early(const Facets& curved, const Facets& rows) {
  if (curved.rise == 0.0) return 0.0;
  return 0.25 * curved.rise * std::max(1.0, rows.reach_square / curved.reach_square);
}

}  // namespace

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
  const std::array<Facets, 2> facets = {facets_of(bodies.port(sides[0]).geometry),
                                        facets_of(bodies.port(sides[1]).geometry)};
  for (std::size_t s : {0u, 1u}) {  // rows are of sides that take obstacles
    const bool finds = bodies.describe(sides[s].body).can.obstacle;
    joint.margin += early(facets[1 - s], finds ? facets[s] : facets[1 - s]);
  }
  return joint;
}

void introduce(Joint& joint, Bodies& bodies) {
  for (std::size_t s : {0u, 1u})
    bodies.meet(joint.sides[s], bodies.port(joint.sides[1 - s]).geometry,
                {joint.tied(), joint.points, joint.static_friction, joint.kinetic_friction});
}

}  // namespace abut
