#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>

#include "base/archive.hpp"
#include "base/index.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/coupling/bodies.hpp"

namespace abut {

class Exchange;
class Watch;

/// The side of a joint that is advanced against the other one's surface, and who chose it.
struct Role {
  int kinematic = 0;   // index of the kinematic (Dirichlet) side
  bool fixed = false;  // by the scene, or for the rest of the run; else it is still to be chosen
  int adjusted = -1;   // side whose surface was moved onto the other's; -1: none
  int fitted = -1;     // side that grows its overlap with the other one; -1: none
};

/// Two points on a line, the ends of bars. Ports of surfaces have none of this.
struct PointGap {
  std::array<double, 2> normal = {0.0, 0.0};  // outward, +1 or -1
  double reference_gap = 0.0;  // [m] along the normal of side 0, between reference positions
};

/// What contact carries from window to window, whatever is in contact.
struct ContactState {
  /// Contact goes through its stages one by one: apart, near, pressing, and back.
  enum class Stage {
    apart,     // not iterated
    near,      // so near that the sides may press: iterated
    pressing,  // reported as closed, and not as open since
  };
  Stage stage = Stage::apart;
  double closing_speed = 0.0;  // [m/s] against which the iteration is measured
  double force_scale = 0.0;    // [N] largest contact force since the joint closed
  double impulse = 0.0;        // [N s] pushing the sides apart, at the next window's begin
  // [J] by friction since the run began, by side that found it, in accurate windows
  std::array<double, 2> rubbed{};

  void state(Archive& archive);
};

/// Two joined ports: what they exchange (Exchange), and when contact begins and ends (Watch).
struct Joint {
  Joint();
  ~Joint();
  Joint(Joint&&) noexcept;
  Joint& operator=(Joint&&) noexcept;

  std::string name;
  int interface = 0;  // of the scene's, which has one joint, or one of every pair that came near
  std::array<Side, 2> sides;
  Role role;
  PointGap line;
  double fit = 0.0;                    // [m] interference that is wanted, as it is drawn
  std::unique_ptr<Exchange> exchange;  // null: contact inside a body, which exchanges nothing
  std::unique_ptr<Watch> watch;
  ContactState contact;

  /// What contact has done, whatever is recorded of it.
  void state(Archive& archive);
  /// What the exchange and the watch remember beside, of how the run came here.
  void memory(Archive& archive);

  // Transitions of contact.
  void engage(double speed);  // the sides met at a speed [m/s]: iterated from now on
  void press() { contact.stage = ContactState::Stage::pressing; }
  void release() { contact.stage = ContactState::Stage::near; }
  void disengage() { contact.stage = ContactState::Stage::apart; }

  bool tied() const;      // one from the start to the end
  bool deciding() const;  // iterated, and every substep decides whether its sides press
  bool pressing() const { return contact.stage == ContactState::Stage::pressing; }
  /// Whether its sides are iterated.
  bool closed() const { return contact.stage != ContactState::Stage::apart && exchange != nullptr; }

  const Side& kinematic_side() const { return sides[role.kinematic]; }
  const Side& neumann_side() const { return sides[1 - role.kinematic]; }

  // Of points on a line.
  double normal_of(int side) const { return line.normal[side]; }
  /// Reference position of the partner minus that of this side [m].
  double offset(int side) const { return line.reference_gap * normal_of(side); }
  /// Gap [m] for displacements of side 0 and side 1; negative when overlapping.
  double gap(double u0, double u1) const { return line.reference_gap + line.normal[0] * (u1 - u0); }
};

/// Ends of bars are sums of what scenes say: an overlap of this share of a coordinate is no gap.
constexpr double place_rounding = 4.0 * std::numeric_limits<double>::epsilon();
/// Of the coarser mesh: an overlap at the start below it is none.
constexpr double place_tolerance = 1.0e-9;
/// The same: places this near to each other coincide.
constexpr double coincidence = 1.0e-6;

/// Two ends of bars that may touch. Throws InputError when they do not face each other, overlap at
/// the start, or are not one point each.
Joint make_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies);

/// Two surfaces that may touch; exchange and watch are given by what joins them. Throws InputError
/// when they cannot.
Joint make_surface_joint(std::string name, std::array<Side, 2> sides, const Bodies& bodies);

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
