#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/fields.hpp"
#include "base/yaml_document.hpp"
#include "contract/subdomain.hpp"
#include "subdomain_solver/bars/bar.hpp"
#include "subdomain_solver/make/integrator_spec.hpp"
#include "subdomain_solver/make/solid_spec.hpp"

namespace abut {

// What a scene says of one body; each struct lists its keys once (docs/REFERENCE.md is made from
// them).

struct BarMeshSpec {
  static constexpr std::string_view name = "bar";
  double length = 0.0, area = 0.0;  // [m] [m^2]
  int elements = 0;
  double grading = 1.0;
  void fields(Fields& f);
};
/// The mesh of a body and how it lies in space: of every rung of the fidelity ladder.
struct SolidShapeSpec {
  int dimension = 1;
  std::variant<BarMeshSpec, RectangleSpec, DiskSpec, BoxSpec, CylinderSpec, SphereSpec, GmshSpec,
               ExodusSpec>
      mesh;
  Plane plane = Plane::strain;
  double thickness = 1.0;  // [m]
  std::vector<std::string> map;  // [m] where nodes of the mesh go; empty: they stay
  void fields(Fields& f);
  double area() const;  // [m^2] cross section of a bar; 1 of other meshes
};
/// Finite elements on it.
struct FiniteElementsSpec : SolidShapeSpec {
  Formulation formulation = Formulation::full;
  double hourglass = 0.05;
  void fields(Fields& f);
};
struct FeModelSpec : FiniteElementsSpec {
  static constexpr std::string_view name = "fe";
  int threads = 1;
  void fields(Fields& f);
};
struct ModalModelSpec : FiniteElementsSpec {
  static constexpr std::string_view name = "modal";
  std::optional<double> modes, below;  // how many with fixed ports, or all below [Hz]
  void fields(Fields& f);
};
struct RigidModelSpec : SolidShapeSpec {
  static constexpr std::string_view name = "rigid";
  void fields(Fields& f);
};
/// A shape that goes where it is told.
struct RigidToolSpec : SolidShapeSpec {
  static constexpr std::string_view name = "rigid_tool";
  std::vector<std::string> way;  // [m] one expression per dimension; empty: it stands
  std::optional<double> step;    // [s]; none: windows
  void fields(Fields& f);
};
struct RigidWallSpec {
  static constexpr std::string_view name = "rigid_wall";
  void fields(Fields&) {}
};

/// Two bars in one body with the contact between them inside: the conventional contact methods.
struct PairedBarSpec {
  double length = 0.0, area = 0.0;  // [m] [m^2]
  int elements = 0;
  double position = 0.0, velocity = 0.0;  // [m] [m/s]
  void fields(Fields& f);
};
struct PenaltySpec {
  static constexpr std::string_view name = "penalty";
  double stiffness = 0.0;  // [N/m]
  void fields(Fields& f);
};
struct MultiplierSpec {
  static constexpr std::string_view name = "lagrange_multiplier";
  void fields(Fields&) {}
};
struct BarPairSpec {
  static constexpr std::string_view name = "bar_pair";
  PairedBarSpec left, right;
  std::variant<PenaltySpec, MultiplierSpec> contact;
  bool current_lengths = false;  // "lengths: reference | current"
  void fields(Fields& f);
};

struct MasslessSpec {
  static constexpr std::string_view name = "massless";
  double stiffness_factor = 4.0 / 3.0;
  bool normal_alone = false;  // "directions: all | normal"
  void fields(Fields& f);
};
struct KickSpec {
  static constexpr std::string_view name = "kick";
  void fields(Fields&) {}
};
struct MassiveSpec {
  static constexpr std::string_view name = "massive";
  bool stabilised = false;
  bool complete_reaction = false;  // "reaction: internal | complete"
  void fields(Fields& f);
};

struct InitialSpec {
  std::vector<double> position = {0.0}, velocity = {0.0};  // [m] [m/s] (dim)
  // one expression per dimension, added to the uniform values
  std::vector<std::string> displacement_field, velocity_field;
  bool adjust = false;       // the mesh is moved out of what it may touch, before there is stress
  double adjust_gaps = 0.0;  // [m]
  void fields(Fields& f);
};
struct SupportsSpec {
  bool left_fixed = false, right_fixed = false;
  void fields(Fields& f);
};
struct PortSpec {
  std::string side;
  bool tied = false;  // a joint for the whole run: the node keeps its mass
  void fields(Fields& f);
};

struct BodySpec {
  using Integrator = IntegratorSpec;

  std::variant<FeModelSpec, ModalModelSpec, RigidModelSpec, RigidToolSpec, RigidWallSpec,
               BarPairSpec>
      model;
  std::optional<MaterialSpec> material;
  std::optional<Integrator> integrator;
  std::variant<MasslessSpec, KickSpec, MassiveSpec> contact_layer;
  InitialSpec initial;
  SupportsSpec supports;
  std::vector<double> body_force = {0.0};  // [m/s^2] (dim)
  std::vector<std::pair<std::string, PortSpec>> ports;
  std::vector<std::pair<std::string, PointSpec>> points;
  std::vector<std::pair<std::string, ConstraintSpec>> constraints;
  std::vector<std::pair<std::string, LoadSpec>> loads;
  EquationsSpec equations;
  bool steps_apart = false;  // no key: a node is shared with a body of other steps
  void fields(Fields& f);

  /// Mesh files that are named relative to the scene file are named with its folder ("" or "a/b/").
  void place_files(const std::string& folder);

  /// fe in one dimension, linear_elastic with Young's modulus, integrated in time, without points,
  /// constraints, loads and fields: what exact solutions are of.
  bool is_uniform_bar() const;
  /// For the bars' own core: fe in one dimension, of equal elements, linear_elastic with Young's
  /// modulus, integrated in time, without constraints, and with ports at its ends alone.
  bool is_bar() const;
  /// End of a bar or wall that a side's name means, or that of a point at the end of a bar: 0 left,
  /// 1 right; -1: none.
  int end_of(const std::string& side) const;
  /// For people: why a linear bar of equal elements is no bar of the bars' own core; else empty.
  std::string why_general() const;
  /// Any other body with a mesh: fe in one to three dimensions, other rungs of the fidelity ladder.
  bool is_solid() const;
  /// Of the rungs of the fidelity ladder; null: the body is something else.
  const SolidShapeSpec* shape() const;

 private:
  bool is_linear_bar() const;
  bool has_port_inside() const;
  void check_dimensions(Fields& f) const;
  void check_solid(Fields& f) const;
  void check_modal(Fields& f) const;
  void check_rigid(Fields& f) const;
  bool is_implicit() const;
  void idle_keys(Fields& f) const;  // idle_keys.cpp
  void idle_of_walls_and_pairs(Fields& f) const;
  void idle_of_bars(Fields& f) const;
  void idle_of_integrators(Fields& f) const;
};

/// Properties of a body that is one bar. For closed forms and estimates.
BarProperties fe_bar_properties(const BodySpec& spec);
/// Left and right bar of a pair.
std::array<BarProperties, 2> pair_properties(const BodySpec& spec);

/// Reads one body of a scene and builds it. `path` is the body's key path, e.g. "bodies.left"; its
/// last part is the name. Throws InputError with file, line and key. `progress` is called now and
/// then during long advances.
std::unique_ptr<Subdomain> make_body(const Document& document, const std::string& path,
                                     std::function<void()> progress = {});

}  // namespace abut
