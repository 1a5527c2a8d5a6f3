#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/fields.hpp"
#include "base/yaml_document.hpp"
#include "contract/port_role.hpp"
#include "contract/subdomain.hpp"
#include "subdomain_solver/bars/bar.hpp"
#include "subdomain_solver/make/integrator_spec.hpp"
#include "subdomain_solver/make/model_spec.hpp"
#include "subdomain_solver/make/solid_spec.hpp"

namespace abut {

// What a scene says of one body; each struct lists its keys once (docs/REFERENCE.md is made from
// them).

struct MasslessSpec {
  static constexpr std::string_view name = "massless";
  double stiffness_factor = 4.0 / 3.0;
  bool normal_alone = false;  // "directions: all | normal"
  bool required = false;      // where no node could take the mass it is refused, and not kept
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

/// Wanted interference: the overlap grows from nothing to what is drawn.
struct InterferenceSpec {
  double over = 0.0;  // [s] from the run's begin; 0: at once
  void fields(Fields& f);
};
struct InitialSpec {
  std::vector<double> position = {0.0}, velocity = {0.0};  // [m] [m/s] (dim)
  // one expression per dimension, added to the uniform values
  std::vector<std::string> displacement_field, velocity_field;
  bool adjust = false;       // the mesh is moved out of what it may touch, before there is stress
  double adjust_gaps = 0.0;  // [m]
  std::optional<InterferenceSpec> interference;
  bool after_statics = false;  // stages say so
  void fields(Fields& f);
};
struct SupportsSpec {
  bool left_fixed = false, right_fixed = false;
  void fields(Fields& f);
};
struct PortSpec {
  static constexpr std::string_view shorthand = "side";
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
  BodyContext context;  // no key: what the scene makes of the body
  void fields(Fields& f);
  /// The keys alone, without the rules across them.
  void keys(Fields& f);

  /// Mesh files that are named relative to the scene file are named with its folder ("" or "a/b/"),
  /// and are to be those of the context's digest.
  void place_files(const std::string& folder);

  /// Lumped mass whatever the integrator: that of the passive form, in which the body is whenever
  /// it touches something, so that nothing changes when it enters it.
  void lump_mass();

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
  /// False where the body has no integrator.
  bool integrates(SchemeKind kind) const;
  /// Of the rungs of the fidelity ladder; null: the body is something else.
  const SolidShapeSpec* shape() const;

 private:
  bool shares_with_other_steps() const;
  void check(Fields& f) const;
  bool is_linear_bar() const;
  bool has_port_inside() const;
  void check_dimensions(Fields& f) const;
  void check_solid(Fields& f) const;
  void check_modal(Fields& f) const;
  void check_rigid(Fields& f) const;
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
/// last part is the name. Throws InputError with file, line and key. Without a context it is a body
/// alone: nothing touches its surfaces. `progress` is called now and then during long advances.
std::unique_ptr<Subdomain> make_body(const Document& document, const std::string& path,
                                     const BodyContext& context = {},
                                     std::function<void()> progress = {});

}  // namespace abut
