#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/sparse_rows.hpp"

namespace abut {

/// Kinematic rows that join two posed surfaces K and N: with the nodes' positions x of K, y of N
///   gap_r = n_r . (T x - P y)_r,   forces f_r of the rows:  f_K = T^T f,  f_N = -P^T f.
/// Rows of T and of P sum up to 1, so forces balance whatever the rows are, and the work of both
/// sides is that of the gap. Only rows with a partner are listed.
struct SurfaceRows {
  int dim = 3;
  std::vector<std::int32_t> nodes;  // (r) of K, ascending: the node with most weight in its row
  std::vector<double> weights;      // [m^(dim-1)] (r) w_r: the row's share of the contact's area
  std::vector<double> normals;      // (r, dim) unit, out of N into K
  std::vector<double> gaps;         // [m] (r) in the pose that the rows were made for
  SparseRows k, n;                  // T over the nodes of K, P over the nodes of N

  int count() const { return static_cast<int>(nodes.size()); }
  void clear();
};

/// The gaps of rows in another pose; out is (r) [m].
void gaps(const SurfaceRows& rows, std::span<const double> x, std::span<const double> y,
          std::span<double> out);

}  // namespace abut
