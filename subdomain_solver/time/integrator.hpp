#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/outcome.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

class ImplicitDynamics;
class QuasiStatic;

/// Advances a problem's motion in time. Sees nothing of the body but its Model.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Makes what a motion needs beside q and v: accelerations, internal forces at the begin.
  [[nodiscard]] virtual std::optional<Failed> begin(Motion& motion, double time) = 0;
  /// From `time` to `time + dt`. When it fails, the motion is as before.
  [[nodiscard]] virtual std::optional<Failed> step(Motion& motion, double time, double dt) = 0;
  /// A load sets in or ends at the present time and changes the force by this much [N] (dofs):
  /// accelerations follow at once, and so do coordinates without mass. Schemes that keep neither
  /// have nothing to do.
  [[nodiscard]] virtual std::optional<Failed> jump(Motion&, double, const Vector&) {
    return std::nullopt;
  }
  /// An impulse [N s] (dofs) changes the velocities of free coordinates that have mass, and nothing
  /// else. What has no inertia takes none.
  virtual void strike(Motion&, const Vector& /*impulse*/) {}
  /// Whether accelerations are kept that forces of joined sides have no part in at the begin.
  virtual bool joins_steadily() const { return false; }
  /// Quasi-static compliance of a coordinate without mass [m/N]; 0: it has mass.
  virtual double compliance(const Motion&, int) { return 0.0; }
  /// [m/s^2] (dofs) at a time of the motion, prescribed coordinates included, as the balance of
  /// forces at this time has them; step [s]: of the scheme.
  virtual void acceleration(const Motion& motion, double time, double step, Vector& out) const = 0;
  /// Whether M v is behind the impulses of the forces so far.
  virtual bool lags() const { return false; }
  /// [kg m/s] (dofs) by how much, of a scheme that does, where `external` [N] (dofs) acts now; step
  /// [s]: of the scheme. With it momentum changes by the impulses to round-off [M.24].
  virtual void find_lag(const Motion&, double /*step*/, const Vector& /*external*/,
                        Vector& /*out*/) const {}
  /// Whether the body answers a force in time: statics do not.
  virtual bool has_inertia() const { return true; }
  /// Coordinates [m] (dofs) a step on, told without taking it. False: only a step tells them.
  [[nodiscard]] virtual bool peek(const Motion&, double /*time*/, double /*dt*/,
                                  std::vector<double>& /*q*/) {
    return false;
  }
  virtual QuasiStatic* statics() { return nullptr; }
  /// Where its tangent tells how it goes on.
  virtual ImplicitDynamics* implicit() { return nullptr; }
  /// [J] in the form that the scheme conserves where it conserves one.
  virtual double kinetic(const Motion& motion) const = 0;
  double stored(const Motion& motion) const { return motion.stored; }
  /// Numbers that sum up how the steps went, beside those of the body; SI units.
  virtual std::vector<std::string> measure_names() const { return {}; }
  virtual std::vector<double> measure(const Motion&) const { return {}; }
  /// Newton iterations of all steps so far, for people.
  int iterations() const { return iterations_; }

 protected:
  int iterations_ = 0;
};

}  // namespace abut
