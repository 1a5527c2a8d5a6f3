// Goal: a key that can have no effect beside the others is refused where it is given, whatever its
// value, and is left out of the resolved scene. Oracle: docs/REFERENCE.md, key by key; without the
// key the same body is accepted, so it is the key that is refused.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/yaml_fields.hpp"
#include "base/yaml_resolved.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut::solver_idle_keys_tests {
namespace {

struct Context {
  const char* name;
  const char* body;
};

constexpr const char* steel = "material: {linear_elastic: {youngs_modulus: 1, density: 1}}, ";
constexpr const char* rubber =
    "material: {neo_hookean: {youngs_modulus: 1, poissons_ratio: 0.3, density: 1}}, ";
constexpr const char* linear =
    "material: {linear_elastic: {youngs_modulus: 1, poissons_ratio: 0.3, density: 1}}, ";
constexpr const char* bar = "mesh: {bar: {length: 1, area: 1, elements: 4}}";
constexpr const char* box = "mesh: {box: {lengths: [1, 1, 1], elements: [1, 1, 1]}}";
constexpr const char* flat = "mesh: {rectangle: {lengths: [1, 1], elements: [1, 1]}}";

std::string body_of(const std::string& context) {
  const std::string explicit_steps = "integrator: {central_difference: {step: 0.01}}";
  const std::string implicit_steps = "integrator: {newmark: {step: 0.01}}";
  const std::string in_line = std::string("model: {fe: {dimension: 1, ") + bar + "}}, ";
  const std::string in_space = std::string("model: {fe: {dimension: 3, ") + box + "}}, ";
  if (context == "wall") return "model: rigid_wall, ports: {face: {side: left}}";
  if (context == "pair") {
    return "model: {bar_pair: {left: {length: 1, area: 1, elements: 4, position: 0}, right: "
           "{length: 1, area: 1, elements: 4, position: 2}, contact: lagrange_multiplier}}, " +
           (steel + explicit_steps);
  }
  if (context == "bar") return in_line + steel + explicit_steps;
  if (context == "loaded bar")
    return in_line + steel + explicit_steps +
           ", loads: {l: {acceleration: [x]}}, initial: {velocity_field: [x]}, "
           "points: {p: {at: [1]}}, ports: {q: {side: p}}";
  if (context == "bar with a port inside")
    return in_line + steel + explicit_steps + ", points: {p: {at: [0.5]}}, ports: {q: {side: p}}";
  if (context == "held bar")
    return in_line + steel + explicit_steps + ", constraints: {c: {on: left, x: '0'}}";
  if (context == "implicit bar") return in_line + steel + implicit_steps;
  if (context == "graded bar")
    return "model: {fe: {dimension: 1, mesh: {bar: {length: 1, area: 1, elements: 4, grading: "
           "2}}}}, " +
           (steel + explicit_steps);
  if (context == "bar of one element")
    return "model: {fe: {dimension: 1, mesh: {bar: {length: 1, area: 1, elements: 1}}}}, " +
           (steel + implicit_steps);
  if (context == "solid") return in_space + rubber + explicit_steps;
  if (context == "implicit linear solid") return in_space + linear + implicit_steps;
  if (context == "static solid") return in_space + rubber + "integrator: {quasi_static: {step: 1}}";
  if (context == "axisymmetric")
    return std::string("model: {fe: {dimension: 2, plane: axisymmetric, ") + flat + "}}, " +
           rubber + implicit_steps;
  if (context == "modal")
    return std::string("model: {modal: {dimension: 3, modes: 2, ") + box + "}}, " + linear +
           explicit_steps;
  if (context == "rigid")
    return std::string("model: {rigid: {dimension: 3, ") + box + "}}, " + rubber +
           "integrator: {rigid_motion: {step: 0.01}}";
  if (context == "held solid")
    return in_space + rubber + implicit_steps + ", constraints: {hold: {on: left, x: 0}}";
  if (context == "pulled solid")
    return in_space + rubber + implicit_steps + ", loads: {pull: {on: left, traction: [1, 0, 0]}}";
  ADD_FAILURE() << "no context " << context;
  return "";
}

struct Idle {
  const char* context;
  std::vector<const char*> settings;  // key=value of the body
};

const std::vector<Idle> table = {
    {"wall",
     {"material={linear_elastic: {youngs_modulus: 1, density: 1}}",
      "integrator={newmark: {step: 1}}", "contact_layer=massless", "contact_layer=kick",
      "initial.velocity=[0]", "initial.velocity=[5]", "initial.displacement_field=[x]",
      "initial.velocity_field=[x]", "supports.left=free", "supports.right=fixed",
      "body_force=[-9.81]", "ports.face.tied=true", "points={p: {at: [0]}}",
      "constraints={c: {on: left, fixed: true}}", "loads={l: {acceleration: [1]}}",
      "equations.tolerance=1e-9"}},
    {"pair",
     {"contact_layer={massless: {stiffness_factor: 2}}", "initial.position=[0]",
      "initial.velocity=[1]", "supports.left=fixed", "body_force=[1]", "points={p: {at: [0]}}",
      "constraints={c: {on: left, fixed: true}}", "loads={l: {acceleration: [1]}}",
      "equations={linear: direct}", "integrator.central_difference.above_limit=clamp",
      "material.linear_elastic.poissons_ratio=0.3"}},
    {"bar",
     {"model.fe.plane=strain", "model.fe.plane=stress", "model.fe.thickness=1",
      "model.fe.thickness=0.5", "model.fe.formulation=full", "model.fe.formulation=one_point",
      "model.fe.hourglass=0.05", "model.fe.threads=1", "model.fe.threads=2", "equations={}",
      "contact_layer={massless: {stiffness_factor: 1.4}}", "contact_layer=kick",
      "integrator.central_difference.above_limit=refuse",
      "integrator.central_difference.above_limit=clamp",
      "material.linear_elastic.poissons_ratio=0.3", "material.linear_elastic.shear_modulus=1",
      "material.linear_elastic.bulk_modulus=1", "material.linear_elastic.lame_modulus=1"}},
    {"loaded bar", {"equations={}", "integrator.central_difference.above_limit=clamp"}},
    {"bar with a port inside",
     {"contact_layer=kick", "ports.q.tied=true",
      "integrator.central_difference.dispersion_terms=1"}},
    {"held bar", {"integrator.central_difference.tchamwa=1.1", "constraints.c.value=0"}},
    {"implicit bar", {"model.fe.threads=2", "equations.max_iterations=3"}},
    {"graded bar",
     {"integrator.central_difference.dispersion_terms=1",
      "integrator.central_difference.bulk_viscosity=0", "integrator.central_difference.tchamwa=1",
      "contact_layer={massless: {stiffness_factor: 2}}", "contact_layer=kick",
      "contact_layer=massive", "model.fe.threads=2", "equations={}",
      "material.linear_elastic.poissons_ratio=0.2"}},
    {"bar of one element", {"model.fe.mesh.bar.grading=1", "model.fe.mesh.bar.grading=2"}},
    {"solid",
     {"model.fe.plane=strain", "model.fe.thickness=1", "model.fe.hourglass=0.1", "equations={}",
      "equations.linear=direct", "contact_layer=massless",
      "contact_layer={massless: {stiffness_factor: 2}}", "supports.left=free",
      "integrator.central_difference.dispersion_terms=2",
      "integrator.central_difference.bulk_viscosity=0.1",
      "integrator.central_difference.tchamwa=1.1", "ports={p: {side: left, tied: false}}"}},
    {"static solid", {"initial.velocity=[1, 0, 0]", "initial.velocity_field=[x, 0, 0]"}},
    {"axisymmetric", {"model.fe.thickness=2"}},
    {"modal", {"equations.tolerance=1e-6", "model.modal.hourglass=0.1", "contact_layer=kick"}},
    {"rigid",
     {"model.rigid.plane=stress", "equations.tolerance=1e-6", "model.rigid.thickness=2",
      "supports.right=fixed"}},
    {"held solid", {"constraints.hold.value=0.1"}},
    {"pulled solid", {"loads.pull.follows=false"}},
};

BodySpec spec_of(const std::string& context, std::vector<std::string> overrides = {}) {
  const std::string text = "bodies: {b: {" + body_of(context) + "}}\n";
  return read<BodySpec>(Document::from_text("s.yaml", text, std::move(overrides)), "bodies.b");
}

TEST(IdleKeys, AreRefusedWhereTheyAreGiven) {
  for (const Idle& row : table) {
    EXPECT_NO_THROW(spec_of(row.context)) << row.context;
    for (const std::string setting : row.settings) {
      try {
        spec_of(row.context, {"bodies.b." + setting});
        ADD_FAILURE() << row.context << " accepts " << setting;
      } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("has no effect: "), std::string::npos) << what;
        EXPECT_NE(what.find(setting), std::string::npos) << "the setting is blamed: " << what;
        EXPECT_NE(what.find(" Leave "), std::string::npos) << "a remedy is given: " << what;
      }
    }
  }
}

/// Loads, fields and points at the ends take nothing away from a bar.
TEST(IdleKeys, OfABarAreNotThoseThatItsLoadsLeaveAnEffect) {
  for (const char* setting : {"contact_layer=kick", "ports.q.tied=true",
                              "integrator.central_difference.dispersion_terms=1",
                              "integrator.central_difference.bulk_viscosity=0.1",
                              "integrator.central_difference.tchamwa=1.1"})
    EXPECT_TRUE(spec_of("loaded bar", {std::string("bodies.b.") + setting}).is_bar()) << setting;
}

/// The resolved scene of a run is a scene: what it says must have an effect as well.
TEST(IdleKeys, AreLeftOutOfTheResolvedScene) {
  for (const Idle& row : table) {
    const BodySpec spec = spec_of(row.context);
    ResolvedYaml resolved;
    resolved.add("bodies.b", spec);
    const std::string once = resolved.text();
    ResolvedYaml again;
    again.add("bodies.b", read<BodySpec>(Document::from_text("s.yaml", once), "bodies.b"));
    EXPECT_EQ(again.text(), once) << row.context;
  }
}

}  // namespace
}  // namespace abut::solver_idle_keys_tests
