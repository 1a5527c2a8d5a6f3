#pragma once

#include "subdomain_solver/fe/batched_flat_cells.hpp"

namespace abut {

/// Four nodes in space; F is the same everywhere.
struct Tet4 {
  static constexpr int nodes = 4;

  template <int N, class Law, class Sums>
  [[gnu::always_inline]] static void evaluate(const double* x, const double* u, double* force,
                                              const Law& law, const BatchedParameters&,
                                              Sums& sums) {
    using Real = typename Lanes<N>::Real;
    TensorLanes<N> j, g, cof, h;
    ABUT_UNROLLED (d, 0, 3)
      ABUT_UNROLLED (i, 0, 3) {
        const int at = (3 * (d + 1) + i) * batch_lanes, origin = i * batch_lanes;
        j.entry[i + 3 * d] = load<N>(x + at) - load<N>(x + origin);
        g.entry[i + 3 * d] = load<N>(u + at) - load<N>(u + origin);
      }
    const Real det = cofactor(j, cof);
    displacement_gradient<N>(g, cof, Real(1.0 / det), h);
    LaneResponse<N> response;
    law(0, h, response);
    sums.add(Real((1.0 / 6.0) * det), response);
    ABUT_UNROLLED (i, 0, 3) {
      const Real* s = response.stress.entry + i;
      Real rest = Real{};
      ABUT_UNROLLED (d, 0, 3) {
        const Real* c = cof.entry + 3 * d;
        const Real f = fused(s[0], c[0], fused(s[3], c[1], Real(s[6] * c[2]))) * (1.0 / 6.0);
        store<N>(f, force + (3 * (d + 1) + i) * batch_lanes);
        rest -= f;
      }
      store<N>(rest, force + i * batch_lanes);
    }
  }
};

/// Three nodes in plane strain; F is the same everywhere.
struct Tri3 {
  static constexpr int nodes = 3;

  template <int N, class Law, class Sums>
  [[gnu::always_inline]] static void evaluate(const double* x, const double* u, double* force,
                                              const Law& law, const BatchedParameters& parameters,
                                              Sums& sums) {
    using Real = typename Lanes<N>::Real;
    Real j[2][2], g[2][2], h[2][2];  // (component, direction)
    tri_edges<N>(x, j);
    tri_edges<N>(u, g);
    const Real det = fused(j[0][0], j[1][1], Real(-j[0][1] * j[1][0]));
    const Real cof[2][2] = {{j[1][1], -j[1][0]}, {-j[0][1], j[0][0]}};
    const Real inverse = 1.0 / det;
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (k, 0, 2)
        h[i][k] = fused(g[i][0], cof[k][0], Real(g[i][1] * cof[k][1])) * inverse;
    LaneResponse<N> response;
    law(0, plane_gradient<N>(h), response);
    const double half = 0.5 * parameters.thickness;
    sums.add(Real(half * det), response);
    ABUT_UNROLLED (i, 0, 2) {
      const Real* s = response.stress.entry + i;
      Real rest = Real{};
      ABUT_UNROLLED (d, 0, 2) {
        const Real f = fused(s[0], cof[0][d], Real(s[3] * cof[1][d])) * half;
        store<N>(f, force + (3 * (d + 1) + i) * batch_lanes);
        rest -= f;
      }
      store<N>(rest, force + i * batch_lanes);
    }
    ABUT_UNROLLED (a, 0, 3) store<N>(Real{}, force + (3 * a + 2) * batch_lanes);
  }

  /// From the first node to the others.
  template <int N>
  [[gnu::always_inline]] static void tri_edges(const double* nodal,
                                               typename Lanes<N>::Real (&edge)[2][2]) {
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (d, 0, 2)
        edge[i][d] =
            load<N>(nodal + (3 * (d + 1) + i) * batch_lanes) - load<N>(nodal + i * batch_lanes);
  }
};

}  // namespace abut
