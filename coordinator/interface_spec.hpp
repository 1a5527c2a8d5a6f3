#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "base/fields.hpp"

namespace abut {

// What a scene says of an interface: its sides, whether they touch or are tied, and how they
// exchange.

/// Coulomb's coefficient of what is called rough, and the largest: with more, what friction lifts
/// may lift what presses, and there are no forces that fit.
constexpr double rough_friction = 10.0;
struct ContactSpec {
  bool points = false;                    // "rows: mortar | point_to_surface"
  double friction = 0.0;                  // Coulomb's coefficient of surfaces that slide
  std::optional<double> static_friction;  // of those that stick; absent: the same
  void fields(Fields& f);
};
/// Contact between any two surfaces of a scene.
struct SceneContactSpec {
  ContactSpec everything;
  void fields(Fields& f);
};
/// Its key, and the name of its interface in what a run tells.
constexpr std::string_view everything_path = "contact.everything", everything_name = "everything";

/// Bodies that take the same place at their sides, each side inside the other body.
struct OverlapSpec {
  bool doubled = false;      // "material: halves | doubled"
  bool motions = false;      // "exchange: forces | motions"
  bool alternating = false;  // "answer: together | alternating"
  bool unstable = false;     // motions alone where they are known to gain energy
  void fields(Fields& f);
};
struct TiedSpec {  // joined from the start, for the whole run
  bool finer = false;  // "steps: coarser | finer"
  std::optional<OverlapSpec> overlap;  // absent: their sides meet
  void fields(Fields& f);
};
/// [MiB] of the port kernel of a surface, where the scene does not say.
constexpr double usual_kernel_memory = 512.0;
/// Default: the kinematic side solves a unilateral problem against the partner's moving surface.
struct UnilateralTransmission {
  static constexpr std::string_view name = "unilateral";
  std::string kinematic = "auto";       // body.port, or auto: by probe
  std::optional<double> kernel_memory;  // [MiB] of surfaces; absent: usual_kernel_memory
  void fields(Fields& f);
};
/// The published form: motion overwritten on one side, internal force handed to the other.
struct DirichletNeumannTransmission {
  static constexpr std::string_view name = "dirichlet_neumann";
  std::string dirichlet;          // body.port
  bool swap_every_window = true;  // as published
  bool impact_projection = false;
  void fields(Fields& f);
};

/// Both sides belong to one body, which solves their contact itself: watched, never iterated.
struct InternalTransmission {
  static constexpr std::string_view name = "internal";
  void fields(Fields&) {}
};
/// Robin conditions on both sides: each sees its partner as a dashpot with the partner's force.
struct RobinTransmission {
  static constexpr std::string_view name = "robin";
  std::string impedance = "matched";  // matched | kernel | a number [kg/s]
  double number = 0.0;                // [kg/s], where a number is given
  void fields(Fields& f);
};

struct InterfaceSpec {
  std::string name;
  std::array<std::string, 2> sides;    // body.port
  std::optional<ContactSpec> contact;  // exactly one of these two
  std::optional<TiedSpec> tied;
  std::variant<UnilateralTransmission, DirichletNeumannTransmission, InternalTransmission,
               RobinTransmission>
      transmission;
  void fields(Fields& f);
};

}  // namespace abut
