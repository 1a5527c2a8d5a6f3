#pragma once

namespace abut {

/// Coulomb's law between two surfaces: along them a point holds at most a coefficient times what
/// presses. The coefficient holds for a whole substep and depends on what the point remembers of
/// the substep before, so that forces follow continuously from places [M.126].
struct FrictionLaw {
  // Of a point that stuck in the substep before, and of one that slid; 0: without friction.
  double static_friction = 0.0, kinetic_friction = 0.0;

  bool rubs() const { return static_friction > 0.0; }
  /// Whether the coefficient jumps when a point begins to slide. Which points slid is then told
  /// from sweep to sweep (Reaction::slid), or sweeps could go to and fro for ever.
  bool jumps() const { return static_friction != kinetic_friction; }
  /// What a point remembers of a substep; 0 where nothing pressed on it.
  double remember(bool slid) const { return slid ? 1.0 : 0.0; }
  double coefficient(double remembered) const {
    return remembered != 0.0 ? kinetic_friction : static_friction;
  }
};

}  // namespace abut
