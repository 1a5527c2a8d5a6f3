#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/fields.hpp"
#include "subdomain_solver/make/solid_spec.hpp"

namespace abut {

// What a scene says of a body's model: its shape, and what it is taken for.

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
               AbaqusSpec, ExodusSpec>
      mesh;
  Plane plane = Plane::strain;
  double thickness = 1.0;        // [m]
  std::vector<std::string> map;  // [m] where nodes of the mesh go; empty: they stay
  bool surface_alone = false;    // no key: a surface without cells is shape enough
  std::uint64_t digest = 0;      // no key: of the mesh's file where the scene is; 0: not known
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
/// How a tool turns, about a point that goes its way with it.
struct TurnSpec {
  std::vector<double> about;  // [m] (dim) where it is before it has moved; empty: the tool's origin
  std::vector<double> axis;   // in space, of any length
  std::string angle;          // [rad]
  void fields(Fields& f);
};
/// A shape that goes where it is told.
struct RigidToolSpec : SolidShapeSpec {
  static constexpr std::string_view name = "rigid_tool";
  RigidToolSpec() { surface_alone = true; }
  std::vector<std::string> way;  // [m] one expression per dimension; empty: it stands
  std::optional<TurnSpec> turn;
  std::optional<double> step;  // [s]; none: windows
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

}  // namespace abut
