#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/one_each.hpp"
#include "subdomain_solver/fe/highest_frequency.hpp"
#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/make/adjust.hpp"
#include "subdomain_solver/make/constraints.hpp"
#include "subdomain_solver/make/fields.hpp"
#include "subdomain_solver/make/makers.hpp"
#include "subdomain_solver/make/mass_range.hpp"
#include "subdomain_solver/make/material.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/overlap.hpp"
#include "subdomain_solver/make/scheme.hpp"
#include "subdomain_solver/make/statics.hpp"
#include "subdomain_solver/place.hpp"
#include "subdomain_solver/port_geometry.hpp"
#include "subdomain_solver/solid_interior.hpp"

namespace abut {

namespace {

/// Components of a unit normal below this are the rounding of an axis.
constexpr double straight_motion = 1.0e-9;

/// Direction without mass [M.97] at the nodes of a flat side along an axis: its normal's.
int only_direction(const FeModel& model, const std::string& side,
                   std::span<const std::int32_t> nodes, const Place& place) {
  const int dim = model.mesh().dim;
  const std::vector<double> normals =
      port_geometry(model, side, {nodes.begin(), nodes.end()}).normals;
  int found = -1;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const int direction = static_cast<int>(v) % dim;
    if (std::abs(normals[v]) < straight_motion) continue;
    if (found < 0) found = direction;
    if (direction == found) continue;
    throw InputError("is normal, but side '" + side + "' is not flat along an axis",
                     place.where("contact_layer.massless.directions"),
                     "Leave directions out, or turn the mesh.");
  }
  return found;
}

/// Coordinates of the contact layer: of nodes at which ports may touch. Nodes that are held wholly
/// keep their mass, and so do node sets: nothing touches them.
std::vector<int> layer_coordinates(const FeModel& model, const BodySpec& spec,
                                   const std::vector<SolidInterior::PortNodes>& ports,
                                   const Constraints& constraints, const Place& place) {
  std::vector<int> dofs;
  const Mesh& mesh = model.mesh();
  if (spec.integrates(SchemeKind::statics)) return dofs;
  const auto* layer = std::get_if<MasslessSpec>(&spec.contact_layer);
  const bool normal_alone = layer != nullptr && layer->normal_alone;
  if (normal_alone && !constraints.frames.empty()) {
    throw InputError("is normal beside supports along inclined sides",
                     place.where("contact_layer.massless.directions"), "Leave directions out.");
  }
  std::vector<int> held(index(mesh.node_count()), 0);
  for (const Prescribed& p : constraints.supports) ++held[p.dof / mesh.dim];
  for (const SolidInterior::PortNodes& port : ports) {
    if (!port.touched || !mesh.sides.contains(port.side)) continue;
    const auto& nodes = mesh.nodes_of(port.side);
    const int only = normal_alone ? only_direction(model, port.side, nodes, place) : -1;
    for (const std::int32_t node : nodes)
      for (int i = 0; held[node] < mesh.dim && i < mesh.dim; ++i)
        if (only < 0 || i == only) dofs.push_back(node * mesh.dim + i);
  }
  keep_one_each(dofs);
  return dofs;
}

/// Of the moments of inertia: a surface without mass that would leave less of them keeps its mass.
/// A blow beside the centre turns a body by what is left of them, seven times as fast, and where it
/// goes passively nearly all of its spin is lost.
constexpr double least_inertia = 0.15;

/// Whether the surface is free of mass now. One that cannot be, of a body one element across for
/// instance, keeps it, unless the scene asks for its layer. Bars have no passive form.
bool give_layer(FeModel& model, std::vector<int> layer, const std::vector<int>& held,
                const BodySpec& spec, const Place& place) {
  if (std::holds_alternative<MassiveSpec>(spec.contact_layer)) return false;
  const auto* massless = std::get_if<MasslessSpec>(&spec.contact_layer);
  const bool required = massless != nullptr && massless->required;
  // What has stood in statics stands on, and what is pressed in needs a layer.
  const bool anyway = required || spec.initial.after_statics || spec.initial.interference;
  try {
    model.make_massless(std::move(layer), held, anyway ? 0.0 : least_inertia);
    return true;
  } catch (const InputError& error) {
    if (model.mesh().dim > 1 && !required) return false;
    throw InputError(error.what_is_wrong, place.where("model.fe.mesh"), error.remedy);
  }
}

/// [s] in which wanted interference grows.
std::optional<double> interference_of(const BodySpec& spec, bool massive_surface,
                                      const Place& place) {
  if (!spec.initial.interference) return std::nullopt;
  const double over = spec.initial.interference->over;
  if (massive_surface)
    throw InputError(
        "is of a body whose surface has mass: its contact is in the passive form, "
        "which presses nothing in",
        place.where("initial.interference"),
        "Use a finer mesh, or give the key to the body that it is pressed into.");
  if (over == 0.0 && !spec.integrates(SchemeKind::statics) && !spec.initial.after_statics)
    throw InputError(
        "is 0, but the body has inertia, which an overlap that is there at once "
        "would strike",
        place.where("initial.interference.over"),
        "Give a time of many steps, some periods of the body, or let a stage of statics take it.");
  return over;
}

std::string pressed_in_words(double over, bool statics) {
  if (over == 0.0) return statics ? ", pressed in at once" : ", pressed in by statics before";
  return fmt::format(", pressed in over {:g} s, {}", over,
                     statics ? "or at once where it goes passively" : "without a passive form");
}

/// The form of a surface that may touch, and what its mass, further inside, leaves of the inertia.
std::string massless_words(const FeModel& model) {
  std::string words = ", its surface has no mass where it may touch";
  if (model.inertia_left() < 1.0)
    words += fmt::format(", which leaves {:.0f} % of its moments of inertia",
                         100.0 * model.inertia_left());
  return words;
}

}  // namespace

std::unique_ptr<Interior> make_solid(const BodySpec& spec, const Place& place) {
  const FeModelSpec& fe = std::get<FeModelSpec>(spec.model);
  std::vector<std::string> notes;
  Mesh mesh = make_mesh(fe, spec.initial.position, place, "model.fe", &notes);
  name_points(spec, place, mesh);
  std::vector<SolidInterior::PortNodes> ports = make_ports(spec, place, mesh);
  Constraints constraints = make_constraints(spec, place, mesh);
  const std::string adjusted = adjust_ports(spec, place, ports, constraints, mesh);
  overlap_partners(spec, place, mesh, ports);
  check_formulation(fe, mesh, place, "model.fe");
  const bool explicit_in_time = spec.integrates(SchemeKind::explicit_steps);
  std::unique_ptr<const Material> material = make_material(*spec.material, place, fe.dimension);
  // Steps that solve equations have the matrix of a linear law; those with a history keep to one
  // way to compute force and tangent, as points rest on the edge of yielding.
  const bool batched =
      explicit_in_time || (!material->is_linear() && material->history_size() == 0);
  SolidInterior::Parts parts;
  parts.model = std::make_unique<FeModel>(std::move(mesh), std::move(material),
                                          FeOptions{fe.plane, fe.formulation, fe.thickness,
                                                    fe.hourglass, batched, fe.threads, fe.area()},
                                          constraints.frames);
  FeModel& model = *parts.model;
  check_mass(model.lumped_mass().minCoeff(), model.lumped_mass().maxCoeff(), spec, place);
  std::vector<int> layer = layer_coordinates(model, spec, ports, constraints, place);
  std::vector<int> held;  // coordinates, ascending
  for (const Prescribed& p : constraints.supports) held.push_back(p.dof);
  if (!layer.empty())
    parts.massive_surface = !give_layer(model, std::move(layer), held, spec, place);
  const bool touched =
      model.mesh().dim > 1 && std::ranges::any_of(ports, &SolidInterior::PortNodes::touched);
  const LooseMotions loose =
      check_statics(spec, place, model, constraints.supports,
                    {std::ranges::any_of(ports, &SolidInterior::PortNodes::joined), touched});
  if (loose.stiffness == 0.0 && loose.motions.cols() > 0)
    parts.loose = translations_and_rotations(model, loose.motions);
  parts.pressed_over = interference_of(spec, parts.massive_surface, place);
  parts.map = std::make_unique<IdentityMap>();
  parts.problem = std::make_unique<Problem>();
  parts.body_acceleration = body_acceleration(spec, place, model.mesh().dim);
  parts.problem->model = &model;
  parts.problem->supports = std::move(constraints.supports);
  parts.problem->loads = make_loads(spec, place, model);
  parts.whole_loads = make_whole_loads(spec, place, model);
  parts.motion = initial_motion(spec, place, model);
  const auto limit = [&] {
    return stable_step(model, parts.motion.q, std::vector<double>(model.history_size(), 0.0));
  };
  parts.rung += on_file(fe, notes) + adjusted;
  if (parts.pressed_over)
    parts.rung += pressed_in_words(*parts.pressed_over, spec.integrates(SchemeKind::statics));
  if (parts.massive_surface)
    parts.rung += ", its surface has mass, lumped: contact in its passive form";
  else if (model.mesh().dim > 1 && !model.massless().empty())
    parts.rung += massless_words(model);
  if (const std::string why = spec.why_general(); !why.empty())
    parts.rung += " in place of the bars' own core, for " + why;
  MakeWatch watch;  // the tangent of linear bodies stays
  if (!model.is_linear()) watch = [&] { return std::make_unique<HighestFrequency>(model); };
  BodySpec stepped = spec;
  if (parts.massive_surface) stepped.lump_mass();
  parts.scheme = make_scheme(stepped, place, *parts.problem, ports, limit,
                             linear_choice(spec.equations, model, held, ports), watch, loose);
  if (!constraints.held.empty()) {
    parts.reactions = std::make_unique<NodalReactions>(
        model, *parts.problem, *parts.scheme.integrator, mass_matrix(model, parts.scheme.mass),
        parts.scheme.step, constraints.held);
    parts.constraints = std::move(constraints.held);
  }
  return std::make_unique<SolidInterior>(place.name(), std::move(parts), ports);
}

}  // namespace abut
