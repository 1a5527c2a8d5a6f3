#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/make/adjust.hpp"
#include "subdomain_solver/make/fields.hpp"
#include "subdomain_solver/make/makers.hpp"
#include "subdomain_solver/make/mass_range.hpp"
#include "subdomain_solver/make/material.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/scheme.hpp"
#include "subdomain_solver/rigid/rigid_fit.hpp"
#include "subdomain_solver/rigid/rigid_motion.hpp"
#include "subdomain_solver/solid_interior.hpp"

namespace abut {

namespace {

/// Of the size of a field and its body: what expressions with numbers of sixteen digits may lose.
constexpr double rigid_within = 1.0e-12;

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (double x : values) most = std::max(most, std::abs(x));
  return most;
}

void require_rigid(double distance, double size, const char* unit, const std::string& where) {
  if (distance <= rigid_within * size) return;
  throw InputError(fmt::format("is no rigid motion: the nearest one differs from it by {:.3g} {}",
                               distance, unit),
                   where,
                   "Give a translation and a rotation of the whole body, with all digits, or use "
                   "model fe.");
}

/// The start of the mesh's nodes as that of a rigid body.
Motion rigid_start(const Motion& nodes, const FeModel& mesh, MassForm form, const RigidModel& body,
                   const Place& place) {
  Pose pose;
  const double extent = largest(mesh.mesh().points);
  if (largest(nodes.q) > 0.0) {
    const PoseFit fit = fit_pose(body, mesh, nodes.q);
    require_rigid(fit.distance, extent + largest(nodes.q), "m",
                  place.where("initial.displacement_field"));
    pose = fit.pose;
  }
  const TwistFit fit = fit_twist(body, mesh, mass_matrix(mesh, form), pose, nodes.v);
  require_rigid(fit.distance, largest(nodes.v), "m/s", place.where("initial.velocity_field"));
  Motion start;
  start.q = body.coordinates(pose);
  start.v = body.rates(pose, fit.twist);
  return start;
}

}  // namespace

std::unique_ptr<Interior> make_rigid(const BodySpec& spec, const Place& place) {
  const RigidModelSpec& model = std::get<RigidModelSpec>(spec.model);
  const RigidMotionSpec& integrator = std::get<RigidMotionSpec>(*spec.integrator);
  std::vector<std::string> notes;
  Mesh mesh = make_mesh(model, spec.initial.position, place, "model.rigid", &notes);
  name_points(spec, place, mesh);
  const std::vector<SolidInterior::PortNodes> ports = make_ports(spec, place, mesh);
  const std::string adjusted = adjust_ports(spec, place, ports, {}, mesh);
  SolidInterior::Parts parts;
  FeOptions options;
  options.plane = model.plane;
  options.thickness = model.thickness;
  options.area = model.area();
  parts.model = std::make_unique<FeModel>(
      std::move(mesh), make_material(*spec.material, place, model.dimension), options);
  const FeModel& nodes = *parts.model;
  check_mass(nodes.lumped_mass().minCoeff(), nodes.lumped_mass().maxCoeff(), spec, place);
  std::unique_ptr<RigidModel> body = std::make_unique<RigidModel>(nodes, integrator.mass);
  parts.map = std::make_unique<RigidMap>(*body, nodes.mesh());
  parts.problem = std::make_unique<Problem>();
  parts.body_acceleration = body_acceleration(spec, place, nodes.mesh().dim);
  parts.problem->model = body.get();
  const std::size_t nodal = index(nodes.dofs());
  for (std::unique_ptr<Load>& load : make_loads(spec, place, nodes))
    parts.problem->loads.push_back(
        std::make_unique<LiftedLoad>(std::move(load), *parts.map, nodal));
  parts.motion =
      rigid_start(initial_motion(spec, place, nodes), nodes, integrator.mass, *body, place);
  parts.scheme = {std::make_unique<RigidMotion>(*parts.problem, *body), integrator.step,
                  std::numeric_limits<double>::infinity(), integrator.mass,
                  fmt::format("exact free motion, step {:g} s", integrator.step)};
  parts.rigid = body.get();
  parts.reduced = std::move(body);
  parts.rung = "rigid" + on_file(model, notes) + adjusted;
  parts.deforms = false;
  return std::make_unique<SolidInterior>(place.name(), std::move(parts), ports);
}

}  // namespace abut
