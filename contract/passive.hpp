#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contract/outcome.hpp"

namespace abut {

// The passive way through a window [M.128]: what a body offers for it, and what it is asked.

/// One step of a body in its passive form: the midpoint rule (theta = 1/2) with all mass on the
/// nodes, under its own loads and supports, and with impulses on its ports and nothing else
/// there. Ports go straight from where they are to where they end.
struct PassiveStep {
  double begin = 0.0, end = 0.0;              // [s]
  std::vector<std::vector<double>> impulses;  // [N s] (ports; points x dim); a port's empty: none
  // (ports) points whose compliance is wanted, ascending
  std::vector<std::vector<std::int32_t>> pressed;
  // Of bodies without inertia: what holds them in the step is 4^-looser of what it is by itself.
  std::int32_t looser = 0;
  static constexpr std::int32_t loosest = 20;
  // The same step from the same state as the last one, under other impulses: a body that looks for
  // its answer may begin at the last one, and its reply may then depend on that.
  bool again = false;

  double length() const { return end - begin; }
};

struct PassiveReply {
  struct Port {
    // [m] (points x dim) by which the step moved the points; of a step of no length, which moves
    // nothing: where they are, from the reference configuration
    std::vector<double> displacement;
    std::vector<double> velocity;  // [m/s] (points x dim) at the step's end
  };
  std::vector<Port> ports;
  // [1/kg] (values, values), values = pressed points x dim, of all ports in their order:
  // what an impulse on one value adds to another one's mean velocity over the step, which is its
  // displacement over its length. Symmetric, positive semidefinite; of a body that is not linear
  // that of a tangent of the step, made definite. Of more values than most_whole a body may tell
  // (values) instead: the diagonal of one that is nowhere smaller, as of its mass alone. Impulses
  // are then found in more trials.
  std::vector<double> compliance;
  static constexpr std::size_t most_whole = 2400;  // of more it takes gigabytes, and as many solves
  bool bounds(std::size_t values) const {
    return values > most_whole && compliance.size() == values;
  }
  BodyRecord record;  // at the step's end; energy in the form that the midpoint rule conserves
  // [m] by which a point of a port leaves the straight way at most: of bodies that turn
  double bulge = 0.0;
  // Of bodies without inertia that contact alone holds: what held it in the step, as a part of the
  // forces on it, over what is allowed at the end of a run; 0 of all others
  double held = 0.0;
  double compute_seconds = 0.0;  // wall time inside the solver; never decides anything
};

/// A body in its passive form. Whether it is in it belongs to its state: Subdomain::restore takes
/// enter() and leave() back too. Nothing but the following is asked of a body that is in it, beside
/// save, restore, fields, measures, hashes and checkpoints.
class PassiveForm {
 public:
  virtual ~PassiveForm() = default;
  /// Puts all mass on the nodes: those of a massless surface take the velocity of what had theirs.
  /// Momentum stays; the energy [J] that is lost is returned.
  virtual double enter() = 0;
  /// Back to the body's own scheme. When it fails the body is as before.
  [[nodiscard]] virtual Outcome leave(double time, double& lost) = 0;
  /// From the present state through a step. start() returns at once; between it and finish()
  /// nothing else is called, and the step must live. When it fails the state is undefined: restore.
  virtual void start(const PassiveStep& step) = 0;
  [[nodiscard]] virtual Outcome finish(PassiveReply& reply) = 0;
  /// Takes so much energy [J] from the deformation's kinetic part, all of it where that is less;
  /// momentum and angular momentum stay. Returns what was taken.
  virtual double damp(double joules) = 0;
};

}  // namespace abut
