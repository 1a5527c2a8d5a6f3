#include "coordinator/couple.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "coordinator/coupling/robin.hpp"
#include "coordinator/coupling/roles.hpp"

namespace abut {

namespace {

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
    if (spec.sides[static_cast<std::size_t>(s)] == side) return s;
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
    throw InputError("neither side can be kinematic: both are rigid", where,
                     "Give one side a deformable body.");
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
    const Description& body = bodies.describe(interface.sides[static_cast<std::size_t>(s)].body);
    require(body.can.motion, body, where, "does not take prescribed motion",
            "Give the body contact_layer: {massive: {}}.");
  }
  if (schwarz.parallel || std::holds_alternative<KernelAcceleration>(schwarz.accelerator)) {
    throw InputError(
        "the published form knows neither the parallel form nor port kernels", "schwarz",
        "Give form: alternating and an accelerator of none, relaxation, aitken or anderson.");
  }
  coupling.transmissions.push_back(std::make_unique<DirichletNeumann>());
  coupling.rules.push_back({true, false, how.swap_every_window, true, how.impact_projection});
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
    if (const auto* unilateral = std::get_if<UnilateralTransmission>(&spec.transmission)) {
      add_unilateral(spec, *unilateral, scene.schwarz.parallel, interface, bodies, coupling);
    } else if (const auto* robin = std::get_if<RobinTransmission>(&spec.transmission)) {
      add_robin(spec, *robin, scene.schwarz, interface, bodies, coupling);
    } else {
      add_published(spec, std::get<DirichletNeumannTransmission>(spec.transmission), scene.schwarz,
                    interface, bodies, coupling);
    }
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
  const Schwarz::Options options{spec.max_iterations, spec.tolerance};
  return Schwarz(options, [accelerator = spec.accelerator](ApplyInverse inverse,
                                                            ApplyInverse probe) {
    return std::visit(Maker{std::move(inverse), std::move(probe)}, accelerator);
  });
}

}  // namespace abut
