#include "subdomain_solver/make/fields.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/counted.hpp"
#include "base/index.hpp"
#include "subdomain_solver/make/expression.hpp"
#include "subdomain_solver/make/scheme.hpp"

namespace abut {

VectorField field_of(const std::vector<std::string>& texts, int dim, const std::string& where) {
  if (texts.size() != index(dim)) {
    throw InputError("has " + counted(texts.size(), "expression"), where,
                     fmt::format("Give {} expressions, one per dimension.", dim));
  }
  VectorField field;
  for (int i = 0; i < dim; ++i) field[i] = expression(texts[i], where);
  return field;
}

double start_value(const ScalarField& field, const std::array<double, 3>& at, int dim,
                   const std::string& where) {
  const double value = field(at, 0.0);
  if (std::isfinite(value)) return value;
  throw InputError(
      fmt::format("has no value at ({:g}) m", fmt::join(at.data(), at.data() + dim, ", ")), where,
      "Give an expression with a value at every node of the body.");
}

std::array<double, 3> position_of(const Mesh& mesh, std::int32_t node) {
  std::array<double, 3> at = {0.0, 0.0, 0.0};
  for (int i = 0; i < mesh.dim; ++i) at[i] = mesh.points[node * mesh.dim + i];
  return at;
}

namespace {

/// Of body forces: that of the scheme, where it moves nodes. Modes and rigid motions take the
/// resultants of consistent ones, and statics has none of its own.
MassForm load_mass(const BodySpec& spec) {
  const bool moves_nodes =
      std::holds_alternative<FeModelSpec>(spec.model) && !spec.integrates(SchemeKind::statics);
  const bool lumped = spec.integrates(SchemeKind::explicit_steps);
  return moves_nodes || lumped ? mass_form(*spec.integrator) : MassForm::consistent;
}

/// `body_force` makes those that are proportional to mass.
template <class Make>
std::vector<std::unique_ptr<Load>> all_loads(const BodySpec& spec, const Place& place,
                                             const FeModel& model, const Make& body_force) {
  std::vector<std::unique_ptr<Load>> loads;
  const int dim = model.mesh().dim;
  for (const auto& entry : spec.loads) {
    const auto& load = entry.second;
    const std::string key = "loads." + entry.first;
    named(place, key + ".on", [&] {
      if (!load.on.empty()) (void)model.mesh().side(load.on);
      return 0;
    });
    if (!load.traction.empty()) {
      loads.push_back(std::make_unique<Traction>(
          model, load.on, field_of(load.traction, dim, place.where(key + ".traction"))));
    } else if (!load.pressure.empty()) {
      const ScalarField pressure = expression(load.pressure, place.where(key + ".pressure"));
      loads.push_back(named(place, key + ".follows", [&] {
        return std::make_unique<Pressure>(model, load.on, pressure, load.follows);
      }));
    } else {
      loads.push_back(
          body_force(field_of(load.acceleration, dim, place.where(key + ".acceleration"))));
    }
  }
  const bool weightless = std::all_of(spec.body_force.begin(), spec.body_force.end(),
                                      [](double b) { return b == 0.0; });
  if (weightless) return loads;
  VectorField uniform;
  for (int i = 0; i < dim; ++i)
    uniform[i] = [b = spec.body_force[i]](const std::array<double, 3>&, double) { return b; };
  loads.push_back(body_force(std::move(uniform)));
  return loads;
}

}  // namespace

std::vector<std::unique_ptr<Load>> make_loads(const BodySpec& spec, const Place& place,
                                              const FeModel& model) {
  // What stood under the weights of statics stands on under them: masses of a scheme, or of a
  // surface that gives its own to the nodes inside, would be others.
  const bool stood = spec.initial.after_statics && std::holds_alternative<FeModelSpec>(spec.model);
  return all_loads(spec, place, model, [&](VectorField acceleration) {
    return stood ? BodyForce::of_statics(model, std::move(acceleration))
                 : std::make_unique<BodyForce>(model, std::move(acceleration), load_mass(spec));
  });
}

std::vector<std::unique_ptr<Load>> make_whole_loads(const BodySpec& spec, const Place& place,
                                                    const FeModel& model) {
  return all_loads(spec, place, model, [&](VectorField acceleration) {
    return BodyForce::of_whole_mass(model, std::move(acceleration));
  });
}

std::function<double(double)> body_acceleration(const BodySpec& spec, const Place& place, int dim) {
  double square = 0.0;
  for (const double b : spec.body_force) square += b * b;
  std::vector<VectorField> fields;
  for (const auto& [name, load] : spec.loads)
    if (!load.acceleration.empty())
      fields.push_back(
          field_of(load.acceleration, dim, place.where("loads." + name + ".acceleration")));
  return [uniform = std::sqrt(square), fields, dim](double time) {
    double bound = uniform;
    for (const VectorField& field : fields) {
      std::array<double, 3> a{};
      for (int i = 0; i < dim; ++i) a[index(i)] = field[index(i)]({}, time);
      const double size = std::hypot(a[0], a[1], a[2]);
      if (std::isfinite(size)) bound += size;
    }
    return bound;
  };
}

/// Coordinates and velocities of the start, in the nodes' frames.
Motion initial_motion(const BodySpec& spec, const Place& place, const FeModel& model) {
  const Mesh& mesh = model.mesh();
  const std::size_t dim = index(mesh.dim);
  Motion motion;
  motion.q.assign(index(model.dofs()), 0.0);
  motion.v.assign(index(model.dofs()), 0.0);
  auto add = [&](const std::vector<std::string>& texts, const char* key, std::vector<double>& to) {
    if (texts.empty()) return;
    const VectorField field = field_of(texts, mesh.dim, place.where(key));
    for (std::size_t k = 0; k < to.size(); ++k)
      to[k] += start_value(field[k % dim], position_of(mesh, static_cast<std::int32_t>(k / dim)),
                           mesh.dim, place.where(key));
  };
  if (spec.initial.velocity.size() == dim) {
    for (std::size_t k = 0; k < motion.v.size(); ++k) motion.v[k] = spec.initial.velocity[k % dim];
  }
  add(spec.initial.displacement_field, "initial.displacement_field", motion.q);
  add(spec.initial.velocity_field, "initial.velocity_field", motion.v);
  model.to_frames(motion.q);
  model.to_frames(motion.v);
  return motion;
}

}  // namespace abut
