#pragma once

#include <utility>
#include <vector>

#include "subdomain_solver/model.hpp"
#include "subdomain_solver/time/alpha_weights.hpp"

namespace abut {

/// The part of the impulses that generalised-alpha steps hold back from M v: with it, momentum
/// changes by the impulses of the forces to round-off [M.24].
class MomentumLag {
 public:
  /// `mass` [kg] (dofs, dofs) and `inertial`, the free coordinates that have mass, must outlive it.
  /// `layer`: those without, where forces act that accelerations do not know.
  MomentumLag(const AlphaWeights& weights, const SparseMatrix& mass,
              const std::vector<int>& inertial, std::vector<int> layer)
      : weights_(weights), mass_(mass), inertial_(inertial), layer_(std::move(layer)) {}

  /// Whether steps of these weights hold anything back.
  static bool exists(const AlphaWeights& weights) {
    return !weights.is_newmark() || weights.gamma != 0.5;
  }
  /// [kg m/s] (dofs) where `external` [N] (dofs), as far as accelerations know of it, acts now;
  /// step [s]: of the scheme.
  void find(const Motion& motion, double step, const Vector& external, Vector& out) const;

 private:
  AlphaWeights weights_;
  const SparseMatrix& mass_;
  const std::vector<int>& inertial_;
  std::vector<int> layer_;
  mutable Vector inertia_;  // [N] (dofs)
};

}  // namespace abut
