#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/fields.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/materials/material.hpp"

namespace abut {

// What a scene says of bodies in two and three dimensions; each struct lists its keys once.

struct RectangleSpec {
  static constexpr std::string_view name = "rectangle";
  std::vector<double> lengths, elements, grading = {1.0, 1.0};
  std::string element = "quad4";
  bool centred = false;  // "origin: corner | centre"
  void fields(Fields& f);
};
struct DiskSpec {
  static constexpr std::string_view name = "disk";
  double radius = 0.0;  // [m]
  int core = 0, layers = 0;
  std::string element = "quad4";
  void fields(Fields& f);
};
struct BoxSpec {
  static constexpr std::string_view name = "box";
  std::vector<double> lengths, elements, grading = {1.0, 1.0, 1.0};
  std::string element = "hex8";
  bool centred = false;
  void fields(Fields& f);
};
struct CylinderSpec {
  static constexpr std::string_view name = "cylinder";
  double radius = 0.0, length = 0.0, grading = 1.0;  // [m]
  int core = 0, layers = 0, elements = 0;
  std::string element = "hex8";
  bool centred = false;
  void fields(Fields& f);
};
struct SphereSpec {
  static constexpr std::string_view name = "sphere";
  double radius = 0.0;  // [m]
  int core = 0, layers = 0;
  std::string element = "hex8";
  void fields(Fields& f);
};
struct MeshFileSpec {
  std::string file;
  double scale = 1.0;  // [m] per unit of the file
  void fields(Fields& f);
};
struct GmshSpec : MeshFileSpec {
  static constexpr std::string_view name = "gmsh";
};
struct AbaqusSpec : MeshFileSpec {
  static constexpr std::string_view name = "abaqus";
  std::string part;  // of the file; empty: all of it
  void fields(Fields& f);
};
struct ExodusSpec : MeshFileSpec {
  static constexpr std::string_view name = "exodus";
};

/// Elastic constants of an isotropic solid, any two of them.
struct ElasticSpec {
  std::optional<double> youngs_modulus, poissons_ratio, bulk_modulus, lame_modulus, shear_modulus;
  double density = 0.0;  // [kg/m^3]
  void fields(Fields& f);
  /// Materials by name, each with its source.
  static std::span<const Preset> presets();
};
struct LinearElasticSpec : ElasticSpec {
  static constexpr std::string_view name = "linear_elastic";
};
struct SaintVenantKirchhoffSpec : ElasticSpec {
  static constexpr std::string_view name = "saint_venant_kirchhoff";
};
struct NeoHookeanSpec : ElasticSpec {
  static constexpr std::string_view name = "neo_hookean";
};
struct HenckySpec : ElasticSpec {
  static constexpr std::string_view name = "hencky";
};
struct MooneyRivlinSpec {
  static constexpr std::string_view name = "mooney_rivlin";
  double c10 = 0.0, c01 = 0.0, bulk_modulus = 0.0;  // [Pa]
  double density = 0.0;                             // [kg/m^3]
  void fields(Fields& f);
};
struct SaturationSpec {
  double stress = 0.0, rate = 0.0;  // [Pa]
  void fields(Fields& f);
};
struct J2PlasticitySpec : ElasticSpec {
  static constexpr std::string_view name = "j2_plasticity";
  double yield_stress = 0.0, hardening = 0.0;  // [Pa]
  std::optional<SaturationSpec> saturation;
  void fields(Fields& f);
};

/// A node under a name of its own, on which ports and constraints may lie.
struct PointSpec {
  static constexpr std::string_view shorthand = "at";
  std::vector<double> at;  // [m] (dim) reference position
  void fields(Fields& f);
};
/// Prescribed displacement of a side or node set. Expressions in x, y, z [m] and t [s].
struct ConstraintSpec {
  std::string on;
  bool fixed = false;
  std::string x, y, z;  // [m]; empty: free
  std::vector<double> direction;
  std::string value = "0";  // [m] along the direction
  bool symmetry = false;    // no displacement normal to a plane side
  void fields(Fields& f);
};

/// Force on a side, or on the whole volume. Expressions in x, y, z [m] and t [s].
struct LoadSpec {
  std::string on;                                   // empty: the volume
  std::vector<std::string> traction, acceleration;  // [Pa] [m/s^2] one expression per dimension
  std::string pressure;                             // [Pa]
  bool follows = false;
  void fields(Fields& f);
};

/// How nonlinear and linear equations are solved.
struct AutomaticSpec {
  static constexpr std::string_view name = "automatic";
  void fields(Fields&) {}
};
struct DirectSpec {
  static constexpr std::string_view name = "direct";
  void fields(Fields&) {}
};
struct ConjugateGradientsSpec {
  static constexpr std::string_view name = "conjugate_gradients";
  double tolerance = 1.0e-10;
  void fields(Fields& f);
};
struct PetscSpec {
  static constexpr std::string_view name = "petsc";
  double tolerance = 1.0e-10;
  void fields(Fields& f);
};
struct EquationsSpec {
  double tolerance = 1.0e-9;
  int max_iterations = 25;
  std::variant<AutomaticSpec, DirectSpec, ConjugateGradientsSpec, PetscSpec> linear;
  void fields(Fields& f);
};

using MaterialSpec = std::variant<LinearElasticSpec, SaintVenantKirchhoffSpec, NeoHookeanSpec,
                                  MooneyRivlinSpec, HenckySpec, J2PlasticitySpec>;

}  // namespace abut
