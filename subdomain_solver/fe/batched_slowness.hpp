#pragma once

// Part of batched_stiffness.cpp, compiled for each instruction set: geometry of cells, and whether
// all their frequencies are below a limit. What comes of it is a yes or a no with room for
// rounding, so sums here need no fused form.

#include "subdomain_solver/fe/batched_stiffness.hpp"
#include "subdomain_solver/materials/batched_laws.hpp"

namespace abut {
namespace {

/// Volume and gradients of some of the cells, as many as a register holds.
template <int dim, int lanes>
void measure(const ShapeBatch& batch, int first) {
  using Real = typename Lanes<lanes>::Real;
  for (int p = 0; p < batch.points; ++p) {
    const double* slope = batch.slope + p * batch.nodes * dim;
    TensorLanes<lanes> jacobian{}, normal;  // dX/dxi; its cofactors
    if constexpr (dim == 2) jacobian.entry[8] = broadcast<Real>(1.0);
    for (int a = 0; a < batch.nodes; ++a)
      ABUT_UNROLLED (i, 0, dim) {
        const Real place = load<lanes>(batch.place + (a * dim + i) * batch_lanes + first);
        ABUT_UNROLLED (j, 0, dim) jacobian.entry[i + 3 * j] += place * slope[a * dim + j];
      }
    const Real change = cofactor(jacobian, normal), inverse = 1.0 / change;
    store<lanes>(batch.weight[p] * change, batch.volume + p * batch_lanes + first);
    if (batch.gradient == nullptr) continue;
    double* out = batch.gradient + p * batch.nodes * dim * batch_lanes + first;
    for (int a = 0; a < batch.nodes; ++a)
      ABUT_UNROLLED (j, 0, dim) {
        Real sum = normal.entry[j] * slope[a * dim];
        ABUT_UNROLLED (k, 1, dim) sum += normal.entry[j + 3 * k] * slope[a * dim + k];
        store<lanes>(sum * inverse, out + (a * dim + j) * batch_lanes);
      }
  }
}

template <int dim, int lanes>
void measure_all(const ShapeBatch& batch) {
  for (int first = 0; first < batch_lanes; first += lanes) measure<dim, lanes>(batch, first);
}

/// The upper rows of square M - K, one behind the other.
template <int dim, int lanes>
void shift(const SlownessBatch& batch, int first) {
  using Real = typename Lanes<lanes>::Real;
  const int size = batch.nodes * dim;
  const double* from = batch.stiffness + first;
  for (int a = 0; a < batch.nodes; ++a) {
    double* rows[dim];  // where the column 0 would be
    ABUT_UNROLLED (i, 0, dim) {
      const int row = a * dim + i;
      rows[i] = batch.rows + (row * size - row * (row + 1) / 2) * batch_lanes + first;
    }
    const Real own = batch.square * load<lanes>(batch.mass + a * batch_lanes + first);
    for (int b = a; b < batch.nodes; ++b)
      ABUT_UNROLLED (i, 0, dim)
        ABUT_UNROLLED (k, 0, dim) {
          const Real entry = -load<lanes>(from);
          from += batch_lanes;
          if (a == b && k < i) continue;
          store<lanes>(a == b && i == k ? Real(own + entry) : entry,
                       rows[i] + (b * dim + k) * batch_lanes);
        }
  }
}

/// By elimination without pivots: definite are matrices all of whose pivots are positive.
template <int dim, int lanes>
unsigned find_definite(const SlownessBatch& batch, int first) {
  using Real = typename Lanes<lanes>::Real;
  const int size = batch.nodes * dim;
  typename Lanes<lanes>::Bits definite = ~typename Lanes<lanes>::Bits{};
  double* pivot = batch.rows + first;
  for (int r = 0; r < size; ++r) {
    const Real diagonal = load<lanes>(pivot), inverse = 1.0 / diagonal;
    definite &= diagonal > 0.0;
    double* row = pivot;
    for (int i = r + 1; i < size; ++i) {
      row += (size - i + 1) * batch_lanes;  // from (i - 1, i - 1) to (i, i)
      const double* above = pivot + (i - r) * batch_lanes;
      const Real factor = load<lanes>(above) * inverse;
      for (int c = 0; c < size - i; ++c) {
        double* at = row + c * batch_lanes;
        store<lanes>(load<lanes>(at) - factor * load<lanes>(above + c * batch_lanes), at);
      }
    }
    pivot += (size - r) * batch_lanes;
  }
  unsigned out = 0;
  ABUT_UNROLLED (l, 0, lanes)
    if (definite[l] != 0) out |= 1u << (first + l);
  return out;
}

template <int dim, int lanes>
unsigned find_slower(const SlownessBatch& batch) {
  unsigned out = 0;
  for (int first = 0; first < batch_lanes; first += lanes) {
    shift<dim, lanes>(batch, first);
    out |= find_definite<dim, lanes>(batch, first);
  }
  return out;
}

}  // namespace
}  // namespace abut
