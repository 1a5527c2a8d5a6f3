#pragma once

#include <optional>

#include "contract/outcome.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

class Foreseeing;
class Inertia;
class MasslessLayer;
class MomentumLag;
class QuasiStatic;
class StableSteps;

/// Advances a problem's motion in time. Sees nothing of the body but its Model.
class Integrator {
 public:
  /// What schemes can do beyond steps, as objects; null: this one cannot. They live as long as the
  /// integrator. Whoever wraps an integrator hands on all that it does not replace.
  struct Abilities {
    Inertia* inertia = nullptr;         // forces change velocities; null: statics
    MasslessLayer* layer = nullptr;     // null: every coordinate has mass
    Foreseeing* foreseeing = nullptr;   // tells the next step without taking it
    const MomentumLag* lag = nullptr;   // null: M v changes by the impulses of the forces
    QuasiStatic* statics = nullptr;     // null: the body has inertia
    const StableSteps* held = nullptr;  // steps are held below their stable limit
    // Accelerations are stored between steps, and forces of ties have no part in them [M.105].
    bool accelerates_without_ties = false;
  };

  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  const Abilities& able() const { return able_; }

  /// Makes what a motion needs beside q and v: accelerations, internal forces at the begin.
  [[nodiscard]] virtual std::optional<Failed> begin(Motion& motion, double time) = 0;
  /// From `time` to `time + dt`. When it fails, the motion is as before.
  [[nodiscard]] virtual std::optional<Failed> step(Motion& motion, double time, double dt) = 0;
  /// [m/s^2] (dofs) at a time of the motion, prescribed coordinates included, as the balance of
  /// forces at this time has them; step [s]: of the scheme; external [N] (dofs): all forces from
  /// outside at this time, so that a body which has come back to a state need not know its window.
  virtual void acceleration(const Motion& motion, double time, double step, const Vector& external,
                            Vector& out) const = 0;
  /// [J] in the form that the scheme conserves where it conserves one.
  virtual double kinetic(const Motion& motion) const = 0;
  double stored(const Motion& motion) const { return motion.stored; }
  /// Newton iterations of all steps so far, for people.
  int iterations() const { return iterations_; }

 protected:
  explicit Integrator(const Abilities& able) : able_(able) {}
  int iterations_ = 0;

 private:
  Abilities able_;
};

}  // namespace abut
