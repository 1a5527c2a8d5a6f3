#pragma once

#include <vector>

#include "contract/waveform.hpp"

namespace abut {

/// The partner's moving surface, as this side sees it: what the body must not penetrate.
struct Obstacle {
  Waveform motion;             // partner's displacement u (and f unused), on this side's points
  // [m] (n, dim) reference position of the partner minus that of this side
  std::vector<double> offset;
  // keep contact also in tension: the coordinator locates the release itself
  bool bilateral = false;

  bool empty() const { return motion.empty(); }
};

/// The partner as a dashpot: with it, the port's force is that of BoundaryData::force minus
/// impedance x the port's velocity over each substep (positions at its ends over its length).
struct Impedance {
  double value = 0.0;     // [kg/s]; 0: absent
  bool bilateral = true;  // false: no pull

  bool empty() const { return value == 0.0; }
};

/// What is imposed on one port over one window. An empty part is absent: not imposed.
///  - motion:   Dirichlet, u, v, a are overwritten (published form; the reply's f is the internal
///              force)
///  - force:    Neumann, f acts on this body
///  - obstacle: one-body unilateral problem; the reply's f is the complete reaction, inertia
///              included
///  - impedance: beside force: resists the port's own motion; the reply's f is the whole force
///  - impulse:  [N s] (n, dim) once, at the window's begin
struct BoundaryData {
  Waveform motion;
  Waveform force;
  Obstacle obstacle;
  Impedance impedance;
  std::vector<double> impulse;

  void clear() {
    motion.clear();
    force.clear();
    obstacle.motion.clear();
    impedance = {};
    impulse.clear();
  }
  bool closed() const { return !motion.empty() || !force.empty() || !obstacle.empty(); }
};

}  // namespace abut
