#pragma once

#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// a A + b B of compressed matrices whose patterns stay: where their entries go is found once, and
/// later sums allocate nothing.
class MatrixSum {
 public:
  /// Good until it is asked for again.
  const SparseMatrix& of(double a, const SparseMatrix& first, double b, const SparseMatrix& second);

 private:
  void find_places(const SparseMatrix& first, const SparseMatrix& second);

  SparseMatrix sum_;
  std::vector<Eigen::Index> in_first_, in_second_;  // of each entry of the sum, or -1
  Eigen::Index entries_first_ = -1, entries_second_ = -1;
};

/// Square, with these entries.
SparseMatrix diagonal_matrix(const Vector& entries);

}  // namespace abut
