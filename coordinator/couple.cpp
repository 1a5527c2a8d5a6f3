#include "coordinator/couple.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/coupling/robin.hpp"
#include "coordinator/coupling/roles.hpp"

namespace abut {

namespace {

/// Of the coarser mesh: sides this near to each other coincide.
constexpr double coincidence = 1.0e-6;

Side find_side(const std::string& text, const Bodies& bodies, const std::string& where) {
  const std::size_t dot = text.find('.');
  for (int b = 0; b < bodies.count() && dot != std::string::npos; ++b) {
    const Description& body = bodies.describe(b);
    if (body.name != text.substr(0, dot)) continue;
    for (std::size_t p = 0; p < body.ports.size(); ++p) {
      if (body.ports[p].name == text.substr(dot + 1)) return {b, static_cast<int>(p)};
    }
  }
  throw InputError(fmt::format("'{}' is no port of any body", text), where, "Give body.port.");
}

int index_of(const InterfaceSpec& spec, const std::string& side, const std::string& where) {
  for (int s : {0, 1}) {
    if (spec.sides[index(s)] == side) return s;
  }
  throw InputError(fmt::format("'{}' is not a side of this interface", side), where,
                   fmt::format("Give {} or {}.", spec.sides[0], spec.sides[1]));
}

void require(bool able, const Description& body, const std::string& where, const std::string& what,
             const std::string& remedy) {
  if (!able) {
    throw InputError(fmt::format("body '{}' ({}) {}", body.name, body.model, what), where, remedy);
  }
}

/// A node whose mass both sides share has one motion only where both step alike: at other steps
/// roundings of the partner's path become accelerations that grow.
void check_shared_node(const InterfaceSpec& spec, const Bodies& bodies,
                       const Interface& interface) {
  const Description& a = bodies.describe(interface.sides[0].body);
  const Description& b = bodies.describe(interface.sides[1].body);
  const bool shared[] = {a.ports[index(interface.sides[0].port)].tied,
                         b.ports[index(interface.sides[1].port)].tied};
  if (!shared[0] && !shared[1]) return;
  const bool held = std::isinf(a.mass) || std::isinf(b.mass);
  const bool alike = a.step == b.step && std::isinf(a.stable_step) == std::isinf(b.stable_step);
  if (held || (shared[0] && shared[1] && alike)) return;
  throw InputError(
      "joins a port with tied: true to one of another kind of node, integrator or step",
      "interfaces." + spec.name + ".sides",
      "Make both ports tied: true and both bodies explicit or both implicit with one step, or take "
      "tied off both ports and give contact_layer: {massless: {stiffness_factor: 1}}.");
}

/// Sides of a tied interface are one as they stand: the rounding of their places is no gap.
void join(const InterfaceSpec& spec, const Bodies& bodies, Interface& interface) {
  double spacing = 0.0;
  for (const Side& side : interface.sides) {
    const Port& port = bodies.describe(side.body).ports[index(side.port)];
    spacing = std::max(spacing, port.geometry.spacing);
  }
  if (interface.reference_gap > coincidence * spacing) {
    throw InputError(fmt::format("its sides are {:g} m apart", interface.reference_gap),
                     "interfaces." + spec.name + ".tied",
                     "Move a body with initial.position until they coincide.");
  }
  interface.reference_gap = 0.0;
  check_shared_node(spec, bodies, interface);
}

void refuse_joints(const InterfaceSpec& spec, const Bodies& bodies, const Interface& interface) {
  for (const Side& side : interface.sides) {
    const Description& body = bodies.describe(side.body);
    const Port& port = body.ports[index(side.port)];
    if (!port.tied) continue;
    throw InputError(
        fmt::format("port '{}' of body '{}' is for tied interfaces", port.name, body.name),
        "interfaces." + spec.name + ".contact",
        "Give the interface tied: {}, or take tied off the port.");
  }
}

void add_unilateral(const InterfaceSpec& spec, const UnilateralTransmission& how, bool parallel,
                    Interface& interface, const Bodies& bodies, Coupling& coupling) {
  const std::string where = "interfaces." + spec.name;
  Coupling::Rule rule;
  for (const Side& side : interface.sides) {
    const Description& body = bodies.describe(side.body);
    require(body.can.complete && body.can.force, body, where,
            "cannot stand on a unilateral interface: its contact layer is massive",
            "Give the body contact_layer massless or kick, or the interface the transmission "
            "dirichlet_neumann.");
    require(body.can.kernel, body, where, "does not answer for its port kernel",
            "Use a body that offers the kernel.");
  }
  const bool able0 = bodies.describe(interface.sides[0].body).can.obstacle;
  const bool able1 = bodies.describe(interface.sides[1].body).can.obstacle;
  if (!able0 && !able1) {
    const Description& one = bodies.describe(interface.sides[0].body);
    const Description& other = bodies.describe(interface.sides[1].body);
    throw InputError(
        fmt::format(
            "joins '{}' ({}) and '{}' ({}), of which neither can follow the other's surface "
            "yet",
            one.name, one.model, other.name, other.model),
        where,
        "Make one side a bar of equal elements and linear_elastic material, without points, "
        "constraints, loads and fields.");
  }
  rule.role_fixed = how.kinematic != "auto";
  if (rule.role_fixed) {
    interface.kinematic =
        index_of(spec, how.kinematic, where + ".transmission.unilateral.kinematic");
    const Description& body = bodies.describe(interface.kinematic_side().body);
    require(body.can.obstacle, body, where + ".transmission.unilateral.kinematic",
            "takes forces only and cannot be the kinematic side", "Name the other side, or auto.");
  }
  if (parallel) {
    coupling.transmissions.push_back(std::make_unique<ParallelForce>());
  } else {
    coupling.transmissions.push_back(std::make_unique<Unilateral>());
  }
  coupling.rules.push_back(rule);
}

void add_published(const InterfaceSpec& spec, const DirichletNeumannTransmission& how,
                   const SchwarzSpec& schwarz, Interface& interface, const Bodies& bodies,
                   Coupling& coupling) {
  const std::string where = "interfaces." + spec.name + ".transmission.dirichlet_neumann";
  interface.kinematic = index_of(spec, how.dirichlet, where + ".dirichlet");
  for (int s : {0, 1}) {
    if (s != interface.kinematic && !how.swap_every_window) continue;
    const Description& body = bodies.describe(interface.sides[index(s)].body);
    require(body.can.motion, body, where, "does not take prescribed motion",
            "Give the body contact_layer: {massive: {}}.");
  }
  if (schwarz.parallel || std::holds_alternative<KernelAcceleration>(schwarz.accelerator)) {
    throw InputError(
        "the published form knows neither the parallel form nor port kernels", "schwarz",
        "Give form: alternating and an accelerator of none, relaxation, aitken or anderson.");
  }
  coupling.transmissions.push_back(std::make_unique<DirichletNeumann>(how.swap_every_window));
  coupling.rules.push_back(
      {.published = true, .swap = how.swap_every_window, .projection = how.impact_projection});
}

/// Ports of a body that solves its contact itself show it and take nothing.
void refuse_members(const Interface& interface, const Bodies& bodies, const std::string& where) {
  for (const Side& side : interface.sides) {
    const Description& body = bodies.describe(side.body);
    require(body.members.empty(), body, where, "solves its contact itself and takes nothing",
            "Join its two ports with transmission: {internal: {}}, or use single bars.");
  }
}

void add_robin(const InterfaceSpec& spec, const RobinTransmission& how, const SchwarzSpec& schwarz,
               Interface& interface, const Bodies& bodies, Coupling& coupling) {
  const std::string where = "interfaces." + spec.name + ".transmission.robin";
  for (const Side& side : interface.sides) {
    const Description& body = bodies.describe(side.body);
    require(body.can.impedance && body.can.complete && body.can.kernel, body, where,
            "does not take an impedance",
            "Give a bar contact_layer massless or kick, or the interface the transmission "
            "unilateral.");
  }
  if (std::holds_alternative<KernelAcceleration>(schwarz.accelerator)) {
    throw InputError("Robin conditions do not use port kernels as Jacobian", "schwarz.accelerator",
                     "Give an accelerator of none, relaxation, aitken or anderson.");
  }
  interface.kinematic = coarser_side(interface, bodies);
  const Robin::Rule rule = how.impedance == "matched"  ? Robin::Rule::matched
                           : how.impedance == "kernel" ? Robin::Rule::kernel
                                                       : Robin::Rule::given;
  coupling.transmissions.push_back(std::make_unique<Robin>(rule, how.number, schwarz.parallel));
  coupling.rules.push_back({});
}

}  // namespace

std::vector<Joint> Coupling::joints() {
  std::vector<Joint> joints;
  for (std::size_t i = 0; i < interfaces.size(); ++i)
    joints.push_back({&interfaces[i], transmissions[i].get()});
  return joints;
}

Coupling make_coupling(const Scene& scene, const Bodies& bodies) {
  Coupling coupling;
  for (const auto& [name, spec] : scene.interfaces) {
    const std::string where = "interfaces." + name + ".sides";
    const std::array<Side, 2> sides = {find_side(spec.sides[0], bodies, where),
                                       find_side(spec.sides[1], bodies, where)};
    Interface interface = make_interface(name, sides, bodies);
    if (std::holds_alternative<InternalTransmission>(spec.transmission)) {
      coupling.transmissions.push_back(nullptr);  // never closed for the iteration
      coupling.rules.push_back({.internal = true});
      coupling.interfaces.push_back(std::move(interface));
      continue;
    }
    refuse_members(interface, bodies, "interfaces." + name);
    if (spec.tied) {
      join(spec, bodies, interface);
    } else {
      refuse_joints(spec, bodies, interface);
    }
    if (const auto* unilateral = std::get_if<UnilateralTransmission>(&spec.transmission)) {
      add_unilateral(spec, *unilateral, scene.schwarz.parallel, interface, bodies, coupling);
    } else if (const auto* robin = std::get_if<RobinTransmission>(&spec.transmission)) {
      add_robin(spec, *robin, scene.schwarz, interface, bodies, coupling);
    } else {
      add_published(spec, std::get<DirichletNeumannTransmission>(spec.transmission), scene.schwarz,
                    interface, bodies, coupling);
    }
    coupling.rules.back().tied = interface.bilateral = spec.tied.has_value();
    coupling.interfaces.push_back(std::move(interface));
  }
  return coupling;
}

Schwarz make_schwarz(const SchwarzSpec& spec) {
  struct Maker {
    ApplyInverse inverse, probe;
    std::unique_ptr<Accelerator> operator()(const NoAcceleration&) const {
      return std::make_unique<Relaxation>(1.0);
    }
    std::unique_ptr<Accelerator> operator()(const FixedRelaxation& s) const {
      if (s.factor.probed()) return std::make_unique<Relaxation>(probe);
      return std::make_unique<Relaxation>(s.factor.value);
    }
    std::unique_ptr<Accelerator> operator()(const AitkenAcceleration& s) const {
      if (s.initial.probed()) return std::make_unique<Aitken>(probe);
      return std::make_unique<Aitken>(s.initial.value);
    }
    std::unique_ptr<Accelerator> operator()(const AndersonAcceleration& s) const {
      ApplyInverse relaxed = [factor = s.initial.value](const Eigen::VectorXd& r) {
        return Eigen::VectorXd(factor * r);
      };
      return std::make_unique<QuasiNewton>(s.initial.probed() ? probe : relaxed, s.reuse, s.filter,
                                           0);
    }
    std::unique_ptr<Accelerator> operator()(const KernelAcceleration& s) const {
      return std::make_unique<QuasiNewton>(inverse, s.reuse, s.filter, 1);
    }
  };
  struct UsesKernels {
    bool operator()(const NoAcceleration&) const { return false; }
    bool operator()(const FixedRelaxation& s) const { return s.factor.probed(); }
    bool operator()(const AitkenAcceleration& s) const { return s.initial.probed(); }
    bool operator()(const AndersonAcceleration& s) const { return s.initial.probed(); }
    bool operator()(const KernelAcceleration&) const { return true; }
  };
  const Schwarz::Options options{spec.max_iterations, spec.tolerance,
                                 std::visit(UsesKernels{}, spec.accelerator)};
  return Schwarz(options,
                 [accelerator = spec.accelerator](ApplyInverse inverse, ApplyInverse probe) {
                   return std::visit(Maker{std::move(inverse), std::move(probe)}, accelerator);
                 });
}

}  // namespace abut
