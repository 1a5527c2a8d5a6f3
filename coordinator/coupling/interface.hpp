#pragma once

#include <array>
#include <limits>
#include <string>

#include "base/archive.hpp"
#include "base/index.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/side.hpp"

namespace abut {

/// Two joined ports and the state of what joins them. One point on each side: the bodies are bars.
struct Interface {
  std::string name;
  std::array<Side, 2> sides;
  std::array<double, 2> normal = {0.0, 0.0};  // outward, +1 or -1
  double reference_gap = 0.0;                 // [m] along the normal of side 0, reference positions
  bool bilateral = false;                     // tied: holds in tension too
  int kinematic = 0;                          // index of the kinematic (Dirichlet) side
  // What contact carries from window to window:
  bool closed = false;    // iterated: its sides are so near that they may press
  bool pressed = false;   // told of as closed, and not of as open since
  bool touching = false;  // contact inside a body presses: nothing is iterated
  double opened_at = -std::numeric_limits<double>::infinity();  // [s] last release of a kick layer
  // Where the push that goes on began [s], and how fast its sides met [m/s].
  double touched_at = 0.0, touch_speed = 0.0;
  double closing_speed = 0.0;    // [m/s] against which the iteration is measured
  double force_scale = 0.0;      // [N] largest contact force since it closed
  double debt = 0.0;             // [J] that contact has taken from the bodies and owes them  [M.25]
  double rebound_impulse = 0.0;  // [N s] that a release now would give back
  double impulse = 0.0;          // [N s] pushing the sides apart, at the next window's begin

  void state(Archive& archive);

  const Side& kinematic_side() const { return sides[index(kinematic)]; }
  const Side& neumann_side() const { return sides[index(1 - kinematic)]; }
  double normal_of(int side) const { return normal[index(side)]; }
  /// Reference position of the partner minus that of this side [m].
  double offset(int side) const { return reference_gap * normal_of(side); }
  /// Gap [m] for displacements of side 0 and side 1; negative when overlapping.
  double gap(double u0, double u1) const { return reference_gap + normal[0] * (u1 - u0); }
};

/// Ends of bars are sums of what scenes say: an overlap of this share of a coordinate is no gap.
constexpr double place_rounding = 4.0 * std::numeric_limits<double>::epsilon();
/// Of the coarser mesh: an overlap at the start below it is none.
constexpr double place_tolerance = 1.0e-9;

/// Builds an interface of two ports. Throws InputError when they do not face each other or overlap
/// at the start.
Interface make_interface(std::string name, std::array<Side, 2> sides, const Bodies& bodies);

/// Index of the stored time at which a window begins: the last one of the window before, or the
/// first one of an attempt at the same window.
inline std::size_t index_at_begin(const Waveform& trace, double begin) {
  return trace.time.back() <= begin ? trace.size() - 1 : 0;
}

/// Trace of a side in the latest responses.
inline const Waveform& trace_of(const Bodies& bodies, const Side& side) {
  return bodies.response(side.body).ports[index(side.port)].trace;
}

}  // namespace abut
