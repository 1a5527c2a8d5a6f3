#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "base/error.hpp"
#include "subdomain_solver/body_spec.hpp"
#include "subdomain_solver/expression.hpp"
#include "subdomain_solver/fe/exodus_file.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"
#include "subdomain_solver/fe/loads.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/make_material.hpp"
#include "subdomain_solver/solid_body.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "subdomain_solver/time/implicit_dynamics.hpp"
#include "subdomain_solver/time/motion_views.hpp"
#include "subdomain_solver/time/quasi_static.hpp"

namespace abut {

namespace {

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Of the stable limit, where a step is clamped: finite strain may lower the limit a little.
constexpr double clamped = 0.95;

struct Place {
  const Document& document;
  std::string path;

  std::string where(const std::string& key) const { return document.where(path + "." + key); }
};

template <std::size_t N>
std::array<double, N> array_of(const std::vector<double>& list) {
  std::array<double, N> out{};
  std::copy_n(list.begin(), N, out.begin());
  return out;
}

template <std::size_t N>
std::array<int, N> counts_of(const std::vector<double>& list) {
  std::array<int, N> out{};
  std::transform(list.begin(), list.end(), out.begin(),
                 [](double x) { return static_cast<int>(std::lround(x)); });
  return out;
}

Origin origin_of(bool centred) { return centred ? Origin::centre : Origin::corner; }

struct MeshMaker {
  const Place& place;

  Mesh operator()(const BarMeshSpec&) const { return {}; }  // a bar is no solid
  Mesh operator()(const RectangleSpec& s) const {
    return generate(RectangleMesh{{},
                                  origin_of(s.centred),
                                  array_of<2>(s.lengths),
                                  counts_of<2>(s.elements),
                                  array_of<2>(s.grading),
                                  s.element},
                    place.where("model.fe.mesh.rectangle"));
  }
  Mesh operator()(const DiskSpec& s) const {
    return generate(DiskMesh{{}, s.radius, s.core, s.layers, s.element},
                    place.where("model.fe.mesh.disk"));
  }
  Mesh operator()(const BoxSpec& s) const {
    return generate(BoxMesh{{},
                            origin_of(s.centred),
                            array_of<3>(s.lengths),
                            counts_of<3>(s.elements),
                            array_of<3>(s.grading),
                            s.element},
                    place.where("model.fe.mesh.box"));
  }
  Mesh operator()(const CylinderSpec& s) const {
    return generate(CylinderMesh{{},
                                 origin_of(s.centred),
                                 s.radius,
                                 s.length,
                                 s.core,
                                 s.layers,
                                 s.elements,
                                 s.grading,
                                 s.element},
                    place.where("model.fe.mesh.cylinder"));
  }
  Mesh operator()(const SphereSpec& s) const {
    return generate(SphereMesh{{}, s.radius, s.core, s.layers, s.element},
                    place.where("model.fe.mesh.sphere"));
  }
  Mesh operator()(const GmshSpec& s) const {
    return told_of("gmsh", [&s] { return read_gmsh(s.file, s.scale); });
  }
  Mesh operator()(const ExodusSpec& s) const {
    return told_of("exodus", [&s] { return read_exodus(s.file, s.scale); });
  }

  /// An error of the mesh file, with the scene's key before the file's own place.
  template <class Read>
  Mesh told_of(const char* kind, Read read) const {
    try {
      return read();
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", error.where, error.what_is_wrong),
                       place.where(fmt::format("model.fe.mesh.{}.file", kind)), error.remedy);
    }
  }
};

Mesh make_mesh(const BodySpec& spec, const Place& place) {
  const FeModelSpec& fe = std::get<FeModelSpec>(spec.model);
  Mesh mesh = std::visit(MeshMaker{place}, fe.mesh);
  check_mesh(mesh, place.where("model.fe.mesh"));
  if (mesh.dim != fe.dimension) {
    throw InputError(fmt::format("is {}, but the mesh has {} dimensions", fe.dimension, mesh.dim),
                     place.where("model.fe.dimension"), "Give the dimension of the mesh.");
  }
  if (spec.initial.position.size() == index(mesh.dim)) {
    for (std::size_t k = 0; k < mesh.points.size(); ++k)
      mesh.points[k] += spec.initial.position[k % index(mesh.dim)];
  }
  for (std::size_t k = 0; k < mesh.points.size() && fe.plane == Plane::axisymmetric; k += 2) {
    if (mesh.points[k] < 0.0) {
      throw InputError("axisymmetric, but a node has a negative radius x",
                       place.where("model.fe.plane"), "Put the body at x >= 0.");
    }
  }
  return mesh;
}

/// An InputError of the mesh about a name, told of the scene's key.
template <class Call>
auto named(const Place& place, const std::string& key, Call call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw InputError(error.what_is_wrong, place.where(key), error.remedy);
  }
}

/// One expression per dimension; an empty list is no field.
VectorField field_of(const std::vector<std::string>& texts, int dim, const std::string& where) {
  if (texts.size() != index(dim)) {
    throw InputError(fmt::format("has {} expressions", texts.size()), where,
                     fmt::format("Give {} expressions, one per dimension.", dim));
  }
  VectorField field;
  for (int i = 0; i < dim; ++i) field[index(i)] = expression(texts[index(i)], where);
  return field;
}

std::array<double, 3> position_of(const Mesh& mesh, std::int32_t node) {
  std::array<double, 3> at = {0.0, 0.0, 0.0};
  for (int i = 0; i < mesh.dim; ++i) at[index(i)] = mesh.points[index(node * mesh.dim + i)];
  return at;
}

/// An orthonormal frame whose first axis is along a direction.
Matrix3 frame_along(const std::vector<double>& direction) {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < direction.size(); ++i)
    first(static_cast<Eigen::Index>(i)) = direction[i];
  first.normalize();
  Matrix3 axes;
  if (direction.size() == 2) {
    axes << first(0), -first(1), 0.0, first(1), first(0), 0.0, 0.0, 0.0, 1.0;
    return axes;
  }
  Eigen::Index least = 0;
  first.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d second = (Eigen::Vector3d::Unit(least) - first(least) * first).normalized();
  const Eigen::Vector3d third(first(1) * second(2) - first(2) * second(1),
                              first(2) * second(0) - first(0) * second(2),
                              first(0) * second(1) - first(1) * second(0));
  axes << first, second, third;
  return axes;
}

/// Prescribed coordinates and the frames that inclined ones need.
struct Constraints {
  std::vector<Prescribed> supports;
  std::vector<NodeFrame> frames;
};

class ConstraintMaker {
 public:
  ConstraintMaker(const Mesh& mesh, const Place& place) : mesh_(mesh), place_(place) {}

  void add(const std::string& name, const ConstraintSpec& spec) {
    const std::string key = "constraints." + name;
    const std::vector<std::int32_t> nodes =
        named(place_, key + ".on", [&] { return mesh_.nodes_of(spec.on); });
    if (!spec.direction.empty()) return add_inclined(spec, key, nodes);
    const std::string* texts[] = {&spec.x, &spec.y, &spec.z};
    constexpr const char* names[] = {".x", ".y", ".z"};
    for (int i = 0; i < 3; ++i) {
      const std::string& text = spec.fixed ? zero_ : *texts[i];
      if (text.empty() || (spec.fixed && i >= mesh_.dim)) continue;
      if (i >= mesh_.dim) {
        throw InputError("is a direction that the body does not have", place_.where(key + names[i]),
                         "Leave it out.");
      }
      const ScalarField value = expression(text, place_.where(key + (spec.fixed ? "" : names[i])));
      for (std::int32_t node : nodes) prescribe(node, i, value, key);
    }
  }

  Constraints take() {
    std::sort(made_.supports.begin(), made_.supports.end(),
              [](const Prescribed& a, const Prescribed& b) { return a.dof < b.dof; });
    return std::move(made_);
  }

 private:
  void prescribe(std::int32_t node, int direction, const ScalarField& value,
                 const std::string& key) {
    const int dof = node * mesh_.dim + direction;
    const std::array<double, 3> at = position_of(mesh_, node);
    const auto [place, fresh] = by_dof_.emplace(dof, made_.supports.size());
    if (!fresh) {
      // Sides that meet share nodes: what both prescribe must agree, and is kept once.
      const double before = made_.supports[place->second].value(0.0), now = value(at, 0.0);
      if (std::abs(before - now) <= 1.0e-12 * std::max(std::abs(before), std::abs(now))) return;
      throw InputError(
          fmt::format("prescribes {:g} m where another constraint prescribes {:g} m, at node {}",
                      now, before, node + 1),
          place_.where(key), "Let constraints of sides that meet agree where they meet.");
    }
    made_.supports.push_back({dof, [at, value](double time) { return value(at, time); }});
  }

  void add_inclined(const ConstraintSpec& spec, const std::string& key,
                    const std::vector<std::int32_t>& nodes) {
    double length = 0.0;
    for (double d : spec.direction) length = std::hypot(length, d);
    if (spec.direction.size() != index(mesh_.dim) || !(length > 0.0)) {
      throw InputError("is no direction of the body", place_.where(key + ".direction"),
                       fmt::format("Give {} numbers that are not all zero.", mesh_.dim));
    }
    const Matrix3 axes = frame_along(spec.direction);
    const ScalarField value = expression(spec.value, place_.where(key + ".value"));
    for (std::int32_t node : nodes) {
      const bool shared = std::any_of(made_.frames.begin(), made_.frames.end(),
                                      [node](const NodeFrame& f) { return f.node == node; });
      bool other = false;
      for (int i = 0; i < mesh_.dim; ++i) other = other || by_dof_.contains(node * mesh_.dim + i);
      if (shared || other) {
        throw InputError(
            fmt::format("and another constraint prescribe node {} in directions that differ",
                        node + 1),
            place_.where(key), "Let sides with a direction share no node with other constraints.");
      }
      made_.frames.push_back({node, axes});
      prescribe(node, 0, value, key);
    }
  }

  const Mesh& mesh_;
  const Place& place_;
  const std::string zero_ = "0";
  std::map<int, std::size_t> by_dof_;
  Constraints made_;
};

void add_loads(const BodySpec& spec, const Place& place, const FeModel& model, Problem& problem) {
  const int dim = model.mesh().dim;
  for (const auto& [name, load] : spec.loads) {
    const std::string key = "loads." + name;
    named(place, key + ".on", [&] {
      if (!load.on.empty()) (void)model.mesh().side(load.on);
      return 0;
    });
    if (!load.traction.empty()) {
      problem.loads.push_back(std::make_unique<Traction>(
          model, load.on, field_of(load.traction, dim, place.where(key + ".traction"))));
    } else if (!load.pressure.empty()) {
      problem.loads.push_back(std::make_unique<Pressure>(
          model, load.on, expression(load.pressure, place.where(key + ".pressure")), load.follows));
    } else {
      problem.loads.push_back(std::make_unique<BodyForce>(
          model, field_of(load.acceleration, dim, place.where(key + ".acceleration"))));
    }
  }
  if (spec.body_force.size() != index(dim)) return;
  VectorField uniform;
  for (int i = 0; i < dim; ++i)
    uniform[index(i)] = [b = spec.body_force[index(i)]](const std::array<double, 3>&, double) {
      return b;
    };
  problem.loads.push_back(std::make_unique<BodyForce>(model, std::move(uniform)));
}

struct SchemeMaker {
  const BodySpec& spec;
  const Place& place;
  const Problem& problem;
  FeModel& model;
  const Motion& motion;

  SolidBody::Scheme operator()(const CentralDifferenceSpec& s) const {
    const std::vector<double> history(model.history_size(), 0.0);
    const double limit = stable_step(model, motion.q, history);
    const std::string key = "integrator.central_difference.step";
    if (std::isnan(limit)) {
      throw InputError("has no stable limit: an element is inverted by the initial displacement",
                       place.where(key), "Correct initial.displacement_field.");
    }
    if (s.step > limit && !s.clamp) {
      throw InputError(fmt::format("{:g} s is above the stable limit of {:g} s", s.step, limit),
                       place.where(key),
                       "Give a step of at most the limit, above_limit: clamp, or an implicit "
                       "integrator such as newmark.");
    }
    const double step = s.step > limit ? clamped * limit : s.step;
    return {std::make_unique<ExplicitDynamics>(problem), step, limit, MassForm::lumped,
            fmt::format("central difference, step {:.4g} s, stable limit {:.4g} s{}", step, limit,
                        step < s.step ? " (clamped)" : "")};
  }
  SolidBody::Scheme operator()(const NewmarkSpec& s) const {
    return implicit(AlphaWeights::newmark(s.beta, s.gamma), s.step, s.mass, "newmark");
  }
  SolidBody::Scheme operator()(const HhtAlphaSpec& s) const {
    return implicit(AlphaWeights::hht(s.alpha), s.step, s.mass, "HHT-alpha");
  }
  SolidBody::Scheme operator()(const GeneralizedAlphaSpec& s) const {
    return implicit(AlphaWeights::spectral_radius(s.spectral_radius), s.step, s.mass,
                    "generalised alpha");
  }
  SolidBody::Scheme operator()(const QuasiStaticSpec& s) const {
    return {std::make_unique<QuasiStatic>(problem, QuasiStatic::Options{newton(), s.halvings},
                                          linear()),
            s.step, std::numeric_limits<double>::infinity(), MassForm::lumped,
            fmt::format("quasi-static, step {:g} s", s.step)};
  }
  SolidBody::Scheme operator()(const BackwardEulerSpec&) const { return {}; }  // refused before

  SolidBody::Scheme implicit(const AlphaWeights& weights, double step, MassForm mass,
                             const char* words) const {
    return {std::make_unique<ImplicitDynamics>(
                problem, ImplicitDynamics::Options{weights, mass, newton()}, linear()),
            step, std::numeric_limits<double>::infinity(), mass,
            fmt::format("{}, step {:g} s", words, step)};
  }
  NewtonOptions newton() const { return {spec.equations.tolerance, spec.equations.max_iterations}; }
  std::unique_ptr<LinearSolver> linear() const {
    if (const auto* cg = std::get_if<ConjugateGradientsSpec>(&spec.equations.linear))
      return make_conjugate_gradients(cg->tolerance);
    return make_direct_solver();
  }
};

/// Cells that the formulation has a form for.
void check_formulation(const FeModelSpec& fe, const Mesh& mesh, const Place& place) {
  for (const CellBlock& block : mesh.blocks) {
    if (fe.formulation != Formulation::one_point || block.element->order == 1) continue;
    throw InputError(fmt::format("one_point does not fit {}", block.element->name),
                     place.where("model.fe.formulation"),
                     "Use quad4 or hex8 with it, or formulation: full.");
  }
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
      to[k] += field[k % dim](position_of(mesh, static_cast<std::int32_t>(k / dim)), 0.0);
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

}  // namespace

std::unique_ptr<Subdomain> make_solid_body(const BodySpec& spec, const Document& document,
                                           const std::string& path,
                                           std::function<void()> progress) {
  const Place place{document, path};
  const FeModelSpec& fe = std::get<FeModelSpec>(spec.model);
  Mesh mesh = make_mesh(spec, place);
  std::vector<SolidBody::PortNodes> ports;
  for (const auto& [name, port] : spec.ports) {
    named(place, "ports." + name + ".side", [&] { return mesh.nodes_of(port.side); });
    ports.push_back({name, port.side});
  }
  ConstraintMaker constraints(mesh, place);
  for (const auto& [name, constraint] : spec.constraints) {  // frames come last: they refuse others
    if (constraint.direction.empty()) constraints.add(name, constraint);
  }
  for (const auto& [name, constraint] : spec.constraints) {
    if (!constraint.direction.empty()) constraints.add(name, constraint);
  }
  Constraints made = constraints.take();
  check_formulation(fe, mesh, place);
  const bool explicit_in_time = std::holds_alternative<CentralDifferenceSpec>(*spec.integrator);
  SolidBody::Parts parts;
  parts.model = std::make_unique<FeModel>(
      std::move(mesh), make_material(*spec.material, document, path + ".material"),
      FeOptions{fe.plane, fe.formulation, fe.thickness, fe.hourglass, explicit_in_time, fe.threads},
      made.frames);
  parts.problem = std::make_unique<Problem>();
  parts.problem->model = parts.model.get();
  parts.problem->supports = std::move(made.supports);
  add_loads(spec, place, *parts.model, *parts.problem);
  parts.motion = initial_motion(spec, place, *parts.model);
  parts.scheme = std::visit(SchemeMaker{spec, place, *parts.problem, *parts.model, parts.motion},
                            *spec.integrator);
  const std::string name = path.substr(path.rfind('.') + 1);
  std::unique_ptr<SolidBody> body = std::make_unique<SolidBody>(name, std::move(parts), ports);
  body->set_progress(std::move(progress));
  return body;
}

}  // namespace abut
