#include <algorithm>

#include <fmt/format.h>

#include "subdomain_solver/fe/highest_frequency.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/make/constraints.hpp"
#include "subdomain_solver/make/fields.hpp"
#include "subdomain_solver/make/makers.hpp"
#include "subdomain_solver/make/mass_range.hpp"
#include "subdomain_solver/make/material.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/scheme.hpp"
#include "subdomain_solver/place.hpp"
#include "subdomain_solver/solid_interior.hpp"

namespace abut {

namespace {

/// Nodes of the contact layer: those at which ports may touch. Nodes that are held wholly keep
/// their mass, and so do node sets: nothing touches them.
std::vector<std::int32_t> layer_nodes(const FeModel& model, const BodySpec& spec,
                                      const std::vector<SolidInterior::PortNodes>& ports,
                                      const std::vector<Prescribed>& supports) {
  std::vector<std::int32_t> nodes;
  const Mesh& mesh = model.mesh();
  if (std::holds_alternative<QuasiStaticSpec>(*spec.integrator)) return nodes;
  std::vector<int> held(index(mesh.node_count()), 0);
  for (const Prescribed& p : supports) ++held[index(p.dof / mesh.dim)];
  for (const SolidInterior::PortNodes& port : ports) {
    if (!port.touched || !mesh.sides.contains(port.side)) continue;
    for (const std::int32_t node : mesh.nodes_of(port.side))
      if (held[index(node)] < mesh.dim) nodes.push_back(node);
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

std::unique_ptr<Interior> make_solid(const BodySpec& spec, const Place& place) {
  const FeModelSpec& fe = std::get<FeModelSpec>(spec.model);
  Mesh mesh = make_mesh(fe, spec.initial.position, place, "model.fe");
  name_points(spec, place, mesh);
  const std::vector<SolidInterior::PortNodes> ports = make_ports(spec, place, mesh);
  Constraints constraints = make_constraints(spec, place, mesh);
  check_formulation(fe, mesh, place, "model.fe");
  const bool explicit_in_time = std::holds_alternative<CentralDifferenceSpec>(*spec.integrator);
  SolidInterior::Parts parts;
  parts.model = std::make_unique<FeModel>(
      std::move(mesh), make_material(*spec.material, place, fe.dimension),
      FeOptions{fe.plane, fe.formulation, fe.thickness, fe.hourglass, explicit_in_time, fe.threads,
                fe.area()},
      constraints.frames);
  FeModel& model = *parts.model;
  check_mass(model.lumped_mass().minCoeff(), model.lumped_mass().maxCoeff(), spec, place);
  if (fe.threads > 1 && model.threads() == nullptr) {
    throw InputError("have no effect: one thread computes the elements of this law or formulation",
                     place.where("model.fe.threads"), "Leave threads out.");
  }
  const std::vector<std::int32_t> layer = layer_nodes(model, spec, ports, constraints.supports);
  std::vector<int> held;  // coordinates, ascending
  for (const Prescribed& p : constraints.supports) held.push_back(p.dof);
  if (!layer.empty()) {
    named(place, "model.fe.mesh", [&] {
      model.make_massless(layer, held);
      return 0;
    });
  }
  check_statics(spec, place, model, constraints.supports);
  parts.map = std::make_unique<IdentityMap>();
  parts.problem = std::make_unique<Problem>();
  parts.problem->model = &model;
  parts.problem->supports = std::move(constraints.supports);
  parts.problem->loads = make_loads(spec, place, model);
  parts.motion = initial_motion(spec, place, model);
  const auto limit = [&] {
    return stable_step(model, parts.motion.q, std::vector<double>(model.history_size(), 0.0));
  };
  parts.rung += on_file(fe);
  if (const std::string why = spec.why_general(); !why.empty())
    parts.rung += " in place of the bars' own core, for " + why;
  MakeWatch watch;  // the tangent of linear bodies stays
  if (!model.is_linear()) watch = [&] { return std::make_unique<HighestFrequency>(model); };
  parts.scheme = make_scheme(spec, place, *parts.problem, limit, watch);
  if (!constraints.held.empty()) {
    parts.reactions = std::make_unique<NodalReactions>(
        model, *parts.problem, *parts.scheme.integrator, mass_matrix(model, parts.scheme.mass),
        parts.scheme.step, constraints.held);
    parts.constraints = std::move(constraints.held);
  }
  return std::make_unique<SolidInterior>(place.name(), std::move(parts), ports);
}

}  // namespace abut
