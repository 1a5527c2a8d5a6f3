#pragma once

#include "subdomain_solver/fe/batched_hex8.hpp"

namespace abut {

/// Values at the corners of a square as sums of its four modes 1 x y xy (times 4), and back.
template <int N>
struct QuadModes {
  using Real = typename Lanes<N>::Real;
  enum { one, x, y, xy };
  Real at[2][4];  // (component, mode)

  [[gnu::always_inline]] void load_from(const double* nodal) {
    ABUT_UNROLLED (i, 0, 2) {
      Real n[4];
      ABUT_UNROLLED (a, 0, 4) n[a] = load<N>(nodal + (3 * a + i) * batch_lanes);
      const Real s0 = n[1] + n[0], d0 = n[1] - n[0], s1 = n[2] + n[3], d1 = n[2] - n[3];
      at[i][one] = s1 + s0;
      at[i][x] = d1 + d0;
      at[i][y] = s1 - s0;
      at[i][xy] = d1 - d0;
    }
  }
  /// Forces of the modes to forces of the nodes; mode 1 carries none.
  [[gnu::always_inline]] void store_to(double* nodal) const {
    ABUT_UNROLLED (i, 0, 2) {
      const Real d0 = at[i][x] - at[i][xy], d1 = at[i][x] + at[i][xy], s = at[i][y];
      const Real n[4] = {-s - d0, d0 - s, s + d1, s - d1};
      ABUT_UNROLLED (a, 0, 4) store<N>(n[a], nodal + (3 * a + i) * batch_lanes);
    }
    ABUT_UNROLLED (a, 0, 4) store<N>(Real{}, nodal + (3 * a + 2) * batch_lanes);
  }
};

/// F33 = 1 and no shear across the plane.
template <int N>
[[gnu::always_inline]] inline TensorLanes<N> plane_gradient(
    const typename Lanes<N>::Real (&h)[2][2]) {
  TensorLanes<N> out{};
  ABUT_UNROLLED (i, 0, 2)
    ABUT_UNROLLED (j, 0, 2) out.entry[i + 3 * j] = h[i][j];
  return out;
}

/// Plane strain, full 2x2 integration [M.50].
struct Quad4 {
  static constexpr int nodes = 4;

  template <int N, class Law>
  [[gnu::always_inline]] static void evaluate(const double* nodal_x, const double* nodal_u,
                                              double* force, const Law& law,
                                              const BatchedParameters& parameters,
                                              typename Lanes<N>::Real& stored,
                                              typename Lanes<N>::Bits& valid) {
    using Real = typename Lanes<N>::Real;
    QuadModes<N> x, u, pull;
    x.load_from(nodal_x);
    u.load_from(nodal_u);
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (m, 0, 4) pull.at[i][m] = Real{};
    const double scale = parameters.thickness / 16.0;  // 4^2: modes carry the factor 4
    for (int p = 0; p < 4; ++p) {
      const double a = (p & 1) != 0 ? gauss_point : -gauss_point;
      const double b = p > 1 ? gauss_point : -gauss_point;
      Real j[2][2], g[2][2];  // (component, direction)
      ABUT_UNROLLED (i, 0, 2) {
        j[i][0] = fused(broadcast<Real>(b), x.at[i][3], x.at[i][1]);
        j[i][1] = fused(broadcast<Real>(a), x.at[i][3], x.at[i][2]);
        g[i][0] = fused(broadcast<Real>(b), u.at[i][3], u.at[i][1]);
        g[i][1] = fused(broadcast<Real>(a), u.at[i][3], u.at[i][2]);
      }
      const Real det = fused(j[0][0], j[1][1], Real(-j[0][1] * j[1][0]));
      const Real cof[2][2] = {{j[1][1], -j[1][0]}, {-j[0][1], j[0][0]}};
      const Real inverse = 1.0 / det;
      Real h[2][2];
      ABUT_UNROLLED (i, 0, 2)
        ABUT_UNROLLED (k, 0, 2)
          h[i][k] = fused(g[i][0], cof[k][0], Real(g[i][1] * cof[k][1])) * inverse;
      LaneResponse<N> response;
      law(plane_gradient<N>(h), response);
      valid &= response.valid > 0.0;
      stored = fused(Real(scale * det), response.energy, stored);
      ABUT_UNROLLED (i, 0, 2) {
        const Real* s = response.stress.entry + i;
        const Real fx = fused(s[0], cof[0][0], Real(s[3] * cof[1][0])) * scale;
        const Real fy = fused(s[0], cof[0][1], Real(s[3] * cof[1][1])) * scale;
        pull.at[i][1] += fx;
        pull.at[i][2] += fy;
        pull.at[i][3] += fused(broadcast<Real>(b), fx, Real(a * fy));
      }
    }
    pull.store_to(force);
  }
};

/// Plane strain, one point with hourglass stiffness, as Hex8OnePoint [M.51, M.52].
struct Quad4OnePoint {
  static constexpr int nodes = 4;

  template <int N, class Law>
  [[gnu::always_inline]] static void evaluate(const double* nodal_x, const double* nodal_u,
                                              double* force, const Law& law,
                                              const BatchedParameters& parameters,
                                              typename Lanes<N>::Real& stored,
                                              typename Lanes<N>::Bits& valid) {
    using Real = typename Lanes<N>::Real;
    QuadModes<N> x, u, pull;
    x.load_from(nodal_x);
    u.load_from(nodal_u);
    // Area x gradients of modes x and y; mode xy has none. det is 4 x the area.
    const Real cof[2][2] = {{x.at[1][2], -x.at[1][1]}, {-x.at[0][2], x.at[0][1]}};
    const Real det = fused(x.at[0][1], cof[0][0], Real(x.at[0][2] * cof[0][1]));
    const Real inverse = 1.0 / det, volume = (0.25 * parameters.thickness) * det;
    Real h[2][2];
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (j, 0, 2)
        h[i][j] = fused(u.at[i][1], cof[j][0], Real(u.at[i][2] * cof[j][1])) * inverse;
    LaneResponse<N> response;
    law(plane_gradient<N>(h), response);
    valid &= response.valid > 0.0;
    stored = fused(volume, response.energy, stored);
    // k = coefficient M/8 V sum_a |b_a|^2; sum_a |A b_a|^2 = 4/16 sum_m |cof_m|^2.
    Real squares = cof[0][0] * cof[0][0];
    squares = fused(cof[0][1], cof[0][1], squares);
    squares = fused(cof[1][0], cof[1][0], fused(cof[1][1], cof[1][1], squares));
    const Real k = (parameters.hourglass * parameters.thickness / 8.0) * squares * inverse;
    ABUT_UNROLLED (i, 0, 2) {
      Real gap = u.at[i][3];
      ABUT_UNROLLED (j, 0, 2) gap = fused(Real(-h[i][j]), x.at[j][3], gap);
      const Real q = k * gap;
      stored = fused(Real(0.5 * q), gap, stored);
      Real work[2];
      ABUT_UNROLLED (j, 0, 2) {
        const Real moment = q * x.at[j][3] * inverse;
        work[j] = fused(response.stress.entry[i + 3 * j],
                        broadcast<Real>(0.25 * parameters.thickness), Real(-moment));
      }
      pull.at[i][0] = Real{};
      pull.at[i][1] = fused(work[0], cof[0][0], Real(work[1] * cof[1][0]));
      pull.at[i][2] = fused(work[0], cof[0][1], Real(work[1] * cof[1][1]));
      pull.at[i][3] = q;
    }
    pull.store_to(force);
  }
};

/// Four nodes in space; F is the same everywhere.
struct Tet4 {
  static constexpr int nodes = 4;

  template <int N, class Law>
  [[gnu::always_inline]] static void evaluate(const double* x, const double* u, double* force,
                                              const Law& law, const BatchedParameters&,
                                              typename Lanes<N>::Real& stored,
                                              typename Lanes<N>::Bits& valid) {
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
    law(h, response);
    valid &= response.valid > 0.0;
    stored = fused(Real((1.0 / 6.0) * det), response.energy, stored);
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

}  // namespace abut
