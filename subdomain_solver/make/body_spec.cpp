#include "subdomain_solver/make/body_spec.hpp"
#include "base/counted.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace abut {

void BarMeshSpec::fields(Fields& f) {
  f.required("length", length, "m", "length of the bar", positive);
  f.required("area", area, "m^2", "cross section", positive);
  f.required("elements", elements, "", "number of two-node elements", at_least(1));
  f.optional("grading", grading, "", "length of the last element over the first", positive);
  f.idle(elements == 1, "grading", "one element has no other to be compared with");
}

double SolidShapeSpec::area() const {
  const BarMeshSpec* bar = std::get_if<BarMeshSpec>(&mesh);
  return bar != nullptr ? bar->area : 1.0;
}

void SolidShapeSpec::fields(Fields& f) {
  f.required("dimension", dimension, "", "space dimension of the body", between(1, 3));
  f.choice("mesh", mesh, "mesh of the body");
  f.word("plane", plane, {"strain", "stress", "axisymmetric"},
         "kinematics in two dimensions; axisymmetric: x is the radius, y the axis");
  f.optional("thickness", thickness, "m", "thickness in plane strain and stress", positive);
  f.optional("map", map, "m",
             "places of the mesh's nodes, one expression in x, y, z per dimension: rounds, tapers "
             "or refines a part before it is placed, without stress");
  f.check(map.empty() || map.size() == index(dimension), "map",
          "has " + counted(map.size(), "expression"),
          fmt::format("Give {} expressions, one per dimension.", dimension));
  f.idle(dimension == 1, "map", "it is for bodies in two and three dimensions");
  const bool bar = std::holds_alternative<BarMeshSpec>(mesh);
  const bool flat =
      std::holds_alternative<RectangleSpec>(mesh) || std::holds_alternative<DiskSpec>(mesh);
  const bool file = std::visit(
      [](const auto& kind) {
        return requires { kind.file; };
      },
      mesh);
  const int wanted = bar ? 1 : flat ? 2 : 3;
  f.check(file ? dimension > 1 : dimension == wanted, "dimension",
          fmt::format("is {}, but the mesh has {}", dimension,
                      file ? "2 or 3" : std::to_string(wanted)),
          "Give the dimension of the mesh.");
  f.idle(dimension != 2, "plane", "it is for bodies in two dimensions");
  f.idle(dimension != 2 || plane == Plane::axisymmetric, "thickness",
         "it is for plane strain and plane stress");
}

void FiniteElementsSpec::fields(Fields& f) {
  SolidShapeSpec::fields(f);
  f.word("formulation", formulation, {"full", "mean_dilatation", "one_point"},
         "integration of an element: full; with one volume change for all of it, a linear field "
         "of it where the element is quadratic (B-bar, F-bar), which does not lock when nearly "
         "incompressible; or one point with hourglass control, for explicit steps");
  f.optional("hourglass", hourglass, "", "coefficient of the hourglass stiffness of one_point",
             between(0.0, 1.0));
  const bool locks = plane != Plane::stress && dimension > 1;
  f.check(locks || formulation != Formulation::mean_dilatation, "formulation",
          "mean_dilatation does not apply to plane and uniaxial stress, which cannot lock",
          "Leave formulation out.");
  f.idle(dimension == 1, "formulation", "bars have one integration of their elements");
  f.idle(formulation != Formulation::one_point, "hourglass",
         "it belongs to formulation: one_point");
}

void FeModelSpec::fields(Fields& f) {
  FiniteElementsSpec::fields(f);
  f.optional("threads", threads, "",
             "number of threads that compute its elements and factor its matrices",
             between(1, 256));
}

void ModalModelSpec::fields(Fields& f) {
  FiniteElementsSpec::fields(f);
  f.optional("modes", modes, "",
             "number of modes with fixed ports, the lowest ones, beside the static shapes of the "
             "ports and rigid motions",
             at_least(0));
  f.optional("below", below, "Hz", "frequency below which all modes with fixed ports are kept",
             positive);
  f.check(!modes || *modes == std::floor(*modes), "modes", "is not a whole number",
          "Give a whole number of modes.");
  f.check(modes.has_value() != below.has_value(), "modes",
          modes ? "stands beside below" : "is missing, and so is below",
          "Give the number of modes, or the frequency below which all are kept.");
}

void RigidModelSpec::fields(Fields& f) {
  SolidShapeSpec::fields(f);
  f.check(plane != Plane::axisymmetric, "plane",
          "axisymmetric does not fit a rigid body, which turns about its centre",
          "Make it an fe body of a stiff material, or mesh the whole body in space.");
  f.idle(true, "plane", "a rigid body has no stress");
}

void TurnSpec::fields(Fields& f) {
  f.optional("about", about, "m",
             "point about which the tool turns, where it is before it has moved, one number per "
             "dimension; it goes the tool's way; default the tool's own origin");
  f.optional("axis", axis, "",
             "direction about which the tool turns in space, anticlockwise to one who looks "
             "against it; in the plane it is z");
  f.required("angle", angle, "rad", "angle by which the tool is turned, an expression in t");
}

void RigidToolSpec::fields(Fields& f) {
  SolidShapeSpec::fields(f);
  f.optional("way", way, "m",
             "displacement of the tool, one expression in t per dimension; it stands without");
  f.optional_section("turn", turn, "how the tool turns");
  f.optional("step", step, "s",
             "time between the points at which its way is told, from one to the next straight; "
             "default the window",
             positive);
  f.check(dimension > 1, "dimension", "is 1, but a tool has a surface",
          "Use rigid_wall for bars, or give dimension 2 or 3.");
  f.check(way.empty() || way.size() == index(dimension), "way",
          "has " + counted(way.size(), "expression"),
          fmt::format("Give {} expressions, one per dimension.", dimension));
  f.check(!turn || turn->about.empty() || turn->about.size() == index(dimension), "turn.about",
          "has " + counted(turn ? turn->about.size() : 0, "number"),
          fmt::format("Give {} numbers, one per dimension.", dimension));
  f.check(!turn || dimension != 3 || turn->axis.size() == 3, "turn.axis",
          turn && turn->axis.empty() ? "is missing"
                                     : "has " + counted(turn ? turn->axis.size() : 0, "number"),
          "Give the three numbers of a direction, for example [0, 0, 1].");
  const auto is_zero = [](double x) { return x == 0.0; };
  f.check(!turn || dimension != 3 || !std::ranges::all_of(turn->axis, is_zero), "turn.axis",
          "has no direction", "Give a direction that is not zero, for example [0, 0, 1].");
  f.check(!turn || plane != Plane::axisymmetric, "turn",
          "does not fit an axisymmetric tool, which is the same all around",
          "Mesh the whole tool in space, or leave turn out.");
  f.idle(turn && dimension != 3, "turn.axis", "in the plane all turns are about z");
  f.idle(true, "thickness", "a rigid tool has no mass");
  f.idle(plane != Plane::axisymmetric, "plane", "a rigid tool has no stress");
  f.idle(way.empty() && !turn, "step", "a tool that stands has no way to tell");
}

void PairedBarSpec::fields(Fields& f) {
  f.required("length", length, "m", "length of the bar", positive);
  f.required("area", area, "m^2", "cross section", positive);
  f.required("elements", elements, "", "number of equal two-node elements", at_least(1));
  f.required("position", position, "m", "place of the bar's left end");
  f.optional("velocity", velocity, "m/s", "uniform velocity at the start");
}

void PenaltySpec::fields(Fields& f) {
  f.required("stiffness", stiffness, "N/m", "spring that resists the overlap of the tips",
             positive);
}

void BarPairSpec::fields(Fields& f) {
  f.section("left", left, "left bar; its right end may touch");
  f.section("right", right, "right bar; its left end may touch");
  f.choice("contact", contact, "contact between the tips, solved within the body");
  f.word("lengths", current_lengths, {"reference", "current"},
         "element lengths on which mass and stiffness are assembled; current: anew in every step, "
         "as in some published comparisons");
}

void MasslessSpec::fields(Fields& f) {
  f.optional(
      "stiffness_factor", stiffness_factor, "",
      "factor on the stiffness of the contact element; 4/3 is the distance to the centroid of the "
      "mass moved inwards",
      between(0.1, 100.0));
  f.word(
      "directions", normal_alone, {"all", "normal"},
      "in which nodes of surfaces have no mass; normal: of flat sides along the axes, which keep "
      "the mass that moves along them: for faces that yield and spread");
  f.optional(
      "required", required, "",
      "refusal of a solid that has no free node inside to take the surface's mass, and a layer "
      "whatever it leaves of the moments of inertia; else, and where less than 15 % of these "
      "were left, the surface keeps its mass, and contact is in its passive form");
}

void MassiveSpec::fields(Fields& f) {
  f.optional("stabilised", stabilised, "",
             "dropping of the contact node's acceleration after every substep in contact, as "
             "published");
  f.word("reaction", complete_reaction, {"internal", "complete"},
         "force handed over by the side whose motion is prescribed: internal force of the contact "
         "node as published, or with its inertia");
  f.check(!stabilised || !complete_reaction, "reaction",
          "is complete, but stabilised drops the inertia that it holds",
          "Give reaction: internal, or stabilised: false.");
}

void InterferenceSpec::fields(Fields& f) {
  f.optional("over", over, "s",
             "time from the run's begin in which the overlap grows; bodies that are quasi_static "
             "take it at once",
             at_least(0.0));
}

void InitialSpec::fields(Fields& f) {
  f.optional("position", position, "m", "place of the body's own origin, one number per dimension");
  f.optional("velocity", velocity, "m/s",
             "uniform velocity at the start, one number per dimension");
  f.optional("displacement_field", displacement_field, "m",
             "initial displacement, one expression per dimension in x, y, z, the undeformed place "
             "in space");
  f.optional("velocity_field", velocity_field, "m/s",
             "initial velocity, added to velocity, one expression per dimension in x, y, z, the "
             "undeformed place in space: turning about the body's own origin at (a, b) is "
             "[\"-w * (y - b)\", \"w * (x - a)\"]");
  f.optional(
      "adjust", adjust, "",
      "whether nodes of the ports that overlap a surface that they may touch are moved out of "
      "it before the start: the mesh changes, without stress; for bodies in two and three "
      "dimensions");
  f.optional("adjust_gaps", adjust_gaps, "m",
             "distance up to which nodes before such a surface are moved onto it as well",
             at_least(0.0));
  f.idle(!adjust, "adjust_gaps", "it belongs to adjust: true");
  f.optional_section(
      "interference", interference,
      "wanted overlap with what the body touches (press fit, preload): it grows from "
      "nothing to what is drawn; the body finds its contacts");
  f.optional("after_statics", after_statics, "",
             "written into stages, not into scenes: the body stood in statics before, and what "
             "overlaps has been pressed in there");
  f.check(!interference || !adjust, "interference", "stands beside adjust, which takes it away",
          "Leave one of them out.");
}

void SupportsSpec::fields(Fields& f) {
  f.word("left", left_fixed, {"free", "fixed"}, "support of the left end");
  f.word("right", right_fixed, {"free", "fixed"}, "support of the right end");
}

void PortSpec::fields(Fields& f) {
  f.required("side", side, "",
             "side of the body that the port is: left or right for a bar or a wall; a side of the "
             "mesh, boundary for all of its surface; or the name of a point");
  f.optional("tied", tied, "",
             "whether the port is joined to another body from the start: its node then keeps its "
             "share of the joint's mass, whatever the contact_layer, and takes no contact");
}

void BodySpec::fields(Fields& f) {
  keys(f);
  check(f);
}

void BodySpec::keys(Fields& f) {
  f.ignore("launch");
  f.ignore("like");
  f.ignore("copies");
  f.choice("model", model, "model of the body");
  f.choice("material", material, "material of the body; a rigid wall has none");
  f.choice("integrator", integrator, "time integrator; a rigid wall has none");
  f.choice("contact_layer", contact_layer, "treatment of the contact nodes' mass",
           Presence::optional);
  f.defaulted("initial", initial, "initial state");
  f.defaulted("supports", supports, "supports of the ends");
  f.optional("body_force", body_force, "m/s^2", "force per mass, one number per dimension");
  f.map("ports", ports, "named boundary sets through which motion and force pass",
        Presence::optional);
  f.map("points", points,
        "nodes under names of their own, for ports and constraints beside the names that the mesh "
        "has; a bar with a port on a node inside runs as a solid",
        Presence::optional);
  f.map("constraints", constraints,
        "prescribed displacements of a solid; a bar with constraints runs as one",
        Presence::optional);
  f.map("loads", loads, "forces on the body", Presence::optional);
  f.defaulted("equations", equations, "solution of the equations of an implicit or static solid");
}

void BodySpec::check(Fields& f) const {
  check_dimensions(f);
  idle_keys(f);
  const bool only_wall = std::holds_alternative<RigidWallSpec>(model);
  const bool wall = only_wall || std::holds_alternative<RigidToolSpec>(model);
  if (is_solid() && !wall) check_solid(f);
  const bool pair = std::holds_alternative<BarPairSpec>(model);
  const bool rigid = std::holds_alternative<RigidModelSpec>(model);
  if (rigid) check_rigid(f);
  if (std::holds_alternative<ModalModelSpec>(model)) check_modal(f);
  const std::string words(std::visit([](const auto& m) { return m.name; }, model));
  f.check(wall || material.has_value(), "model", words + " needs a material",
          "Add material: {linear_elastic: {youngs_modulus: ..., density: ...}} to the body.");
  const auto* elastic = material ? std::get_if<LinearElasticSpec>(&*material) : nullptr;
  f.check(!pair || (elastic != nullptr && elastic->youngs_modulus), "material",
          "is not offered to a bar_pair",
          "Give linear_elastic: {youngs_modulus: ..., density: ...}.");
  f.check(wall || integrator.has_value(), "model", words + " needs an integrator",
          rigid ? "Add integrator: {rigid_motion: {step: ...}} to the body."
                : "Add integrator: {central_difference: {step: ...}} or an implicit one to the "
                  "body.");
  f.check(rigid || !integrates(SchemeKind::exact), "integrator",
          "rigid_motion is offered to model rigid only",
          "Use newmark: {step: ...} or another integrator of bodies that deform.");
  f.check(!pair || ports.empty(), "ports", "do not belong to a bar_pair",
          "Leave ports out: the pair has left_tip and right_tip.");
  f.check(!only_wall || ports.size() == 1, "model", "rigid_wall needs exactly one port",
          "Add ports: {face: {side: left}}, where the side tells to which side the wall faces.");
}

void BodySpec::lump_mass() {
  const auto lump = [](auto& scheme) {
    if constexpr (requires { scheme.mass; }) scheme.mass = MassForm::lumped;
  };
  if (integrator) std::visit(lump, *integrator);
}

void BodySpec::place_files(const std::string& folder) {
  auto place = [&folder](auto& mesh) {
    if constexpr (requires { mesh.file; }) {
      if (!mesh.file.starts_with('/')) mesh.file = folder + mesh.file;
    }
  };
  auto place_mesh = [this, &place](auto& kind) {
    if constexpr (requires { kind.mesh; }) {
      std::visit(place, kind.mesh);
      kind.digest = context.mesh_digest;
    }
  };
  std::visit(place_mesh, model);
}

const SolidShapeSpec* BodySpec::shape() const {
  auto find = [](const auto& kind) -> const SolidShapeSpec* {
    if constexpr (requires { kind.mesh; }) return &kind;
    return nullptr;
  };
  return std::visit(find, model);
}

bool BodySpec::integrates(SchemeKind kind) const {
  const auto kind_of = [](const auto& scheme) { return scheme.kind; };
  return integrator && std::visit(kind_of, *integrator) == kind;
}

bool BodySpec::is_linear_bar() const {
  const FeModelSpec* fe = std::get_if<FeModelSpec>(&model);
  const LinearElasticSpec* elastic =
      material ? std::get_if<LinearElasticSpec>(&*material) : nullptr;
  return fe != nullptr && std::holds_alternative<BarMeshSpec>(fe->mesh) && elastic != nullptr &&
         elastic->youngs_modulus && integrator && !integrates(SchemeKind::statics);
}

bool BodySpec::is_uniform_bar() const {
  return is_linear_bar() && points.empty() && constraints.empty() && loads.empty() &&
         initial.displacement_field.empty() && initial.velocity_field.empty();
}

bool BodySpec::is_bar() const {
  return is_linear_bar() && constraints.empty() && !has_port_inside() &&
         !shares_with_other_steps() &&
         std::get<BarMeshSpec>(std::get<FeModelSpec>(model).mesh).grading == 1.0;
}

std::string BodySpec::why_general() const {
  if (!is_linear_bar() || std::get<BarMeshSpec>(std::get<FeModelSpec>(model).mesh).grading != 1.0)
    return "";
  if (!constraints.empty()) return "constraints";
  if (shares_with_other_steps()) return "a row of bars with a joint of unlike steps";
  return has_port_inside() ? "a port inside the bar" : "";
}

/// The node is the nearest one: whether it is at the point is checked where points are made.
int BodySpec::end_of(const std::string& side) const {
  if (side == "left") return 0;
  if (side == "right") return 1;
  const BarMeshSpec* mesh = shape() != nullptr ? std::get_if<BarMeshSpec>(&shape()->mesh) : nullptr;
  if (mesh == nullptr) return -1;
  const double near = mesh->grading == 1.0 ? 0.5 / mesh->elements : 1.0e-6;
  for (const auto& [name, point] : points) {
    if (name != side || point.at.size() != 1) continue;
    const double along = (point.at[0] - initial.position[0]) / mesh->length;
    if (along < near) return 0;
    if (along > 1.0 - near) return 1;
  }
  return -1;
}

bool BodySpec::shares_with_other_steps() const {
  return std::ranges::any_of(ports, [this](const auto& port) {
    const PortRole role = context.role(port.first);
    return port.second.tied && role.tied && !role.alike;
  });
}

bool BodySpec::has_port_inside() const {
  for (const auto& [name, port] : ports) {
    const std::string& side = port.side;
    const auto named = [&side](const auto& point) { return point.first == side; };
    if (std::any_of(points.begin(), points.end(), named) && end_of(side) < 0) return true;
  }
  return false;
}

bool BodySpec::is_solid() const { return shape() != nullptr && !is_bar(); }

void BodySpec::check_dimensions(Fields& f) const {
  const std::size_t dim = shape() != nullptr ? index(shape()->dimension) : 1;
  const std::string numbers = dim == 1 ? "Give one number: the body has one dimension."
                                       : fmt::format("Give {} numbers, one per dimension.", dim);
  auto check = [&](const std::vector<double>& list, const char* key) {
    const bool absent = list.size() == 1 && list[0] == 0.0;  // as when left out
    f.check(list.size() == dim || absent, key, "has " + counted(list.size(), "number"), numbers);
  };
  check(initial.position, "initial.position");
  check(initial.velocity, "initial.velocity");
  check(body_force, "body_force");
  for (const auto& [list, key] :
       {std::pair(&initial.displacement_field, "initial.displacement_field"),
        {&initial.velocity_field, "initial.velocity_field"}}) {
    f.check(list->empty() || list->size() == dim, key, "has " + counted(list->size(), "expression"),
            fmt::format("Give {} expressions, one per dimension.", dim));
  }
}

void BodySpec::check_solid(Fields& f) const {
  if (!integrator) return;
  f.check(!std::holds_alternative<BackwardEulerSpec>(*integrator), "integrator",
          "backward_euler is offered to bar_pair only",
          "Use generalized_alpha: {spectral_radius: 0}, which damps as strongly.");
}

void BodySpec::check_modal(Fields& f) const {
  f.check(!material || std::holds_alternative<LinearElasticSpec>(*material), "material",
          "is nonlinear, but modes are of a linear body", "Use linear_elastic, or model fe.");
  for (const auto& [name, load] : loads) {
    f.check(!load.follows, "loads." + name + ".follows",
            "is true, but modes are of small displacements", "Leave follows out, or use model fe.");
  }
  const auto zero = [](const std::string& text) {
    char* end = nullptr;
    return std::strtod(text.c_str(), &end) == 0.0 && end == text.c_str() + text.size();
  };
  for (const auto& [name, constraint] : constraints) {
    for (const auto& [text, key] : {std::pair(&constraint.x, ".x"),
                                    {&constraint.y, ".y"},
                                    {&constraint.z, ".z"},
                                    {&constraint.value, ".value"}}) {
      f.check(zero(*text), "constraints." + name + key, "is not 0, but modes have supports at rest",
              "Give 0, or use model fe.");
    }
  }
}

void BodySpec::check_rigid(Fields& f) const {
  f.check(constraints.empty(), "constraints",
          "prescribe displacements of single nodes, which a rigid body does not have",
          "Leave constraints out, or use model fe.");
  f.check(!integrator || integrates(SchemeKind::exact), "integrator", "is for bodies that deform",
          "Use rigid_motion: {step: ...} with model rigid.");
}

}  // namespace abut
