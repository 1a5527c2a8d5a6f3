#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "contract/friction_law.hpp"
#include "contract/waveform.hpp"

namespace abut {

/// What joins two ports: with which law a body meets its partner's surface (Meeting).
struct ContactLaw {
  bool tied = false;  // holds in tension too, and any gap of the references counts as none
  // Of surfaces: each node of the body that finds contact for itself, instead of averages [M.95].
  bool points = false;
  FrictionLaw friction = {};  // of surfaces
};

/// The partner's moving surface, on the partner's own points: what the body must not penetrate, or,
/// where the law ties, what it must follow. The body that takes it knows the surface and the law
/// (Subdomain::meet); it finds gaps, solves its own unilateral problem, and replies with the
/// reaction on the same points.
///
/// The surface gives way where its port kernel was given (Meeting::kernel):
///   y = motion.u + kernel * (reaction - motion.f)
/// with motion.f the force on the partner under which motion.u was found, both of its last reply
/// [M.91].
struct Obstacle {
  Waveform motion;  // the partner's displacement u, and f where its surface gives way
  // Where what sticks has a coefficient of its own: points of the body's port that count as sliding
  // at the ends of substeps, because they slid in earlier sweeps, as Reaction::slid lists them.
  std::vector<std::int32_t> slid;

  bool empty() const { return motion.empty(); }
  /// Forgets the values and keeps the memory.
  void clear() {
    motion.clear();
    slid.clear();
  }
};

/// The partner as a dashpot: with it, the port's force is that of BoundaryData::forces minus
/// impedance x the port's velocity over each substep (positions at its ends over its length).
struct Impedance {
  double value = 0.0;     // [kg/s]; 0: absent
  bool bilateral = true;  // false: no pull

  bool empty() const { return value == 0.0; }
};

/// What is imposed on one port over one window. An empty part is absent: not imposed.
///  - motion:    Dirichlet, u, v, a are overwritten (published form; the reply's f is the internal
///               force)
///  - forces:    Neumann, by partner, on this port's points; their sum acts on this body
///  - obstacles: one-body unilateral problem against partners, by partner; the reply's f is the
///               complete reaction, inertia included
///  - impedance: beside forces: resists the port's own motion; the reply's f is the whole force
///  - impulse:   [N s] (n, dim) once, at the window's begin
///  - balanced:  beside obstacles, f on this port's points: the port's force f that the forces of
///               the ties at the body's other ports balance, of the reply under which they were
///               found. With the kernel of the own surface, how the bodies tied to this one respond
///               to f - balanced.f [M.121]. Absent: they do not
/// Partners are numbered as the port met them (Subdomain::meet); of those that do nothing the entry
/// is empty or missing.
struct BoundaryData {
  Waveform motion;
  std::vector<Waveform> forces;
  std::vector<Obstacle> obstacles;
  Waveform balanced;
  Impedance impedance;
  std::vector<double> impulse;

  /// Forgets the values and keeps the memory.
  void clear() {
    motion.clear();
    for (Waveform& force : forces) force.clear();
    for (Obstacle& obstacle : obstacles) obstacle.clear();
    balanced.clear();
    impedance = {};
    impulse.clear();
  }
  bool pushed() const {
    return std::any_of(forces.begin(), forces.end(), [](const Waveform& f) { return !f.empty(); });
  }
  bool obstructed() const {
    return std::any_of(obstacles.begin(), obstacles.end(),
                       [](const Obstacle& o) { return !o.empty(); });
  }
  bool closed() const { return !motion.empty() || pushed() || obstructed(); }
};

}  // namespace abut
