#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "contract/hand_over.hpp"
#include "contract/subdomain.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

class PassiveBody;
class PortForecast;
class PortStatics;

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
  // By port: how bodies that are tied to this one give way under forces on it; empty: they do not.
  std::span<const PortKernel> neighbours;
};

/// Motion and force of all points of all ports at one time, port after port (values) [SI units].
struct PortValues {
  std::vector<double> u, v, a, f;
};

/// A body whose ports can be pressed from rest: it answers for their kernels.
class Probed {
 public:
  /// Quasi-static compliance of a port of one point [m/N]; 0: none.
  virtual double compliance(std::size_t port) const = 0;
  /// A force [N] on a port to which the body answers linearly: probes press with it.
  virtual double light_force(std::size_t port) const = 0;
  /// Puts the body at rest, a port held and loads away; true: one stays that moves it.
  virtual bool rest(std::size_t port) = 0;
  /// Brings the loads back; the state is restored by others.
  virtual void wake() = 0;

 protected:
  ~Probed() = default;
};

/// A body whose ports take obstacles, and react to them.
class Obstructed {
 public:
  /// Why the body cannot take the kernel of a surface that gives way; empty: it can.
  virtual std::string misfit(int port, const PortKernel& kernel) const = 0;
  /// Points of a partner that react() is of, ascending, empty: all; more of them as the window goes
  /// on. Null: those that its obstacle lists.
  virtual const std::vector<std::int32_t>* reacting(std::size_t port,
                                                    std::size_t partner) const = 0;
  /// Appends the force on these points [N].
  virtual void react(std::size_t port, std::size_t partner, std::vector<double>& force) const = 0;

 protected:
  ~Obstructed() = default;
};

/// A body that goes on where the same body has come to by another scheme.
class Successor {
 public:
  /// What has left the state: the body's own scheme, statics, in which it stood in balance, or
  /// another scheme of motion.
  enum class Before { own, statics, motion };
  /// Reads that state, in which contact and ties may press. Throws RunError where it cannot go on.
  virtual void take_over(Archive& archive, Before before) = 0;
  /// The same from another model or mesh of the body. Throws RunError.
  virtual void take_from(const HandOver& handed) = 0;

 protected:
  ~Successor() = default;
};

/// What makes one body differ from another; the rest is Body's. Called as Body::advance shows.
class Interior {
 public:
  /// What only some bodies can do, as objects; null: this one cannot.
  struct Abilities {
    Probed* probed = nullptr;
    Obstructed* obstructed = nullptr;
    PortForecast* forecast = nullptr;  // tells where ports go without going there
    PortStatics* statics = nullptr;    // answers of a body without inertia
    PassiveBody* passive = nullptr;    // it has a passive form
    Successor* successor = nullptr;    // it may have another scheme in every stage
  };
  /// What never changes, beside the description.
  struct Traits {
    std::vector<ForceSupport> support;   // by port, of its forces; empty: all nodal
    std::vector<ForceSupport> reaction;  // by port, of reactions to obstacles; empty: as its forces
    double effort = 0.0;                 // parts of 10 ms that a substep takes, about
    bool slow = false;                   // a single substep may take seconds
    std::string scheme;  // what moves it: states of others are not read; empty: always the same
    std::string basis;        // what its coordinates mean beside the mesh; empty: places of nodes
    bool looks_ahead = true;  // where it goes without its partners is worth the way
  };

  Interior() = default;
  virtual ~Interior() = default;
  Interior(const Interior&) = delete;
  Interior& operator=(const Interior&) = delete;
  const Description& describe() const { return description_; }
  const Abilities& able() const { return able_; }
  const Traits& traits() const { return traits_; }
  ForceSupport support(std::size_t port) const {
    return traits_.support.empty() ? ForceSupport::nodal : traits_.support[port];
  }
  ForceSupport reaction_support(std::size_t port) const {
    return traits_.reaction.empty() ? support(port) : traits_.reaction[port];
  }

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
  /// The window's substep i, from 1. `whole`: all of the state is of one time behind it, for a
  /// record.
  [[nodiscard]] virtual std::optional<Failed> step(const Window& window, int i, bool whole) = 0;
  /// Ports now; the displacements alone, unless all is wanted for their traces at `time`.
  virtual const PortValues& see(const Window& window, double time, bool all) = 0;
  /// Fills a record whose time is given. Values may be anything: Body looks at them.
  [[nodiscard]] virtual std::optional<Failed> record(BodyRecord& record) = 0;
  /// Completes a port's reply at the window's end: bounds, work, recoil.
  virtual void finish(std::size_t, PortResponse&) const {}

  virtual std::vector<double> measure() { return {}; }
  virtual Grid grid() = 0;
  virtual std::vector<FieldValues> fields() = 0;

 protected:
  Description description_;
  Abilities able_;
  Traits traits_;
};

}  // namespace abut
