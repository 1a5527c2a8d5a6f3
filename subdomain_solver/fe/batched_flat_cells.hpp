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

/// Of the 2x2 points, numbered along x first: coordinate, and place among the cell's histories,
/// where the last direction runs fastest, as in quadrature().
constexpr double quad_sign(int i) { return i != 0 ? gauss_point : -gauss_point; }
constexpr int quad_history_place(int p) { return 2 * (p & 1) + (p >> 1); }

/// A point of quad4 at reference coordinates a, b.
template <int N>
struct QuadPoint {
  using Real = typename Lanes<N>::Real;
  double a = 0.0, b = 0.0;
  Real cof[2][2], det;  // of dX/dxi, whose modes carry the factor 4

  [[gnu::always_inline]] void set(const QuadModes<N>& x, double at_a, double at_b) {
    a = at_a;
    b = at_b;
    Real j[2][2];
    slopes(x, j);
    det = fused(j[0][0], j[1][1], Real(-j[0][1] * j[1][0]));
    cof[0][0] = j[1][1];
    cof[0][1] = -j[1][0];
    cof[1][0] = -j[0][1];
    cof[1][1] = j[0][0];
  }
  /// H of displacements u.
  [[gnu::always_inline]] void gradient(const QuadModes<N>& u, Real (&h)[2][2]) const {
    Real g[2][2];
    slopes(u, g);
    const Real inverse = 1.0 / det;
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (k, 0, 2)
        h[i][k] = fused(g[i][0], cof[k][0], Real(g[i][1] * cof[k][1])) * inverse;
  }
  /// Adds what a stress does to the modes; `scale`: of volume over det.
  [[gnu::always_inline]] void add_pull(const TensorLanes<N>& stress, double scale,
                                       QuadModes<N>& pull) const {
    ABUT_UNROLLED (i, 0, 2) {
      const Real* s = stress.entry + i;
      const Real fx = fused(s[0], cof[0][0], Real(s[3] * cof[1][0])) * scale;
      const Real fy = fused(s[0], cof[0][1], Real(s[3] * cof[1][1])) * scale;
      pull.at[i][1] += fx;
      pull.at[i][2] += fy;
      pull.at[i][3] += fused(broadcast<Real>(b), fx, Real(a * fy));
    }
  }

 private:
  /// (component, direction)
  [[gnu::always_inline]] void slopes(const QuadModes<N>& of, Real (&j)[2][2]) const {
    ABUT_UNROLLED (i, 0, 2) {
      j[i][0] = fused(broadcast<Real>(b), of.at[i][3], of.at[i][1]);
      j[i][1] = fused(broadcast<Real>(a), of.at[i][3], of.at[i][2]);
    }
  }
};

/// Plane strain, full 2x2 integration [M.50].
struct Quad4 {
  static constexpr int nodes = 4;

  template <int N, class Law, class Sums>
  [[gnu::always_inline]] static void evaluate(const double* nodal_x, const double* nodal_u,
                                              double* force, const Law& law,
                                              const BatchedParameters& parameters, Sums& sums) {
    using Real = typename Lanes<N>::Real;
    QuadModes<N> x, u, pull;
    x.load_from(nodal_x);
    u.load_from(nodal_u);
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (m, 0, 4) pull.at[i][m] = Real{};
    const double scale = parameters.thickness / 16.0;  // 4^2: modes carry the factor 4
    for (int p = 0; p < 4; ++p) {
      QuadPoint<N> at;
      at.set(x, quad_sign(p & 1), quad_sign(p >> 1));
      Real h[2][2];
      at.gradient(u, h);
      LaneResponse<N> response;
      law(quad_history_place(p), plane_gradient<N>(h), response);
      sums.add(Real(scale * at.det), response);
      at.add_pull(response.stress, scale, pull);
    }
    pull.store_to(force);
  }
};

/// Plane strain, one point with hourglass stiffness, as Hex8OnePoint [M.51, M.52].
struct Quad4OnePoint {
  static constexpr int nodes = 4;

  template <int N, class Law, class Sums>
  [[gnu::always_inline]] static void evaluate(const double* nodal_x, const double* nodal_u,
                                              double* force, const Law& law,
                                              const BatchedParameters& parameters, Sums& sums) {
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
    law(0, plane_gradient<N>(h), response);
    sums.add(volume, response);
    // k = coefficient M/8 V sum_a |b_a|^2; sum_a |A b_a|^2 = 4/16 sum_m |cof_m|^2.
    Real squares = cof[0][0] * cof[0][0];
    squares = fused(cof[0][1], cof[0][1], squares);
    squares = fused(cof[1][0], cof[1][0], fused(cof[1][1], cof[1][1], squares));
    const Real k = (parameters.hourglass * parameters.thickness / 8.0) * squares * inverse;
    ABUT_UNROLLED (i, 0, 2) {
      Real gap = u.at[i][3];
      ABUT_UNROLLED (j, 0, 2) gap = fused(Real(-h[i][j]), x.at[j][3], gap);
      const Real q = k * gap;
      sums.stored = fused(Real(0.5 * q), gap, sums.stored);
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

}  // namespace abut
