#include "coordinator/tied_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/nearly.hpp"
#include "coordinator/coupling/compare/alternating_tie.hpp"
#include "coordinator/coupling/compare/dashpot_tie.hpp"
#include "coordinator/coupling/compare/motion_rows.hpp"
#include "coordinator/coupling/tie_watch.hpp"
#include "surface/unlike_meshes.hpp"

namespace abut {

namespace {

void check_side(const Description& body, const PortGeometry& face, const std::string& side,
                const std::string& where) {
  if (face.facets.empty() && face.dim > 1) {
    throw InputError(fmt::format("joins {}, which has no facets", side), where + ".sides",
                     "Put the port on a side of the mesh.");
  }
  if (!std::isinf(body.mass) && (!body.can.force || !body.can.kernel)) {
    throw InputError(fmt::format("joins body '{}' ({}), which does not tell how its port gives way",
                                 body.name, body.model),
                     where, "Integrate the body in time.");
  }
}

int coarser_mesh(const std::array<Side, 2>& sides, const Bodies& bodies) {
  const auto spacing = [&](std::size_t s) { return bodies.port(sides[s]).geometry.spacing; };
  return bodies.side_of_less(sides, -spacing(0), -spacing(1));
}

/// The side of longer steps has the force: on the other one energy would be kept and the motion
/// wrong.
int coarser_steps(const std::array<Side, 2>& sides, const Bodies& bodies) {
  double step[2];
  for (const std::size_t s : {0u, 1u}) {
    const Description& body = bodies.describe(sides[s].body);
    step[s] = std::isinf(body.mass) ? 0.0 : body.step > 0.0 ? body.step : bodies.window();
  }
  if (!nearly_equal(step[0], step[1])) return step[0] > step[1] ? 0 : 1;
  return coarser_mesh(sides, bodies);
}

/// The side of the coarser mesh has the rows. What does not deform has none where the other does:
/// the nodes that it meets would be free between its own.
int side_of_rows(const std::array<Side, 2>& sides, const Bodies& bodies) {
  bool rigid[2];
  for (const std::size_t s : {0u, 1u}) {
    const bool stands = std::isinf(bodies.describe(sides[s].body).mass);
    rigid[s] = stands || bodies.port(sides[s]).geometry.transit == 0.0;
  }
  if (rigid[0] != rigid[1]) return rigid[0] ? 1 : 0;
  return coarser_mesh(sides, bodies);
}

void check_faces_overlap(const InterfaceSpec& spec,
                         const std::array<const PortGeometry*, 2>& faces) {
  for (const std::size_t s : {0u, 1u}) {
    if (faces[s]->embedded > 0) continue;
    throw InputError(fmt::format("body of {} does not tell how it moves where side {} is inside it",
                                 spec.sides[s], spec.sides[1 - s]),
                     "interfaces." + spec.name + ".tied.overlap",
                     "Give both bodies model: {fe: ...}, and a port on a side of their meshes.");
  }
}

/// Each side as a dashpot of the other: for comparisons, since it loses what one side's mesh or
/// steps cannot follow of the other's.
void check_robin(const InterfaceSpec& spec, const RobinTransmission& robin,
                 const std::array<Side, 2>& sides, const Bodies& bodies) {
  const std::string where = "interfaces." + spec.name;
  if (spec.tied->overlap) {
    throw InputError("is of sides that meet, not of bodies that overlap",
                     where + ".transmission.robin", "Leave transmission out.");
  }
  if (robin.number == 0.0) {
    throw InputError(
        fmt::format("is {}, which is found for ends of bars only", robin.impedance),
        where + ".transmission.robin.impedance",
        "Give a number for the whole face, in kg/s: density x wave speed x area of the "
        "softer side, for instance.");
  }
  for (const Side& side : sides) {
    const Description& body = bodies.describe(side.body);
    if (!body.quasi_static) continue;
    throw InputError(
        fmt::format("joins body '{}', which has no inertia, by an impedance", body.name),
        where + ".transmission.robin", "Leave transmission out.");
  }
}

std::unique_ptr<Tie> make_tie(const InterfaceSpec& spec, const std::array<Side, 2>& sides,
                              const Bodies& bodies) {
  const PortGeometry& one = bodies.port(sides[0]).geometry;
  const PortGeometry& other = bodies.port(sides[1]).geometry;
  if (const auto* robin = std::get_if<RobinTransmission>(&spec.transmission))
    return make_dashpot_tie(one, other, robin->number);
  const std::optional<OverlapSpec>& overlap = spec.tied->overlap;
  if (!overlap)
    return std::make_unique<Tie>(make_tie_rows(one, other, side_of_rows(sides, bodies)));
  if (!overlap->motions) return std::make_unique<Tie>(make_overlap_rows(one, other));
  TieRows rows = make_motion_rows(one, other);
  if (overlap->alternating) return std::make_unique<AlternatingTie>(std::move(rows));
  return std::make_unique<Tie>(std::move(rows), EnergyAccount::doubled);
}

}  // namespace

Joint make_tied_joint(const InterfaceSpec& spec, std::array<Side, 2> sides, const Bodies& bodies) {
  const std::string where = "interfaces." + spec.name;
  const auto* robin = std::get_if<RobinTransmission>(&spec.transmission);
  if (robin != nullptr) {
    check_robin(spec, *robin, sides, bodies);
  } else if (!std::holds_alternative<UnilateralTransmission>(spec.transmission)) {
    throw InputError("is of ends of bars only: tied surfaces have a rule of their own",
                     where + ".transmission",
                     "Leave transmission out, or give robin, for comparisons.");
  }
  std::array<const PortGeometry*, 2> faces;
  for (const std::size_t s : {0u, 1u}) {
    faces[s] = &bodies.port(sides[s]).geometry;
    check_side(bodies.describe(sides[s].body), *faces[s], spec.sides[s], where);
  }
  if (std::isinf(bodies.describe(sides[0].body).mass) &&
      std::isinf(bodies.describe(sides[1].body).mass)) {
    throw InputError("ties two bodies that nothing moves", where, "Take the interface out.");
  }
  if (faces[0]->round != faces[1]->round) {
    throw InputError("ties a plane surface to one of rings", where,
                     "Give both bodies plane: axisymmetric, or none.");
  }
  if (spec.tied->overlap) check_faces_overlap(spec, faces);
  std::unique_ptr<Tie> tie = make_tie(spec, sides, bodies);
  const TieRows& rows = tie->rows();
  const double most = unlike_meshes_gap * std::max(faces[0]->spacing, faces[1]->spacing);
  if (rows.count() == 0) {
    throw InputError(fmt::format("joins {} and {}, which do not face each other anywhere",
                                 spec.sides[0], spec.sides[1]),
                     where + ".tied", "Move a body with initial.position until its side meets.");
  }
  if (rows.apart > most) {
    throw InputError(fmt::format("its sides are {:g} m apart at ({:g}), more than a quarter of a "
                                 "facet",
                                 rows.apart, fmt::join(rows.place, ", ")),
                     where + ".tied",
                     "Move a body with initial.position until its side meets the other.");
  }
  Joint joint;
  joint.name = spec.name;
  joint.sides = sides;
  const int coarser = coarser_steps(sides, bodies);
  joint.role.kinematic = spec.tied->finer ? 1 - coarser : coarser;
  joint.role.fixed = true;
  joint.line.normal = {1.0, -1.0};
  joint.watch = std::make_unique<TieWatch>(*tie);
  joint.exchange = std::move(tie);
  return joint;
}

void check_still_contact(std::span<const Joint> joints, bool everything, const Bodies& bodies) {
  const KnownExchanges known = known_exchanges(joints);
  const auto ties = [&known](int body, int port) {  // -1: any port
    return std::ranges::any_of(known.ties, [body, port](const auto& tied) {
      return std::ranges::any_of(tied.joint->sides, [body, port](const Side& side) {
        return side.body == body && (port < 0 || side.port == port);
      });
    });
  };
  const auto refuse = [&bodies](int body, const std::string& where) {
    throw InputError(
        fmt::format("lets body '{}' touch, which has no inertia and is tied: contact and ties of "
                    "such bodies together are not iterated to what is right",
                    bodies.describe(body).name),
        where,
        "Integrate the body in time (newmark), or make it one mesh with what it is tied to.");
  };
  for (const auto& [joint, contact, part] : known.obstacles)
    for (const Side& side : joint->sides)
      if (bodies.describe(side.body).quasi_static && ties(side.body, -1))
        refuse(side.body, "interfaces." + joint->name);
  for (int b = 0; everything && b < bodies.count(); ++b) {
    const Description& body = bodies.describe(b);
    if (!body.quasi_static || !ties(b, -1)) continue;
    for (int p = 0; p < static_cast<int>(body.ports.size()); ++p)
      if (!ties(b, p)) refuse(b, "contact.everything");
  }
}

}  // namespace abut
