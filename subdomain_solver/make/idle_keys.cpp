// Keys of a body that have no effect beside its other keys: what is refused rather than ignored.

#include <string>

#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

namespace {

using Names = std::initializer_list<const char*>;

void all_idle(Fields& f, bool is_idle, Names keys, const char* why) {
  for (const char* key : keys) f.idle(is_idle, key, why);
}

}  // namespace

void BodySpec::idle_keys(Fields& f) const {
  idle_of_walls_and_pairs(f);
  idle_of_bars(f);
  idle_of_integrators(f);
  for (const auto& [name, load] : loads)
    f.idle(load.pressure.empty(), "loads." + name + ".follows", "it belongs to a pressure");
  for (const auto& [name, constraint] : constraints)
    f.idle(constraint.direction.empty(), "constraints." + name + ".value",
           "it is along direction, which is not given");
}

void BodySpec::idle_of_walls_and_pairs(Fields& f) const {
  const bool tool = std::holds_alternative<RigidToolSpec>(model);
  const bool wall = tool || std::holds_alternative<RigidWallSpec>(model);
  const bool pair = std::holds_alternative<BarPairSpec>(model);
  const char* of_wall = tool ? "a rigid_tool has nothing but a shape, a way and ports"
                             : "a rigid_wall has nothing but a place and a port";
  const char* of_pair = "a bar_pair has bars of its own, free, at their own places";
  all_idle(f, wall,
           {"material", "integrator", "initial.velocity", "initial.displacement_field",
            "initial.velocity_field"},
           of_wall);
  for (const auto& [name, port] : ports)
    f.idle(wall, "ports." + name + ".tied", "nothing here has a node whose mass could be shared");
  all_idle(f, pair, {"initial"}, of_pair);
  for (const char* key :
       {"contact_layer", "supports", "body_force", "points", "constraints", "loads", "equations"}) {
    f.idle(wall && !(tool && key == std::string("points")), key, of_wall);
    f.idle(pair, key, of_pair);
  }
  f.idle(shape() == nullptr ? !pair : shape()->dimension == 1, "initial.adjust",
         "it is for surfaces, of bodies in two and three dimensions");
  const FeModelSpec* fe = std::get_if<FeModelSpec>(&model);
  f.idle(fe == nullptr || fe->dimension == 1, "initial.interference",
         "it is of the body that finds contact on its surface: of model fe, in two and three "
         "dimensions");
  f.idle(pair, "integrator.central_difference.above_limit", "it is for solids");
  const auto* elastic = material ? std::get_if<LinearElasticSpec>(&*material) : nullptr;
  const bool one_dimension = shape() != nullptr && shape()->dimension == 1;
  for (const char* key : {"poissons_ratio", "bulk_modulus", "lame_modulus", "shear_modulus"})
    f.idle(elastic != nullptr && elastic->youngs_modulus && (pair || one_dimension),
           std::string("material.linear_elastic.") + key,
           "of a bar of linear_elastic material youngs_modulus tells all");
}

void BodySpec::idle_of_bars(Fields& f) const {
  if (std::holds_alternative<RigidToolSpec>(model)) return;
  const bool solid = is_solid();
  const bool flat = shape() != nullptr && shape()->dimension > 1;
  const bool modal = std::holds_alternative<ModalModelSpec>(model);
  const bool rigid = std::holds_alternative<RigidModelSpec>(model);
  all_idle(f, is_bar(), {"integrator.central_difference.above_limit", "equations"},
           "it is for solids");
  const bool still = integrates(SchemeKind::statics);
  const bool solves_equations = still || integrates(SchemeKind::implicit_steps);
  const bool fe_bar = solid && !flat && !modal && !rigid && !still;
  const bool layered = solid && !modal && !rigid && !still;
  const bool massive = flat && layered && std::holds_alternative<MassiveSpec>(contact_layer);
  f.idle(solid && (!layered || (contact_layer.index() != 0 && !massive)), "contact_layer",
         layered ? "finite elements have a massless layer, at tied ports none"
                 : "contact of this body has no layer");
  f.idle(layered, "contact_layer.massless.stiffness_factor",
         "it is for bars of equal elements of linear_elastic material");
  f.idle(!flat, "contact_layer.massless.directions", "one dimension has one direction");
  f.idle(!flat, "contact_layer.massless.required", "ends of bars always have one");
  for (const char* key : {"stabilised", "reaction"})
    f.idle(flat, std::string("contact_layer.massive.") + key, "it is for ends of bars");
  all_idle(
      f, solid,
      {"integrator.central_difference.dispersion_terms",
       "integrator.central_difference.bulk_viscosity", "integrator.central_difference.tchamwa"},
      "it is for bars of linear_elastic material and equal elements, without constraints and "
      "ports inside");
  for (const auto& [name, port] : ports)
    f.idle(solid && (!fe_bar || end_of(port.side) < 0), "ports." + name + ".tied",
           "no node of the port would give its mass away");
  f.idle(flat || rigid, "supports",
         flat ? "they are for the ends of bars" : "a rigid body has no ends of its own to hold");
  bool contact = false;
  for (const auto& [name, port] : ports)
    contact = contact || (!port.tied && (is_bar() || flat || end_of(port.side) >= 0));
  f.idle((is_bar() || layered) && !contact, "contact_layer", "the body has no port for contact");
  f.idle(rigid || (modal && !solves_equations), "equations",
         "nothing of the body is solved by iteration");
}

void BodySpec::idle_of_integrators(Fields& f) const {
  const FeModelSpec* fe = std::get_if<FeModelSpec>(&model);
  const bool explicit_in_time = integrates(SchemeKind::explicit_steps);
  f.idle(fe != nullptr && integrator && (!is_solid() || fe->dimension == 1), "model.fe.threads",
         "it is for bodies in two and three dimensions");
  f.idle(fe != nullptr && explicit_in_time, "equations", "an explicit body solves none");
  const bool still = integrates(SchemeKind::statics);
  all_idle(f, still, {"initial.velocity", "initial.velocity_field"},
           "a quasi_static body has no inertia");
}

}  // namespace abut
