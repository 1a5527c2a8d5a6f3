#pragma once

#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/bars/bar_integrator.hpp"
#include "subdomain_solver/solve/tridiagonal.hpp"
#include "subdomain_solver/time/alpha_weights.hpp"

namespace abut {

/// Implicit bar: one tridiagonal solve per substep, factored once per step length.
/// Conserved by the trapezoidal rule (Newmark 1/4, 1/2): 1/2 v M v + 1/2 u K u.
class GeneralizedAlpha final : public BarIntegrator {
 public:
  /// `step` [s]: of substeps that fill a window; the last one may be shorter.
  GeneralizedAlpha(const Bar& bar, const AlphaWeights& weights, double step);

  void begin(BarState& state, const EndActions& actions) override;
  void open(BarState& state, double dt, const EndActions& opening) override;
  void substep(BarState& state, double dt, const EndActions& actions) override;
  void close(BarState& state, double dt) override;
  double port_displacement(const BarState& state, int end) const override;
  double static_compliance(int end) const override;
  double kinetic(const BarState& state) const override { return bar_.kinetic(state.v); }
  double stored(const BarState& state) const override { return bar_.stored(state.u); }
  double momentum_lag(const BarState& state) const override;

 protected:
  const std::vector<double>& blow(int end) const override { return mass_column_[end]; }

 private:
  void factor(double dt, const EndActions& actions);
  void initial_acceleration(BarState& state) const;
  void right_hand_side(const BarState& state, double dt, const EndActions& actions);
  void apply_mass(const std::vector<double>& x, std::vector<double>& out) const;
  void apply_reactions(const EndActions& actions, BarState& state);
  void advance_rates(BarState& state, double dt, const EndActions& actions);
  bool held(int end, const EndActions& actions) const;
  double lag_per_step(const BarState& state, const std::vector<double>& loads) const;
  void shift_lag(BarState& state, const std::vector<double>& loads, double step) const;

  AlphaWeights w_;
  double step_;  // [s]
  double factored_dt_ = 0.0;
  std::array<bool, 2> factored_held_ = {false, false};
  TriDiagonal matrix_, mass_matrix_;
  // A^-1 e_end (1 - af): displacement per unit end force
  std::array<std::vector<double>, 2> column_;
  // acceleration per unit end force at one instant
  std::array<std::vector<double>, 2> mass_column_;
  // Unknowns are the increments of a substep: solving for displacements would lose momentum to the
  // round-off of M u / (beta dt^2).
  std::vector<double> predicted_, rhs_, work_, trial_;
};

}  // namespace abut
