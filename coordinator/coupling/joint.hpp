#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/index.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/coupling/bodies.hpp"

namespace abut {

class Transmission;

/// When it is decided whether the sides of a joint press on each other.
enum class Decision {
  every_substep,  // by the kinematic body
  window_begin,   // by the coordinator: the published form
  inside,         // both sides are ports of one body: watched, never iterated
  never,          // tied, from the start to the end
};

/// Two joined ports: what joins them, how they exchange, and what contact carries from window to
/// window.
class Joint {
 public:
  /// Contact goes through its states one by one: apart, near, pressing, and back.
  enum class State {
    apart,     // not iterated
    near,      // so near that the sides may press: iterated
    pressing,  // told of as closed, and not of as open since
  };

  Joint();
  ~Joint();
  Joint(Joint&&) noexcept;
  Joint& operator=(Joint&&) noexcept;

  std::string name;
  int interface = 0;  // of the scene's, which has one joint, or one of every pair that came near
  bool met = false;   // the bodies know of each other, and the sides' partners are numbered
  std::array<Side, 2> sides;
  bool surfaces = false;  // in two and three dimensions: they touch anywhere, one body maps them
  // Of surfaces: rows of single points; Coulomb's coefficients of what sticks and what slides.
  bool points = false;
  double static_friction = 0.0, kinetic_friction = 0.0;
  std::vector<double> jump;  // [m] of joined surfaces: their displacements' at the start, by rows
  double margin = 0.0;    // [m] of surfaces: rows of facets may press before these touch
  int width = 1;          // values of a port's motion: points x dimension; of surfaces not used
  // Of one point: outward, +1 or -1. Of surfaces tied point by point: the signs with which their
  // components are compared.
  std::array<double, 2> normal = {0.0, 0.0};
  double reference_gap = 0.0;         // [m] along the normal of side 0, reference positions
  std::unique_ptr<Transmission> how;  // null: contact inside a body
  Decision decision = Decision::every_substep;
  int kinematic = 0;        // index of the kinematic (Dirichlet) side
  bool role_fixed = false;  // by the scene; else by probe
  int adjusted = -1;        // side whose surface was moved onto the other's; -1: none
  bool roles_swap = false;  // published form: after every window in contact
  bool projection = false;  // published form: plastic impact of the contact nodes at first touch

  /// How near surfaces were when a window or a flight began.
  struct Approach {
    double apart = 0.0;  // [m] from below
    double speed = 0.0;  // [m/s] at which they may close; infinity: unknown
  };
  Approach approach;

  // What contact carries from window to window:
  State contact = State::apart;
  double opened_at = -std::numeric_limits<double>::infinity();  // [s] last release of a kick layer
  // Where the push that goes on began [s], and how fast its sides met [m/s].
  double touched_at = 0.0, touch_speed = 0.0;
  double closing_speed = 0.0;    // [m/s] against which the iteration is measured
  double force_scale = 0.0;      // [N] largest contact force since it closed
  double debt = 0.0;             // [J] that contact has taken from the bodies and owes them  [M.25]
  double rebound_impulse = 0.0;  // [N s] that a release now would give back
  double impulse = 0.0;          // [N s] pushing the sides apart, at the next window's begin

  void state(Archive& archive);

  // Transitions of contact.
  void engage(double speed);  // the sides met at a speed [m/s]: iterated from now on
  void press() { contact = State::pressing; }
  void release() { contact = State::near; }
  void disengage() { contact = State::apart; }

  bool tied() const { return decision == Decision::never; }
  bool unilateral() const { return decision == Decision::every_substep; }
  bool pressing() const { return contact == State::pressing; }
  /// Whether its sides are iterated.
  bool closed() const { return contact != State::apart && decision != Decision::inside; }
  /// Whether its contact is in the iteration and every substep decides for itself.
  bool deciding() const { return unilateral() && closed(); }

  const Side& kinematic_side() const { return sides[kinematic]; }
  const Side& neumann_side() const { return sides[1 - kinematic]; }
  double normal_of(int side) const { return normal[side]; }
  /// Reference position of the partner minus that of this side [m].
  double offset(int side) const { return reference_gap * normal_of(side); }
  /// Gap [m] for displacements of side 0 and side 1; negative when overlapping.
  double gap(double u0, double u1) const { return reference_gap + normal[0] * (u1 - u0); }
};

/// Ends of bars are sums of what scenes say: an overlap of this share of a coordinate is no gap.
constexpr double place_rounding = 4.0 * std::numeric_limits<double>::epsilon();
/// Of the coarser mesh: an overlap at the start below it is none.
constexpr double place_tolerance = 1.0e-9;
/// The same: places this near to each other coincide.
constexpr double coincidence = 1.0e-6;

/// Two ports that are to be joined. Throws InputError when they do not face each other or overlap
/// at the start; surfaces of several points when the points of one are not those of the other.
Joint make_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies);

/// Two surfaces that may touch. Throws InputError when they cannot.
Joint make_surface_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies);

/// Tells the bodies whom their ports may meet, between windows, and numbers the partners.
void introduce(Joint& joint, Bodies& bodies);

/// Index of the stored time at which a window begins: the last one of the window before, or the
/// first one of an attempt at the same window.
inline std::size_t index_at_begin(const Waveform& trace, double begin) {
  return trace.time.back() <= begin ? trace.size() - 1 : 0;
}

/// Reply of a side in the latest responses, and its trace.
inline const PortResponse& port_of(const Bodies& bodies, const Side& side) {
  return bodies.response(side.body).ports[side.port];
}
inline const Waveform& trace_of(const Bodies& bodies, const Side& side) {
  return port_of(bodies, side).trace;
}

}  // namespace abut
