#include <cmath>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/yaml_fields.hpp"
#include "subdomain_solver/bars/bar_interior.hpp"
#include "subdomain_solver/bars/central_difference.hpp"
#include "subdomain_solver/bars/generalized_alpha.hpp"
#include "subdomain_solver/body.hpp"
#include "subdomain_solver/fe/element_limit.hpp"
#include "subdomain_solver/make/bar_extras.hpp"
#include "subdomain_solver/make/body_facts.hpp"
#include "subdomain_solver/make/makers.hpp"
#include "subdomain_solver/make/mass_range.hpp"
#include "subdomain_solver/make/read_body.hpp"
#include "subdomain_solver/make/scheme.hpp"
#include "subdomain_solver/rigid/rigid_wall.hpp"

namespace abut {

namespace {

/// CFL 1 is exact and meant: a step may pass the limit by round-off.
constexpr double limit_slack = 1.0e-12;

[[noreturn]] void refuse(const Place& place, const std::string& key, const std::string& what,
                         const std::string& remedy) {
  throw InputError(what, place.where(key), remedy);
}

std::vector<BarInterior::End> ports_of(const BodySpec& spec, const Place& place) {
  std::vector<BarInterior::End> ports;
  for (const auto& [name, port] : spec.ports) {
    const int end = spec.end_of(port.side);
    const std::string key = "ports." + name + ".side";
    if (end < 0) {
      refuse(place, key, fmt::format("side '{}' does not exist", port.side),
             "Give left or right, the sides of this body.");
    }
    for (const BarInterior::End& other : ports) {
      if (other.end != end) continue;
      refuse(place, key, fmt::format("side '{}' is the port '{}' already", port.side, other.name),
             "Let each side be one port.");
    }
    ports.push_back({name, end, port.tied});
  }
  return ports;
}

ContactLayer layer_of(const BodySpec& spec, const PortSpec& port) {
  if (port.tied) {
    const bool kicked = spec.integrates(SchemeKind::explicit_steps);
    return kicked ? ContactLayer::kick : ContactLayer::shared;
  }
  constexpr ContactLayer layers[] = {ContactLayer::massless, ContactLayer::kick,
                                     ContactLayer::massive};
  return layers[spec.contact_layer.index()];
}

struct BarSchemeMaker {
  const Bar& bar;
  const Place& place;

  BarInterior::Scheme operator()(const CentralDifferenceSpec& s) const {
    const double limit = bar.stable_step();
    if (s.step > limit * (1.0 + limit_slack)) {
      refuse(place, "integrator.central_difference.step",
             fmt::format("{:g} s is above the stable limit of {:g} s", s.step, limit),
             doubts_first({bar.data().density, bar.data().youngs_modulus}, place) +
                 "Give a step of at most the limit, or an implicit integrator such as newmark.");
    }
    if (s.dispersion_terms > 1 && bar.data().elements < 2 * s.dispersion_terms + 2) {
      refuse(place, "integrator.central_difference.dispersion_terms",
             fmt::format("{} terms do not fit into {} elements", s.dispersion_terms,
                         bar.data().elements),
             fmt::format("Give at least {} elements or fewer terms.", 2 * s.dispersion_terms + 2));
    }
    std::string words = fmt::format("central difference, step {:g} s, CFL {:.3g}", s.step,
                                    s.step / (bar.spacing() / bar.data().wave_speed()));
    if (s.bulk_viscosity > 0.0) words += fmt::format(", bulk viscosity {:g}", s.bulk_viscosity);
    if (s.tchamwa > 1.0) words += fmt::format(", Tchamwa-Wielgosz {:g}", s.tchamwa);
    if (s.dispersion_terms > 1) words += fmt::format(", {} dispersion terms", s.dispersion_terms);
    return {std::make_unique<CentralDifference>(bar, s.step, s.dispersion_terms), s.step, true,
            words};
  }
  BarInterior::Scheme operator()(const NewmarkSpec& s) const {
    return implicit(AlphaWeights::newmark(s.beta, s.gamma), s.step, "newmark");
  }
  BarInterior::Scheme operator()(const HhtAlphaSpec& s) const {
    return implicit(AlphaWeights::hht(s.alpha), s.step, "HHT-alpha");
  }
  BarInterior::Scheme operator()(const GeneralizedAlphaSpec& s) const {
    return implicit(AlphaWeights::spectral_radius(s.spectral_radius), s.step, "generalised alpha");
  }
  template <class Other>
  BarInterior::Scheme operator()(const Other&) const {
    refuse(place, "integrator", fmt::format("{} is not offered to a bar", Other::name),
           "Use newmark or another implicit integrator.");
  }
  BarInterior::Scheme operator()(const BackwardEulerSpec&) const {
    refuse(place, "integrator", "backward_euler is offered to bar_pair only",
           "Use generalized_alpha: {spectral_radius: 0}, which damps as strongly.");
  }
  BarInterior::Scheme implicit(const AlphaWeights& weights, double step, const char* words) const {
    return {std::make_unique<GeneralizedAlpha>(bar, weights, step), step, false,
            fmt::format("{}, step {:g} s", words, step),
            weights.is_newmark() && weights.beta == 0.25 && weights.gamma == 0.5};
  }
};

void check_layers(const BodySpec& spec, const BarProperties& bar, const Place& place) {
  const bool explicit_scheme = spec.integrates(SchemeKind::explicit_steps);
  if (bar.complete_reaction && !explicit_scheme) {
    refuse(place, "contact_layer.massive.reaction",
           "complete is not offered by implicit integrators",
           "Give reaction: internal, or use contact_layer massless: an implicit step with a "
           "massive contact node and a complete reaction is unstable.");
  }
  int massless = 0;
  for (std::size_t e : {0u, 1u}) {
    if (bar.layer[e] == ContactLayer::kick && !explicit_scheme) {
      refuse(
          place, "contact_layer", "kick is not offered by implicit integrators",
          "Use massless: an implicit step with a massive contact node and a complete reaction is "
          "unstable.");
    }
    if (bar.layer[e] != ContactLayer::none && bar.fixed[e]) {
      refuse(place, std::string("supports.") + (e == 0 ? "left" : "right"),
             "is fixed, but the end is a port", "Leave the end free, or take its port away.");
    }
    if (bar.layer[e] == ContactLayer::massless) ++massless;
  }
  if (bar.elements <= massless - 1) {
    refuse(place, "model.fe.mesh.bar.elements",
           "one element cannot have a massless layer at both ends", "Give at least 2 elements.");
  }
}

}  // namespace

BarProperties fe_bar_properties(const BodySpec& spec) {
  const BarMeshSpec& mesh = std::get<BarMeshSpec>(std::get<FeModelSpec>(spec.model).mesh);
  const LinearElasticSpec& material = std::get<LinearElasticSpec>(*spec.material);
  BarProperties bar;
  bar.length = mesh.length;
  bar.area = mesh.area;
  bar.elements = mesh.elements;
  bar.youngs_modulus = *material.youngs_modulus;
  bar.density = material.density;
  bar.position = spec.initial.position[0];
  bar.velocity = spec.initial.velocity[0];
  bar.body_force = spec.body_force[0];
  bar.fixed = {spec.supports.left_fixed, spec.supports.right_fixed};
  bar.mass = mass_form(*spec.integrator);
  if (const auto* s = std::get_if<CentralDifferenceSpec>(&*spec.integrator)) {
    bar.bulk_viscosity = s->bulk_viscosity;
    bar.tchamwa = s->tchamwa;
  }
  if (const MassiveSpec* massive = std::get_if<MassiveSpec>(&spec.contact_layer)) {
    bar.stabilised = massive->stabilised;
    bar.complete_reaction = massive->complete_reaction;
  }
  if (const MasslessSpec* massless = std::get_if<MasslessSpec>(&spec.contact_layer)) {
    bar.stiffness_factor = massless->stiffness_factor;
  }
  for (const auto& [name, port] : spec.ports) {
    const int end = spec.end_of(port.side);
    if (end >= 0) bar.layer[end] = layer_of(spec, port);
  }
  return bar;
}

namespace {

std::unique_ptr<Interior> build(const Document& document, const std::string& path,
                                const BodyContext& context) {
  const BodySpec spec = placed_body(document, path, context);
  const Place place{document, path};
  if (std::holds_alternative<BarPairSpec>(spec.model)) return make_pair(spec, place);
  if (std::holds_alternative<ModalModelSpec>(spec.model)) return make_modal(spec, place);
  if (std::holds_alternative<RigidModelSpec>(spec.model)) return make_rigid(spec, place);
  if (std::holds_alternative<RigidToolSpec>(spec.model)) return make_tool(spec, place);
  if (spec.is_solid()) return make_solid(spec, place);
  check_points(spec, place);
  std::vector<BarInterior::End> ports = ports_of(spec, place);
  if (std::holds_alternative<RigidWallSpec>(spec.model)) {
    return std::make_unique<RigidWall>(place.name(), spec.initial.position[0], ports[0].name,
                                       Bar::outward(ports[0].end));
  }
  const BarProperties properties = fe_bar_properties(spec);
  const double node = properties.mass_total() / properties.elements;
  check_mass(node, node, spec, place);
  require_room(properties.elements, bytes_of_bar_element,
               place.where("model.fe.mesh.bar.elements"));
  check_layers(spec, properties, place);
  std::unique_ptr<Bar> bar = std::make_unique<Bar>(properties);
  BarInterior::Scheme scheme = std::visit(BarSchemeMaker{*bar, place}, *spec.integrator);
  BarInterior::Extras extras = make_extras(spec, place, *bar);
  return std::make_unique<BarInterior>(place.name(), std::move(bar), std::move(scheme), ports,
                                       std::move(extras));
}

}  // namespace

std::unique_ptr<Subdomain> make_body(const Document& document, const std::string& path,
                                     const BodyContext& context, std::function<void()> progress) {
  const auto too_large = [&document, &path] {
    return InputError("takes more memory than there is", document.where(path + ".model"),
                      "Make the mesh coarser, or run on a machine with more memory.");
  };
  try {
    return std::make_unique<Body>(build(document, path, context), std::move(progress));
  } catch (const std::bad_alloc&) {
    throw too_large();
  } catch (const std::length_error&) {  // more than any container can hold
    throw too_large();
  }
}

}  // namespace abut
