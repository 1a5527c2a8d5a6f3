#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "base/archive.hpp"
#include "contract/subdomain.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

/// A partner that a port has met.
struct Partner {
  PortGeometry surface;
  ContactLaw law;
  PortKernel kernel;  // empty: its surface gives way to nothing
};

/// What is asked for over a window, and how the body divides it.
struct Window {
  const Advance& request;
  Substeps grid;
  std::span<const std::deque<Partner>> partners;  // by port, in the order in which they were met
};

/// Motion and force of all points of all ports at one time, port after port (values) [SI units].
struct PortValues {
  std::vector<double> u, v, a, f;
};

/// What makes one body differ from another; the rest is Body's. Called as Body::advance shows.
class Interior {
 public:
  virtual ~Interior() = default;
  const Description& describe() const { return description_; }

  /// The one list of all that changes during a step.
  virtual void state(Archive& archive) = 0;
  /// Coordinates of the state; 0: its parts do not fit each other.
  virtual std::size_t coordinates() const = 0;
  /// The state came back: what follows from it.
  virtual void restored() {}

  /// Takes what is imposed over a window; the ports then show its begin.
  [[nodiscard]] virtual std::optional<Failed> begin(const Window&) { return std::nullopt; }
  /// Impulses and the first half of a step, which the ports do not show at the window's begin.
  virtual void set_off(const Window&) {}
  [[nodiscard]] virtual std::optional<Failed> step(const Window& window, int i) = 0;
  /// Displacements (substeps, values of all ports) [m] at the ends of the substeps of a window,
  /// told without going there. False: only a walk tells them.
  [[nodiscard]] virtual bool peek(const Window&, std::vector<double>&) { return false; }
  /// Whether where the body would go without its partners is worth the way.
  virtual bool looks_ahead() const { return true; }
  /// [N] of the last substep, along Description::loose motions.
  virtual std::span<const double> unbalanced() const { return {}; }
  /// By the present tangent of a body without inertia: [m] by which a force [N] on the ports moves
  /// them (values of all ports), at places [m] of its loose motions, and what is left over along
  /// these [N]. The state is left untouched. False: it has none.
  [[nodiscard]] virtual bool give(std::span<const double> /*force*/, const Eigen::VectorXd&,
                                  std::vector<double>& /*moved*/, Eigen::VectorXd& /*left*/) {
    return false;
  }
  /// Brings the state of the last substep to one time, for records.
  virtual void settle(const Window&, int) {}
  /// Ports now; the displacements alone, unless all is wanted for their traces at `time`.
  virtual const PortValues& see(const Window& window, double time, bool all) = 0;
  /// Points of a partner that react() is of, ascending, empty: all; more of them as the window goes
  /// on. Null: those that its obstacle lists.
  virtual const std::vector<std::int32_t>* reacting(std::size_t, std::size_t) const {
    return nullptr;
  }
  /// Appends the force on these points [N].
  virtual void react(std::size_t, std::size_t, std::vector<double>&) const {}
  /// Fills a record whose time is given. Values may be anything: Body looks at them.
  [[nodiscard]] virtual std::optional<Failed> record(BodyRecord& record) = 0;
  /// Completes a port's reply at the window's end: bounds, work, recoil.
  virtual void finish(std::size_t, PortResponse&) const {}

  /// A partner whose surface gives way: why the body cannot take its kernel; empty: it can.
  virtual std::string misfit(int, const PortKernel&) const { return "it takes none"; }
  /// How bodies tied to this one give way under forces on a port that touches.
  virtual void ease(int, const PortKernel&) {}
  virtual ForceSupport support(std::size_t) const { return ForceSupport::nodal; }
  /// The same of the reactions to obstacles.
  virtual ForceSupport reaction_support(std::size_t port) const { return support(port); }
  /// Quasi-static compliance of a port of one point [m/N]; 0: none.
  virtual double compliance(std::size_t) const { return 0.0; }
  /// A force [N] on a port to which the body answers linearly: probes press with it.
  virtual double light_force(std::size_t) const { return 1.0; }
  /// Puts the body at rest, a port held and loads away; true: one stays that moves it.
  virtual bool rest(std::size_t) { return false; }
  /// Brings the loads back; the state is restored by others.
  virtual void wake() {}

  /// Parts of 10 ms that a substep takes, about; always the same.
  virtual double effort() const { return 0.0; }
  /// A single substep may take seconds.
  virtual bool slow() const { return false; }
  virtual std::vector<double> measure() { return {}; }
  virtual Grid grid() = 0;
  virtual std::vector<FieldValues> fields() = 0;

 protected:
  Description description_;
};

}  // namespace abut
