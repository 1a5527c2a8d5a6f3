#pragma once

#include <functional>
#include <vector>

#include "base/archive.hpp"
#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/time/contact.hpp"

namespace abut {

/// A port that is a surface of nodes of a mesh. Its geometry must outlive it.
struct PortSurface {
  std::size_t port = 0;
  std::size_t first = 0;  // of its values among those of all ports
  const PortGeometry* geometry = nullptr;
  std::vector<std::int32_t> nodes;  // by point
};

/// What the ports of a solid meet. Forces are on the body, (port values) as those of PortMap [N].
class PortContact : public Contact {
 public:
  /// What changes during a step beside the forces on ports.
  virtual void state(Archive&) {}
  /// Takes what is imposed over a window.
  virtual void impose(const Window& window) = 0;
  virtual bool acts() const = 0;                  // an obstacle is there in this window
  virtual bool acts(std::size_t port) const = 0;  // before this port
  virtual bool has(std::size_t port) const = 0;   // the port may meet obstacles
  /// What presses at the window's begin goes on pressing, where the obstacle stays: to the forces
  /// of partners `now`. `forces`: all that act at the end of the window before.
  virtual void hold(const std::vector<double>& forces, std::vector<double>& now) const = 0;
  /// The window's substep i is next, 0: its begin. `forces`: all that act now; `places`: [m] (port
  /// values) displacements now.
  virtual void aim(int i, const std::vector<double>& forces, const std::vector<double>& places) = 0;
  /// The substep is done: puts what was solved for last to the forces of partners.
  virtual void settle(std::vector<double>& forces) = 0;
  /// Points of a partner that react() is of in this window, ascending, empty: all; more of them as
  /// the window goes on. Null: those that its obstacle lists.
  virtual const std::vector<std::int32_t>* reacting(std::size_t, std::size_t) const {
    return nullptr;
  }
  /// Appends the force on these points [N].
  virtual void react(std::size_t port, std::size_t partner, const std::vector<double>& forces,
                     std::vector<double>& out) const = 0;
  /// Completes the reply to an obstacle at the window's end: what friction did.
  virtual void finish(std::size_t /*port*/, std::size_t /*partner*/, Reaction&) const {}
  /// [J] by friction with all partners, since the run began.
  virtual double dissipated() const { return 0.0; }
  /// Calls `see` with the points of a port that have something near, the gaps [m] there, and
  /// whether friction holds them.
  using SeeGap = std::function<void(std::size_t point, double gap, bool sticks)>;
  virtual void see_gaps(std::size_t, const SeeGap&) const {}
  /// Why an obstacle before the port cannot give way by a kernel; empty: it can.
  virtual std::string misfit(std::size_t port, const PortKernel& kernel) const = 0;
  /// How bodies that are tied to this one give way under forces on the port.
  virtual void ease(std::size_t, const PortKernel&) {}
};

}  // namespace abut
