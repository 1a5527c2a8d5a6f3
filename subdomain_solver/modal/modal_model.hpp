#pragma once

#include "subdomain_solver/model.hpp"

namespace abut {

/// A linear body in amplitudes of modes that are free of each other, q'' + diag(omega^2) q = f:
/// mass one, exact stable step 2/omega_max.
class ModalModel final : public Model {
 public:
  /// [rad/s] (modes)
  explicit ModalModel(const Vector& frequencies);

  int dofs() const override { return static_cast<int>(stiffness_.size()); }
  bool is_linear() const override { return true; }
  std::size_t history_size() const override { return 0; }
  const SparseMatrix& mass() const override { return mass_; }
  const Vector& lumped_mass() const override { return lumped_; }
  double roundoff(std::span<const double> q) const override;
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out) override;

  double stable_step() const;  // [s]; infinity: no mode has a frequency

 private:
  Vector stiffness_, lumped_;  // omega^2; ones
  SparseMatrix mass_, tangent_;
};

}  // namespace abut
