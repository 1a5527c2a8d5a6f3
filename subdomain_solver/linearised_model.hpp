#pragma once

#include "subdomain_solver/model.hpp"

namespace abut {

/// Another model for small motions from rest: r(q) = K q with its tangent K there. Loose bodies
/// turn far under the least force that strains them; of what they do at first, it tells all.
class LinearisedModel final : public Model {
 public:
  /// The other model must outlive it. `ready()` false: it has no answer at rest.
  explicit LinearisedModel(Model& of);
  bool ready() const { return ready_; }

  int dofs() const override { return of_.dofs(); }
  bool is_linear() const override { return true; }
  std::size_t history_size() const override { return of_.history_size(); }
  const SparseMatrix& mass() const override { return of_.mass(); }
  const Vector& lumped_mass() const override { return of_.lumped_mass(); }
  WorkerThreads* threads() override { return of_.threads(); }
  double roundoff(std::span<const double> q) const override;
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out) override;
  const std::vector<int>& massless() const override { return of_.massless(); }
  [[nodiscard]] bool evaluate_layer(std::span<const double> q, std::span<const double> history,
                                    Want want, LayerResponse& out) override;

 private:
  Model& of_;
  bool ready_ = false;
  SparseMatrix tangent_;  // [N/m]
  LayerResponse layer_;   // at rest
  Vector force_;          // [N]
};

}  // namespace abut
