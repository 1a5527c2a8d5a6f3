#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "contract/waveform.hpp"

namespace abut {

/// Energies of one body [J], in the form that its integrator conserves.
struct Energy {
  double kinetic = 0.0;
  double stored = 0.0;
  double dissipated = 0.0;     // by contact capture and material, counted positive
  double external_work = 0.0;  // done on the body by body forces and prescribed motion

  double total() const { return kinetic + stored; }
};

/// State of a member of a body, at the time of the body's record.
struct MemberRecord {
  Energy energy;                 // [J]
  std::vector<double> momentum;  // [kg m/s] (dim)
};

/// State of a body at one time, as a number or two.
struct BodyRecord {
  double time = 0.0;             // [s]
  Energy energy;                 // [J]; of all members and of what acts between them
  std::vector<double> momentum;  // [kg m/s] (dim)
  // [kg m^2/s] about the origin of space: one number in two dimensions, three in three; empty:
  // none, or not told
  std::vector<double> angular_momentum{};
  std::vector<MemberRecord> members{};  // in the order of Description::members
  std::vector<double> columns{};        // in the order of Description::columns
};

/// What an impulse on a port would do to the body now: it changes the velocity of what it hits,
/// which is the port's node or, behind a massless layer, its inner node.
struct Recoil {
  double velocity = 0.0;  // [m/s] of what it hits, along the outward normal
  double mobility = 0.0;  // [1/kg] change of that velocity per unit impulse; 0: immovable
};

/// What a body that met an obstacle does to the partner behind it.
struct Reaction {
  // [N] on the partner, on its points that the obstacle listed; where the obstacle is of all, on
  // some of them perhaps: nothing acts on the others
  Waveform force;
  double dissipated = 0.0;  // [J] by friction, since the run began
  // Where what sticks has a coefficient of its own: points of the body's port that count as sliding
  // at the ends of substeps but the last, ascending: (substep - 1) x points + point.
  std::vector<std::int32_t> slid{};
};

/// One port's reply to a window.
struct PortResponse {
  Waveform trace;                   // at the substeps, or at the records only (Sampling)
  std::vector<Reaction> reactions;  // by partner, to the obstacles of the request
  // Displacements (u) of all points over Advance::ahead, at the substeps; empty: not asked for, or
  // not told: bodies that meet obstacles with more than a point do not
  Waveform ahead;
  // [m] (records, dim) box that the points swept in each record's part of the window: positions
  std::vector<double> lower, upper;
  // [m/s] (dim) box of the velocities at which all points went from substep to substep over the
  // whole window; empty: not told, and no point was faster than speed_bound.
  std::vector<double> slowest, fastest;
  // Bound of the velocity at which a point may come while no partner touches, from the window's end
  // on: [m/s] along the outward normal (one point) or in any direction; infinity: unknown.
  double speed_bound = 0.0;
  double acceleration_bound = 0.0;  // [m/s^2] by which body forces may raise it
  std::optional<Recoil> recoil;     // only bodies that take impulses
  // [J] done on the body through the port over the window, impulses included: the change of the
  // energy that its integrator conserves [M.23], less what presses a wanted overlap in
  double work = 0.0;
};

/// A body's reply to a window. Reused between windows: buffers keep their memory.
struct Response {
  std::vector<PortResponse> ports;  // in the order of Description::ports
  std::vector<BodyRecord> records;
  // [N] (substeps, k) of what acts on the body along its loose motions: no equilibrium before it is
  // nothing. Empty: it has none.
  std::vector<double> unbalanced;
  int steps = 0;                 // substeps taken
  double compute_seconds = 0.0;  // wall time inside the solver; never decides anything
};

struct Advanced {};

/// The numbers' kind of error: a value, never an exception.
struct Failed {
  enum class Cause { no_convergence, inverted_element, step_too_small, non_finite };
  Cause cause = Cause::non_finite;
  double time = 0.0;  // [s]
  std::string detail;
};

using Outcome = std::variant<Advanced, Failed>;

const char* to_string(Failed::Cause cause);

}  // namespace abut
