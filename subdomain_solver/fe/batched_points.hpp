#pragma once

#include "subdomain_solver/fe/batched_flat_cells.hpp"
#include "subdomain_solver/fe/batched_hex8_one_point.hpp"
#include "subdomain_solver/fe/batched_simplices.hpp"
#include "subdomain_solver/fe/lane_metric_test.hpp"

namespace abut {

// For each cell: its dimension, its metric from nodal positions, and `visit(place, H)` at every
// point, by its place among the cell's histories.

struct Hex8Points {
  static constexpr int nodes = 8, dim = 3;

  template <int N, class Visit>
  [[gnu::always_inline]] static void run(const double* x, const double* u,
                                         typename Lanes<N>::Real (&metric)[3][3],
                                         const Visit& visit) {
    using Real = typename Lanes<N>::Real;
    Real mode[3][8], edge[3][3];
    HexGradients<Real> along, moved;
    load_hex_modes<N>(x, mode);
    hex_gradients(mode, along);
    ABUT_UNROLLED (d, 0, 3)
      ABUT_UNROLLED (i, 0, 3) edge[d][i] = 0.125 * mode[i][d + 1];
    metric_of<3>(edge, metric);
    load_hex_modes<N>(u, mode);
    hex_gradients(mode, moved);
    for (int p = 0; p < 8; ++p) {
      const int a = p & 1, b = (p >> 1) & 1, c = p >> 2;
      const int line[3] = {b + 2 * c, a + 2 * c, a + 2 * b};
      TensorLanes<N> j, g, cof, h;
      ABUT_UNROLLED (d, 0, 3)
        ABUT_UNROLLED (i, 0, 3) {
          j.entry[i + 3 * d] = along.at[d][line[d]][i];
          g.entry[i + 3 * d] = moved.at[d][line[d]][i];
        }
      const Real det = cofactor(j, cof);
      displacement_gradient<N>(g, cof, Real(1.0 / det), h);
      visit(history_place(a, b, c), h);
    }
  }
};

struct Hex8MeanPoint {
  static constexpr int nodes = 8, dim = 3;

  template <int N, class Visit>
  [[gnu::always_inline]] static void run(const double* nodal_x, const double* nodal_u,
                                         typename Lanes<N>::Real (&metric)[3][3],
                                         const Visit& visit) {
    using Real = typename Lanes<N>::Real;
    Real x[3][8], u[3][8], edge[3][3];
    load_hex_modes<N>(nodal_x, x);
    load_hex_modes<N>(nodal_u, u);
    ABUT_UNROLLED (d, 0, 3)
      ABUT_UNROLLED (i, 0, 3) edge[d][i] = 0.125 * x[i][d + 1];
    metric_of<3>(edge, metric);
    const HexMeanGradients<Real> mean(x);
    TensorLanes<N> h;
    mean.template gradient<N>(u, Real(1.0 / mean.volume(x)), h);
    visit(0, h);
  }
};

struct Quad4Points {
  static constexpr int nodes = 4, dim = 2;

  template <int N, class Visit>
  [[gnu::always_inline]] static void run(const double* nodal_x, const double* nodal_u,
                                         typename Lanes<N>::Real (&metric)[2][2],
                                         const Visit& visit) {
    using Real = typename Lanes<N>::Real;
    QuadModes<N> x, u;
    x.load_from(nodal_x);
    u.load_from(nodal_u);
    quad_metric<N>(x, metric);
    for (int p = 0; p < 4; ++p) {
      const Real a = broadcast<Real>((p & 1) != 0 ? gauss_point : -gauss_point);
      const Real b = broadcast<Real>(p > 1 ? gauss_point : -gauss_point);
      visit(quad_history_place(p), quad_gradient<N>(x, u, a, b));
    }
  }

  /// Edges in the middle: modes carry the factor 4.
  template <int N>
  [[gnu::always_inline]] static void quad_metric(const QuadModes<N>& x,
                                                 typename Lanes<N>::Real (&metric)[2][2]) {
    typename Lanes<N>::Real edge[2][2];
    ABUT_UNROLLED (d, 0, 2)
      ABUT_UNROLLED (i, 0, 2) edge[d][i] = 0.25 * x.at[i][d + 1];
    metric_of<2>(edge, metric);
  }

  template <int N>
  [[gnu::always_inline]] static TensorLanes<N> quad_gradient(const QuadModes<N>& x,
                                                             const QuadModes<N>& u,
                                                             const typename Lanes<N>::Real& a,
                                                             const typename Lanes<N>::Real& b) {
    using Real = typename Lanes<N>::Real;
    Real j[2][2], g[2][2], h[2][2];  // (component, direction)
    ABUT_UNROLLED (i, 0, 2) {
      j[i][0] = fused(b, x.at[i][3], x.at[i][1]);
      j[i][1] = fused(a, x.at[i][3], x.at[i][2]);
      g[i][0] = fused(b, u.at[i][3], u.at[i][1]);
      g[i][1] = fused(a, u.at[i][3], u.at[i][2]);
    }
    const Real det = fused(j[0][0], j[1][1], Real(-j[0][1] * j[1][0]));
    const Real cof[2][2] = {{j[1][1], -j[1][0]}, {-j[0][1], j[0][0]}};
    const Real inverse = 1.0 / det;
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (k, 0, 2)
        h[i][k] = fused(g[i][0], cof[k][0], Real(g[i][1] * cof[k][1])) * inverse;
    return plane_gradient<N>(h);
  }
};

/// The mean gradient of quad4 is that of its middle.
struct Quad4MeanPoint {
  static constexpr int nodes = 4, dim = 2;

  template <int N, class Visit>
  [[gnu::always_inline]] static void run(const double* nodal_x, const double* nodal_u,
                                         typename Lanes<N>::Real (&metric)[2][2],
                                         const Visit& visit) {
    using Real = typename Lanes<N>::Real;
    QuadModes<N> x, u;
    x.load_from(nodal_x);
    u.load_from(nodal_u);
    Quad4Points::quad_metric<N>(x, metric);
    visit(0, Quad4Points::quad_gradient<N>(x, u, Real{}, Real{}));
  }
};

/// S is the second moment of the corners: 1/4 sum e_d e_d^T - 1/16 (sum e_d)(sum e_d)^T.
struct Tet4Point {
  static constexpr int nodes = 4, dim = 3;

  template <int N, class Visit>
  [[gnu::always_inline]] static void run(const double* x, const double* u,
                                         typename Lanes<N>::Real (&metric)[3][3],
                                         const Visit& visit) {
    using Real = typename Lanes<N>::Real;
    TensorLanes<N> j, g, cof, h;
    Real edge[3][3], sum[3];
    ABUT_UNROLLED (i, 0, 3) sum[i] = Real{};
    ABUT_UNROLLED (d, 0, 3)
      ABUT_UNROLLED (i, 0, 3) {
        const int at = (3 * (d + 1) + i) * batch_lanes, origin = i * batch_lanes;
        j.entry[i + 3 * d] = load<N>(x + at) - load<N>(x + origin);
        g.entry[i + 3 * d] = load<N>(u + at) - load<N>(u + origin);
        edge[d][i] = 0.5 * j.entry[i + 3 * d];
        sum[i] += 0.25 * j.entry[i + 3 * d];
      }
    metric_of<3>(edge, metric);
    ABUT_UNROLLED (a, 0, 3)
      ABUT_UNROLLED (b, 0, 3) metric[a][b] -= sum[a] * sum[b];
    const Real det = cofactor(j, cof);
    displacement_gradient<N>(g, cof, Real(1.0 / det), h);
    visit(0, h);
  }
};

/// Likewise of three corners: 1/3 sum e_d e_d^T - 1/9 (sum e_d)(sum e_d)^T.
struct Tri3Point {
  static constexpr int nodes = 3, dim = 2;

  template <int N, class Visit>
  [[gnu::always_inline]] static void run(const double* x, const double* u,
                                         typename Lanes<N>::Real (&metric)[2][2],
                                         const Visit& visit) {
    using Real = typename Lanes<N>::Real;
    Real j[2][2], g[2][2], h[2][2], edge[2][2];
    Tri3::tri_edges<N>(x, j);
    Tri3::tri_edges<N>(u, g);
    ABUT_UNROLLED (d, 0, 2)
      ABUT_UNROLLED (i, 0, 2) edge[d][i] = gauss_point * j[i][d];  // of 1/sqrt(3)
    metric_of<2>(edge, metric);
    ABUT_UNROLLED (a, 0, 2)
      ABUT_UNROLLED (b, 0, 2)
        metric[a][b] -= (1.0 / 9.0) * ((j[a][0] + j[a][1]) * (j[b][0] + j[b][1]));
    const Real inverse = 1.0 / fused(j[0][0], j[1][1], Real(-j[0][1] * j[1][0]));
    const Real cof[2][2] = {{j[1][1], -j[1][0]}, {-j[0][1], j[0][0]}};
    ABUT_UNROLLED (i, 0, 2)
      ABUT_UNROLLED (k, 0, 2)
        h[i][k] = fused(g[i][0], cof[k][0], Real(g[i][1] * cof[k][1])) * inverse;
    visit(0, plane_gradient<N>(h));
  }
};

}  // namespace abut
