#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/archive.hpp"
#include "base/index.hpp"
#include "contract/outcome.hpp"
#include "subdomain_solver/bars/bar.hpp"

namespace abut {

/// What one end of a bar carries through time. Forces are compressive: they push the end inwards.
struct EndState {
  // An obstacle or a force acted in the last substep; of a kick layer: it pushed.
  bool closed = false;
  double force = 0.0;    // [N] contact force at the present time, as exchanged
  double dynamic = 0.0;  // [N] the force that moves the body: its mean over the dual cell
  double work = 0.0;     // [J] done on the bar by this end's force since the window began

  void state(Archive& archive);
};

/// Everything about a bar that changes during a step.
struct BarState {
  std::vector<double> u, v, a;  // [m] [m/s] [m/s^2] by node; v and a belong to the same time as u
  std::array<EndState, 2> end;

  void state(Archive& archive);
};

/// What happens at one end during one substep, at its end time unless said otherwise.
struct EndAction {
  enum class Kind { open, force, obstacle, motion };
  Kind kind = Kind::open;
  double force = 0.0;      // [N] compressive, at the substep's end (force)
  double dynamic = 0.0;    // [N] mean over the dual cell, or over the substep for kicks (force)
  double target = 0.0;     // [m] outward displacement of the obstacle's surface (obstacle)
  bool bilateral = false;  // keep contact in tension (obstacle)
  // Of a kick layer: the node counts as held even where no force acts (ties, probes).
  bool held = false;
  double yield = 0.0;  // [N/m] the surface pushes with `dynamic` and this x overlap; 0: it is hard
  double give = 0.0;   // [m/N] by which the target moves out under this substep's reaction
  double u = 0.0, v = 0.0, a = 0.0;  // prescribed (motion)
};
using EndActions = std::array<EndAction, 2>;

/// Forces on the nodes besides those on ports [N] (nodes), along x; empty: there are none.
struct NodeForces {
  std::vector<double> before;  // at the begin of the present substep
  std::vector<double> now;     // at its end; before the first one, at the begin of the run
};

/// Advances a bar by substeps. Every scheme is affine in the contact force of the substep: the
/// outward displacement of a closed end is x = x_free - C lambda (docs/METHOD.md, port line), so
/// that the one-body unilateral problem is solved in closed form.
///
/// A run of substeps is  open (substep)* close;  u, v and a belong to one time before open and
/// after close.
class BarIntegrator {
 public:
  explicit BarIntegrator(const Bar& bar) : bar_(bar) {}
  virtual ~BarIntegrator() = default;
  BarIntegrator(const BarIntegrator&) = delete;
  BarIntegrator& operator=(const BarIntegrator&) = delete;

  /// What loads do: to be set before everything else that is asked for.
  NodeForces& loads() { return loads_; }
  const NodeForces& loads() const { return loads_; }
  /// Completes a state of the start: places of massless ends and accelerations that are in balance
  /// with the loads and with obstacles at the ends.
  virtual void begin(BarState& state, const EndActions& actions) = 0;

  /// Starts a run of substeps: `opening` tells what acts at both ends at its first instant.
  virtual void open(BarState& state, double dt, const EndActions& opening) = 0;
  virtual void substep(BarState& state, double dt, const EndActions& actions) = 0;
  virtual void close(BarState& state, double dt) = 0;

  /// Displacement of an end as its partner sees it [m].
  virtual double port_displacement(const BarState& state, int end) const = 0;
  /// Quasi-static compliance of an end [m/N]; 0 where the contact node has mass.
  virtual double static_compliance(int end) const = 0;
  /// An impulse [N s] along x on an end. It hits the end's node or, where that has no mass, its
  /// inner node; its work goes to EndState::work.
  void strike(BarState& state, int end, double impulse) const;
  /// What an impulse on an end would meet.
  Recoil recoil(const BarState& state, int end) const;
  /// Internal force of an end node [N], along x.
  double internal_force(const BarState& state, int end) const;

  /// What is to be added to M v so that it changes by the impulse of the mean force over every
  /// substep, whatever the scheme's own weights [kg m/s]  [M.24].
  virtual double momentum_lag(const BarState&) const { return 0.0; }

  /// Energies that the scheme conserves [J].
  virtual double kinetic(const BarState& state) const = 0;
  virtual double stored(const BarState& state) const = 0;

 protected:
  bool is(int end, ContactLayer layer) const { return bar_.data().layer[end] == layer; }
  /// The published stabilisation: a massive contact node enters the next step without acceleration.
  void drop_acceleration(BarState& state, int end) const {
    const bool closed = state.end[end].closed;
    if (bar_.data().stabilised && closed && is(end, ContactLayer::massive))
      state.a[bar_.node_of(end)] = 0.0;
  }
  /// Node that an impulse on an end hits.
  std::size_t struck(int end) const;
  /// Velocities that a unit impulse on an end gives [1/kg], by node; empty: of the struck node
  /// alone, its inverse mass.
  virtual const std::vector<double>& blow(int) const { return no_blow_; }
  /// Records role changes; true when an end opened or closed since the last substep.
  bool update_closed(BarState& state, const EndActions& actions) const;

  const Bar& bar_;
  NodeForces loads_;

 private:
  const std::vector<double> no_blow_;
};

/// Compressive force that keeps x_free - C lambda at or inside the target: the unilateral problem
/// of one end.
double end_reaction(double free_position, double compliance, const EndAction& action);

}  // namespace abut
