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

/// What is imposed on one port over one window. An empty part is absent: not imposed.
///  - motion:   Dirichlet, u, v, a are overwritten (published form; the reply's f is the internal
///              force)
///  - force:    Neumann, f acts on this body
///  - obstacle: one-body unilateral problem; the reply's f is the complete reaction, inertia
///              included
///  - impulse:  [N s] (n, dim) once, at the window's begin
struct BoundaryData {
  Waveform motion;
  Waveform force;
  Obstacle obstacle;
  std::vector<double> impulse;

  void clear() {
    motion.clear();
    force.clear();
    obstacle.motion.clear();
    impulse.clear();
  }
  bool closed() const { return !motion.empty() || !force.empty() || !obstacle.empty(); }
};

}  // namespace abut
