#pragma once

#include <cstddef>
#include <vector>

namespace abut {

/// Symmetric positive definite tridiagonal system, factored once as L D L^T and solved many times.
/// (Eigen has no tridiagonal solver; its sparse ones cost several times the sweeps below.)
class TriDiagonal {
 public:
  /// `diagonal` (n), `beside` (n - 1): sub- and superdiagonal.
  void factor(const std::vector<double>& diagonal, const std::vector<double>& beside);
  /// Solves in place.
  void solve(std::vector<double>& x) const;
  bool factored() const { return !inverse_pivot_.empty(); }

 private:
  std::vector<double> lower_, inverse_pivot_;
};

}  // namespace abut
