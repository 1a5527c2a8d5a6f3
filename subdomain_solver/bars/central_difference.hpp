#pragma once

#include <vector>

#include "subdomain_solver/bars/bar_integrator.hpp"

namespace abut {

/// Explicit central difference with lumped mass, kick-drift form [M.2].
///
/// With `terms` P > 1 the internal force is K u~, u~ = u + c2 D u + c3 D^2 u + ..., D = (h/c)^2
/// M^-1 K, which removes the dispersion of the lumped bar up to order 2P; P = 2 is the averaged
/// mass to leading order.
/// Bulk viscosity b adds the dashpot b rho c A to every element, driven by the velocity of the last
/// half step; the element of a massless port has none.
/// Tchamwa and Wielgosz: the drift goes on by (phi - 1) dt^2 a, a of the step's begin, so that a
/// mode loses the part ((phi - 1) / 2) (omega dt)^2 of its size in a step.
/// Conserved without it: 1/2 v M v + 1/2 u K u~ - dt^2/8 a M a at the nodal times, which is the
/// staggered energy 1/2 v(-) M v(+) + 1/2 u K u~ between them.
class CentralDifference final : public BarIntegrator {
 public:
  CentralDifference(const Bar& bar, double step, int terms);

  void begin(BarState& state, const EndActions& actions) override;
  void open(BarState& state, double dt, const EndActions& opening) override;
  void substep(BarState& state, double dt, const EndActions& actions) override;
  void close(BarState& state, double dt) override;
  double port_displacement(const BarState& state, int end) const override;
  double static_compliance(int end) const override;
  double kinetic(const BarState& state) const override;
  double stored(const BarState& state) const override;

 private:
  struct End {
    double compliance = 0.0;  // C of a grounded massless port [m/N]
    double spring = 0.0;      // stiffness of the contact element [N/m]
    // u~ for a unit displacement of the port, (nodes) from the port inwards
    std::vector<double> response;
    double velocity_before = 0.0;  // [m/s] outward, before the substep's kick
  };

  /// A node near an end, whose row of K and M differs from the interior ones.
  struct Row {
    std::size_t node = 0, before = 0, after = 0;  // neighbours; where there is none, the node
    double left = 0.0, right = 0.0;  // stiffness of the elements beside it [N/m]; 0: none
    double inverse_mass = 0.0;       // [1/kg]
    double smoothing = 0.0;          // [m/N] (h/c)^2 of it

    double force(const double* x) const {  // of K x [N]; no branches: every pass asks
      return 0.0 + left * (x[node] - x[before]) - right * (x[after] - x[node]);
    }
  };

  struct Smoothing {  // the places of two passes, one of which holds the answer
    std::vector<double> a, b;
  };

  void kick_drift(BarState& state, double kick, double dt);
  void drift(BarState& state, double dt);
  void kick_end_nodes(BarState& state, const double* s, double kick);
  void drift_end_nodes(BarState& state, double dt);
  void push_on(BarState& state, double kick, double dt) const;
  double* smooth(const BarState& state, const std::vector<double>& u, Smoothing& places) const;
  void acceleration(BarState& state, const std::vector<double>& load);
  void close_under(BarState& state, double dt, const std::vector<double>& load);
  void kick_nodes_with(BarState& state, double kick) const;
  void place_massless(BarState& state, int end, const EndAction& action, double dt);
  void resolve_massless(BarState& state, const EndActions& actions, double dt);
  void resolve_massive(BarState& state, int end, const EndAction& action);
  void resolve_kick(BarState& state, int end, const EndAction& action, double dt);
  double work_of_switch(BarState& state, int end, double dt) const;
  double reaction_of(const BarState& state, int end) const;
  const double* smoothed(const BarState& state) const {
    return simple() ? state.u.data() : smoothed_;
  }
  bool simple() const { return terms_ == 1; }
  bool forward() const { return bar_.data().tchamwa > 1.0; }
  bool viscous() const { return bar_.data().bulk_viscosity > 0.0; }
  void add_viscous_force(const std::vector<double>& v, std::vector<double>& force) const;

  double step_;
  int terms_;
  double previous_dt_ = 0.0;  // 0: no substep yet in this run
  std::array<End, 2> ends_;
  std::vector<Row> outer_;        // the outer two nodes at both ends, each once
  std::vector<double> ratio_;     // c_q / c_{q-1}, q = 2..P
  double* smoothed_ = nullptr;    // u~ at the present substep (scratch; none when P = 1)
  Smoothing present_;             // that it is one of
  mutable std::array<Smoothing, 2> asked_;  // beside the substeps
  std::vector<double> force_, viscous_;
  EndActions prescribed_;  // last actions of the run: close() overwrites prescribed motion
};

}  // namespace abut
