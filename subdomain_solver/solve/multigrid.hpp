#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// An approximate inverse of a positive definite matrix whose cost grows with its entries alone:
/// algebraic multigrid by smoothed aggregation (P. Vanek, J. Mandel, M. Brezina, Computing 56,
/// 1996). Nodes in groups move on the coarser level as the motions that cost no energy let them;
/// one symmetric sweep of Gauss and Seidel goes down, one up, and the coarsest level is solved.
/// Symmetric and definite, so that conjugate gradients may take it; sums run in one order.
class Multigrid {
 public:
  /// Of rows as many as `motions` has.
  explicit Multigrid(CoarseMotions motions);

  /// False: the matrix, or a coarser one, is not positive definite or not a number.
  [[nodiscard]] bool factor(const SparseMatrix& matrix);
  /// z = B r; both (rows).
  void apply(const Vector& r, Vector& z);
  /// Unknowns of each level, the finest first.
  std::vector<Eigen::Index> sizes() const;

 private:
  struct Level {
    SparseMatrix matrix;        // (n, n)
    SparseMatrix prolongation;  // (n, coarser n); of the coarsest: none
    Vector r, z, rest;          // (n) of a cycle
  };
  bool add_level(CoarseMotions& motions);
  void cycle(std::size_t level);

  CoarseMotions motions_;
  std::vector<Level> levels_;
  std::unique_ptr<LinearSolver> coarsest_;
};

}  // namespace abut
