#pragma once

#include "subdomain_solver/materials/batched_tangents.hpp"

namespace abut {

// Whether the tangent moduli A of all points of a cell are below a multiple of the cell's metric S,
// H : A : H < alpha tr(H S H^T) for every H [M.58]. What a cell needs for it are S and the
// displacement gradient H of its points; the rest is linear algebra of D x D blocks.

/// Inverse of a symmetric D x D matrix; `positive` becomes false in lanes where it is not positive
/// definite (Sylvester's minors).
template <int D, class Real, class Bits>
[[gnu::always_inline]] inline void invert_positive(const Real (&m)[D][D], Real (&out)[D][D],
                                                   Bits& positive) {
  positive &= m[0][0] > 0.0;
  if constexpr (D == 2) {
    const Real det = fused(m[0][0], m[1][1], Real(-m[0][1] * m[0][1]));
    positive &= det > 0.0;
    const Real inverse = 1.0 / det;
    out[0][0] = m[1][1] * inverse;
    out[1][1] = m[0][0] * inverse;
    out[0][1] = out[1][0] = -m[0][1] * inverse;
  } else {
    const Real c22 = fused(m[0][0], m[1][1], Real(-m[0][1] * m[0][1]));
    const Real c00 = fused(m[1][1], m[2][2], Real(-m[1][2] * m[1][2]));
    const Real c11 = fused(m[0][0], m[2][2], Real(-m[0][2] * m[0][2]));
    const Real c01 = fused(m[0][2], m[1][2], Real(-m[0][1] * m[2][2]));
    const Real c02 = fused(m[0][1], m[1][2], Real(-m[0][2] * m[1][1]));
    const Real c12 = fused(m[0][1], m[0][2], Real(-m[0][0] * m[1][2]));
    const Real det = fused(m[0][0], c00, fused(m[0][1], c01, Real(m[0][2] * c02)));
    positive &= c22 > 0.0;
    positive &= det > 0.0;
    const Real inverse = 1.0 / det;
    out[0][0] = c00 * inverse;
    out[1][1] = c11 * inverse;
    out[2][2] = c22 * inverse;
    out[0][1] = out[1][0] = c01 * inverse;
    out[0][2] = out[2][0] = c02 * inverse;
    out[1][2] = out[2][1] = c12 * inverse;
  }
}

/// Whether alpha S_JL d_ik - A_iJkL is positive definite: elimination of one block after the other.
template <int D, int N>
struct MetricTest {
  using Real = typename Lanes<N>::Real;
  using Bits = typename Lanes<N>::Bits;
  using Block = Real[D][D];

  [[gnu::always_inline]] static void run(const Real (&scaled_metric)[D][D],
                                         const ElasticityLanes<N>& a, Bits& positive) {
    Real b[D][D][D][D];
    ABUT_UNROLLED (j, 0, D)
      ABUT_UNROLLED (l, j, D)
        ABUT_UNROLLED (i, 0, D)
          ABUT_UNROLLED (k, 0, D) {
            b[j][l][i][k] = -a.at[j][l][i][k];
            if (i == k) b[j][l][i][k] += scaled_metric[j][l];
          }
    ABUT_UNROLLED (p, 0, D) {
      Real inverse[D][D];
      invert_positive<D>(b[p][p], inverse, positive);
      ABUT_UNROLLED (l, p + 1, D) {
        Real solved[D][D];  // inverse b[p][l]
        ABUT_UNROLLED (i, 0, D)
          ABUT_UNROLLED (k, 0, D) {
            Real sum = inverse[i][0] * b[p][l][0][k];
            ABUT_UNROLLED (m, 1, D) sum = fused(inverse[i][m], b[p][l][m][k], sum);
            solved[i][k] = -sum;
          }
        ABUT_UNROLLED (j, p + 1, l + 1)
          ABUT_UNROLLED (i, 0, D)
            ABUT_UNROLLED (k, 0, D)
              ABUT_UNROLLED (m, 0, D)
                b[j][l][i][k] = fused(b[p][j][m][i], solved[m][k], b[j][l][i][k]);
      }
    }
  }
};

/// Metric of a cell from its edges in the middle: S = sum_d J_d J_d^T.
template <int D, class Real>
[[gnu::always_inline]] inline void metric_of(const Real (&edge)[D][D], Real (&s)[D][D]) {
  ABUT_UNROLLED (j, 0, D)
    ABUT_UNROLLED (l, 0, D) {
      Real sum = edge[0][j] * edge[0][l];
      ABUT_UNROLLED (d, 1, D) sum = fused(edge[d][j], edge[d][l], sum);
      s[j][l] = sum;
    }
}

}  // namespace abut
