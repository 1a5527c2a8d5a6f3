#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "base/count.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"
#include "subdomain_solver/make/adjust.hpp"
#include "subdomain_solver/make/constraints.hpp"
#include "subdomain_solver/make/fields.hpp"
#include "subdomain_solver/make/makers.hpp"
#include "subdomain_solver/make/mass_range.hpp"
#include "subdomain_solver/make/material.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/scheme.hpp"
#include "subdomain_solver/make/statics.hpp"
#include "subdomain_solver/modal/modal_basis.hpp"
#include "subdomain_solver/modal/modal_map.hpp"
#include "subdomain_solver/modal/modal_model.hpp"
#include "subdomain_solver/modal/modal_reactions.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// Energy of the start beyond the modes, in parts of it, that is worth a word.
constexpr double told_share = 1.0e-6;
/// And that is worth a warning: 1 %.
constexpr double warned_share = 1.0e-2;

double hertz(double omega) { return omega / (2.0 * std::numbers::pi); }

WantedModes wanted_of(const ModalModelSpec& spec) {
  WantedModes wanted;
  if (spec.modes) {
    wanted.count = count_within(*spec.modes, 0, 1'000'000'000);
  } else {
    const double omega = 2.0 * std::numbers::pi * *spec.below;
    wanted.below = omega * omega;
  }
  return wanted;
}

std::vector<int> dofs_of(const Mesh& mesh, const std::vector<SolidInterior::PortNodes>& ports) {
  std::vector<int> out;
  for (const SolidInterior::PortNodes& port : ports) {
    for (std::int32_t node : mesh.nodes_of(port.side)) {
      for (int i = 0; i < mesh.dim; ++i) out.push_back(node * mesh.dim + i);
    }
  }
  keep_one_each(out);
  return out;
}

std::string words_of(const ModalBasis& basis) {
  std::string words =
      fmt::format("modal with {} coordinates ({} rigid, {} of ports, {} modes with fixed ports)",
                  basis.frequencies.size(), basis.rigid, basis.port_coordinates, basis.fixed_modes);
  if (basis.frequencies.size() > basis.rigid) {
    words += fmt::format(" from {:.5g} to {:.5g} Hz", hertz(basis.frequencies(basis.rigid)),
                         hertz(basis.frequencies.tail(1)(0)));
  }
  return words;
}

/// What a start loses to the modes, in words; empty: nothing.
std::string loss(const char* energy, double whole, double kept) {
  if (!(whole - kept > told_share * whole)) return "";
  const double part = (whole - kept) / whole;
  return fmt::format(", {}the modes leave out {:.3g} % of the start's {} energy",
                     part > warned_share ? "WARNING: " : "", 100.0 * part, energy);
}

double stored(Model& model, const std::vector<double>& q) {
  ModelResponse response;
  return model.evaluate(q, {}, Model::Want::force, response) ? response.stored : 0.0;
}

/// The start of the nodes in amplitudes of modes, projected in the mass [M.57]; `told_of` grows by
/// what is lost.
Motion modal_start(Motion nodes, const std::vector<Prescribed>& supports, const SparseMatrix& mass,
                   const ModalBasis& basis, FeModel& mesh, ModalModel& model,
                   std::string& told_of) {
  for (const Prescribed& p : supports) nodes.q[p.dof] = nodes.v[p.dof] = 0.0;
  Motion start;
  const Vector momentum = mass * view(nodes.v);
  store(basis.shapes.transpose() * (mass * view(nodes.q)), start.q);
  store(basis.shapes.transpose() * momentum, start.v);
  told_of += loss("kinetic", momentum.dot(view(nodes.v)), view(start.v).squaredNorm());
  told_of += loss("stored", stored(mesh, nodes.q), stored(model, start.q));
  return start;
}

}  // namespace

std::unique_ptr<Interior> make_modal(const BodySpec& spec, const Place& place) {
  const ModalModelSpec& modal = std::get<ModalModelSpec>(spec.model);
  std::vector<std::string> notes;
  Mesh mesh = make_mesh(modal, spec.initial.position, place, "model.modal", &notes);
  name_points(spec, place, mesh);
  const std::vector<SolidInterior::PortNodes> ports = make_ports(spec, place, mesh);
  const Constraints constraints = make_constraints(spec, place, mesh);
  const std::string adjusted = adjust_ports(spec, place, ports, constraints, mesh);
  check_formulation(modal, mesh, place, "model.modal");
  SolidInterior::Parts parts;
  parts.model = std::make_unique<FeModel>(std::move(mesh),
                                          make_material(*spec.material, place, modal.dimension),
                                          FeOptions{.plane = modal.plane,
                                                    .formulation = modal.formulation,
                                                    .thickness = modal.thickness,
                                                    .hourglass = modal.hourglass,
                                                    .area = modal.area()},
                                          constraints.frames);
  FeModel& nodes = *parts.model;
  check_mass(nodes.lumped_mass().minCoeff(), nodes.lumped_mass().maxCoeff(), spec, place);
  check_statics(spec, place, nodes, constraints.supports, {});
  std::vector<int> supports;
  for (const Prescribed& p : constraints.supports) supports.push_back(p.dof);
  // Modes after statics are those of the statics, whose state is in their amplitudes.
  BodySpec stepped = spec;
  if (spec.initial.after_statics) stepped.lump_mass();
  const MassForm form = mass_form(*stepped.integrator);
  const ModalBasis basis = reduce(nodes, supports, dofs_of(nodes.mesh(), ports), form,
                                  wanted_of(modal), place.where("model.modal"));
  if (basis.frequencies.size() == 0) {
    throw InputError("leaves no coordinate in which the body could move",
                     place.where("model.modal"), "Give more modes.");
  }
  for (const double omega : basis.frequencies) parts.frequencies.push_back(hertz(omega));
  std::unique_ptr<ModalModel> model = std::make_unique<ModalModel>(basis.frequencies);
  std::unique_ptr<ModalMap> map = std::make_unique<ModalMap>(basis.shapes);
  parts.problem = std::make_unique<Problem>();
  parts.body_acceleration = body_acceleration(spec, place, nodes.mesh().dim);
  parts.problem->model = model.get();
  const std::size_t nodal = index(nodes.dofs());
  for (std::unique_ptr<Load>& load : make_loads(spec, place, nodes))
    parts.problem->loads.push_back(std::make_unique<LiftedLoad>(std::move(load), *map, nodal));
  parts.rung = words_of(basis) + on_file(modal, notes) + adjusted;
  if (form != mass_form(*spec.integrator))
    parts.rung += ", of lumped mass as in the statics before";
  parts.motion = modal_start(initial_motion(spec, place, nodes), constraints.supports,
                             mass_matrix(nodes, form), basis, nodes, *model, parts.rung);
  parts.scheme = make_scheme(
      stepped, place, *parts.problem, ports, [&model] { return model->stable_step(); },
      linear_choice(spec.equations));
  parts.reduced = std::move(model);
  if (!constraints.held.empty()) {
    parts.reactions = std::make_unique<ModalReactions>(
        ModalReactions::Body{nodes, *map, *parts.scheme.integrator, mass_matrix(nodes, form),
                             parts.scheme.step, make_loads(spec, place, nodes)},
        supports, constraints.held, place.where("model.modal"));
    parts.constraints = constraints.held;
  }
  parts.map = std::move(map);
  return std::make_unique<SolidInterior>(place.name(), std::move(parts), ports);
}

}  // namespace abut
