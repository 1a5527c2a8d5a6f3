#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "base/fields.hpp"
#include "contract/friction_law.hpp"
#include "coordinator/transmission_spec.hpp"

namespace abut {

// What a scene says of an interface: its sides, whether they touch or are tied, and how they
// exchange.

struct ContactSpec {
  bool points = false;                // "rows: mortar | point_to_surface"
  FrictionLaw friction;               // of surfaces
  std::optional<double> restitution;  // of rigid bodies; absent: none
  void fields(Fields& f);
};
/// Coulomb's coefficient of what slides: the only one of the passive way [M.132].
inline double sliding(const ContactSpec& law) {
  return law.friction.coefficient(law.friction.remember(true));
}
/// Of what sticks.
inline double holding(const ContactSpec& law) {
  return law.friction.coefficient(law.friction.remember(false));
}
/// Contact that is not written pair by pair.
struct SceneContactSpec {
  std::optional<ContactSpec> everything;  // between any two surfaces; absent: interfaces say it
  bool self = true;                       // of bodies with themselves
  std::optional<double> self_friction;    // absent: that of everything, or none
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
struct TiedSpec {                      // joined from the start, for the whole run
  bool finer = false;                  // "steps: coarser | finer"
  std::optional<OverlapSpec> overlap;  // absent: their sides meet
  void fields(Fields& f);
};

struct InterfaceSpec {
  std::string name;
  std::array<std::string, 2> sides;    // body.port
  std::optional<ContactSpec> contact;  // exactly one of these two
  std::optional<TiedSpec> tied;
  TransmissionSpec transmission;
  void fields(Fields& f);
};

}  // namespace abut
