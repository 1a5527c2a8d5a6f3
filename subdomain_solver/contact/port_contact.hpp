#pragma once

#include <string>
#include <vector>

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
  /// Appends the force on a partner's points [N].
  virtual void react(std::size_t port, std::size_t partner, const std::vector<double>& forces,
                     std::vector<double>& out) const = 0;
  /// Why an obstacle before the port cannot give way by a kernel; empty: it can.
  virtual std::string misfit(std::size_t port, const PortKernel& kernel) const = 0;
};

}  // namespace abut
