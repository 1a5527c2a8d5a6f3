#include "subdomain_solver/make/scheme.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "subdomain_solver/make/body_facts.hpp"
#include "subdomain_solver/make/material.hpp"
#include "subdomain_solver/time/drift_kick_drift.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "subdomain_solver/time/implicit_dynamics.hpp"
#include "subdomain_solver/time/quasi_static.hpp"
#include "subdomain_solver/time/stable_steps.hpp"

namespace abut {

namespace {

/// Of the stable limit, that a clamped step takes at most: finite strain may lower the limit a
/// little.
constexpr double clamped = 0.95;

struct SchemeMaker {
  const BodySpec& spec;
  const Place& place;
  const Problem& problem;
  bool joined;  // a port is
  bool alike;   // ... to bodies that integrate alike
  const std::function<double()>& stable_limit;
  const LinearChoice& linear;
  const MakeWatch& watch;
  const LooseMotions& loose;

  /// A stiffness or a density in other units has other stable steps.
  std::string doubts() const {
    if (!spec.material) return {};
    const FeModelSpec* fe = std::get_if<FeModelSpec>(&spec.model);
    const auto law = make_material(*spec.material, place, fe != nullptr ? fe->dimension : 3);
    return doubts_first({law->density(), law->moduli().youngs()}, place);
  }

  SolidInterior::Scheme operator()(const CentralDifferenceSpec& s) const {
    const double limit = stable_limit();
    const std::string key = "integrator.central_difference.step";
    if (std::isnan(limit)) {
      throw InputError("has no stable limit: an element is inverted by the initial displacement",
                       place.where(key), "Correct initial.displacement_field.");
    }
    if (s.step > limit && !s.clamp) {
      throw InputError(fmt::format("{:g} s is above the stable limit of {:g} s", s.step, limit),
                       place.where(key),
                       doubts() +
                           "Give a step of at most the limit, above_limit: clamp, or an implicit "
                           "integrator such as newmark.");
    }
    // A whole number of parts, so that they divide windows as the step does.
    const double parts = s.step > limit ? std::ceil(s.step / (clamped * limit)) : 1.0;
    const double step = s.step / parts;
    if (!(step > 0.0)) {
      throw InputError("has a stable limit of 0 s: stiffness over mass is beyond all numbers",
                       place.where(key),
                       "Give the material's constants in one consistent set of units.");
    }
    const bool drifts = joined && problem.model->massless().empty();
    std::unique_ptr<Integrator> steps;
    if (drifts) {
      steps = std::make_unique<DriftKickDrift>(problem, step);
    } else {
      steps = std::make_unique<ExplicitDynamics>(problem, step);
    }
    if (watch && std::isfinite(limit))
      steps = std::make_unique<StableSteps>(std::move(steps), watch(),
                                            StableSteps::Options{step, limit, s.clamp});
    return {std::move(steps), step, limit, MassForm::lumped,
            fmt::format("central difference{}, step {:.4g} s, stable limit {:.4g} s{}",
                        drifts ? " in drifts" : "", step, limit,
                        parts > 1.0 ? fmt::format(" ({:.10g} to one of the scene)", parts) : "")};
  }
  SolidInterior::Scheme operator()(const NewmarkSpec& s) const {
    return implicit(AlphaWeights::newmark(s.beta, s.gamma), s.step, s.mass, "newmark");
  }
  SolidInterior::Scheme operator()(const HhtAlphaSpec& s) const {
    return implicit(AlphaWeights::hht(s.alpha), s.step, s.mass, "HHT-alpha");
  }
  SolidInterior::Scheme operator()(const GeneralizedAlphaSpec& s) const {
    return implicit(AlphaWeights::spectral_radius(s.spectral_radius), s.step, s.mass,
                    "generalised alpha");
  }
  SolidInterior::Scheme operator()(const QuasiStaticSpec& s) const {
    const double held = loose.stiffness;
    return {std::make_unique<QuasiStatic>(
                problem,
                QuasiStatic::Options{newton(), s.halvings, loose.motions, held, loose.most, joined},
                linear.make(Pivots::with_digits)),
            s.step, std::numeric_limits<double>::infinity(), MassForm::lumped,
            fmt::format("quasi-static, step {:g} s{}{}", s.step, linear.words,
                        held > 0.0 ? fmt::format(", stabilised by {:.4g} N/m as contact alone "
                                                 "holds it",
                                                 held)
                                   : "")};
  }
  template <class Other>
  SolidInterior::Scheme operator()(const Other&) const {
    throw InputError(fmt::format("{} is not offered to a solid", Other::name),
                     place.where("integrator"), "Use newmark or central_difference.");
  }

  SolidInterior::Scheme implicit(const AlphaWeights& weights, double step, MassForm mass,
                                 const char* words) const {
    using Accelerations = ImplicitDynamics::Accelerations;
    Accelerations accelerations = Accelerations::balanced;
    if (joined && weights.is_trapezoidal()) accelerations = Accelerations::summed;
    if (joined && weights.gamma > 0.5 && alike) accelerations = Accelerations::steady;
    return {std::make_unique<ImplicitDynamics>(
                problem, ImplicitDynamics::Options{weights, mass, newton(), accelerations},
                linear.make(Pivots::every)),
            step, std::numeric_limits<double>::infinity(), mass,
            fmt::format("{}, step {:g} s{}", words, step, linear.words)};
  }
  NewtonOptions newton() const { return {spec.equations.tolerance, spec.equations.max_iterations}; }
};

}  // namespace

std::vector<SolidInterior::PortNodes> make_ports(const BodySpec& spec, const Place& place,
                                                 const Mesh& mesh) {
  std::vector<SolidInterior::PortNodes> ports;
  for (const auto& [name, port] : spec.ports) {
    const std::string& side = port.side;
    named(place, "ports." + name + ".side", [&] { return mesh.nodes_of(side); });
    const int end = mesh.dim == 1 ? spec.end_of(port.side) : -1;  // by a point's name too
    const PortRole role = spec.context.role(name);
    const bool touched = mesh.dim == 1 ? !port.tied : role.touches;
    const bool joined = role.tied && (mesh.dim > 1 || (port.tied && !role.alike));
    if (joined && touched) {
      throw InputError("is tied to one surface and touches another", place.where("ports." + name),
                       "Give the part that is tied a side and a port of its own.");
    }
    ports.push_back({name,
                     end < 0    ? port.side
                     : end == 0 ? "left"
                                : "right",
                     port.tied, touched, joined, role.alike});
  }
  return ports;
}

MassForm mass_form(const BodySpec::Integrator& integrator) {
  const auto find = [](const auto& scheme) {
    if constexpr (requires { scheme.mass; }) return scheme.mass;
    return MassForm::lumped;
  };
  return std::visit(find, integrator);
}

SolidInterior::Scheme make_scheme(const BodySpec& spec, const Place& place, const Problem& problem,
                                  const std::vector<SolidInterior::PortNodes>& ports,
                                  const std::function<double()>& stable_limit,
                                  const LinearChoice& linear, const MakeWatch& watch,
                                  const LooseMotions& loose) {
  const bool joined = std::ranges::any_of(ports, &SolidInterior::PortNodes::joined);
  const bool alike = std::ranges::all_of(ports, [&spec](const SolidInterior::PortNodes& port) {
    return spec.context.role(port.name).alike;
  });
  return std::visit(
      SchemeMaker{spec, place, problem, joined, alike, stable_limit, linear, watch, loose},
      *spec.integrator);
}

}  // namespace abut
