#pragma once

#include "subdomain_solver/fe/batched_kernel.hpp"
#include "subdomain_solver/fe/batched_responses.hpp"

namespace abut {

// Nodal values of 8 cells: value i of node a in lane l at [(3 a + i) 8 + l].

/// Values at the corners of a cube as sums of its eight modes 1 x y z yz zx xy xyz (times 8), and
/// back: every step is an addition. Modes 1 to 3 are linear fields, the last four the hourglasses.
namespace hex_mode {
enum { one, x, y, z, yz, zx, xy, xyz, count };
}

template <class Real>
[[gnu::always_inline]] inline void to_hex_modes(const Real (&n)[8], Real (&mode)[8]) {
  const Real s0 = n[1] + n[0], s1 = n[2] + n[3], s2 = n[5] + n[4], s3 = n[6] + n[7];
  const Real d0 = n[1] - n[0], d1 = n[2] - n[3], d2 = n[5] - n[4], d3 = n[6] - n[7];
  const Real s01 = s1 + s0, s23 = s3 + s2, t01 = s1 - s0, t23 = s3 - s2;
  const Real d01 = d1 + d0, d23 = d3 + d2, e01 = d1 - d0, e23 = d3 - d2;
  mode[hex_mode::one] = s23 + s01;
  mode[hex_mode::z] = s23 - s01;
  mode[hex_mode::y] = t23 + t01;
  mode[hex_mode::yz] = t23 - t01;
  mode[hex_mode::x] = d23 + d01;
  mode[hex_mode::zx] = d23 - d01;
  mode[hex_mode::xy] = e23 + e01;
  mode[hex_mode::xyz] = e23 - e01;
}

/// Transposed: forces of the modes to forces of the nodes. Mode 1 carries none.
template <class Real>
[[gnu::always_inline]] inline void from_hex_modes(const Real (&mode)[8], Real (&n)[8]) {
  const Real s01 = -mode[hex_mode::z], s23 = mode[hex_mode::z];
  const Real t01 = mode[hex_mode::y] - mode[hex_mode::yz];
  const Real t23 = mode[hex_mode::y] + mode[hex_mode::yz];
  const Real d01 = mode[hex_mode::x] - mode[hex_mode::zx];
  const Real d23 = mode[hex_mode::x] + mode[hex_mode::zx];
  const Real e01 = mode[hex_mode::xy] - mode[hex_mode::xyz];
  const Real e23 = mode[hex_mode::xy] + mode[hex_mode::xyz];
  const Real s0 = s01 - t01, s1 = s01 + t01, s2 = s23 - t23, s3 = s23 + t23;
  const Real d0 = d01 - e01, d1 = d01 + e01, d2 = d23 - e23, d3 = d23 + e23;
  n[0] = s0 - d0;
  n[1] = s0 + d0;
  n[2] = s1 + d1;
  n[3] = s1 - d1;
  n[4] = s2 - d2;
  n[5] = s2 + d2;
  n[6] = s3 + d3;
  n[7] = s3 - d3;
}

template <int N>
[[gnu::always_inline]] inline void load_hex_modes(const double* nodal,
                                                  typename Lanes<N>::Real (&mode)[3][8]) {
  using Real = typename Lanes<N>::Real;
  ABUT_UNROLLED (i, 0, 3) {
    Real n[8];
    ABUT_UNROLLED (a, 0, 8) n[a] = load<N>(nodal + (3 * a + i) * batch_lanes);
    to_hex_modes(n, mode[i]);
  }
}

template <int N>
[[gnu::always_inline]] inline void store_hex_modes(const typename Lanes<N>::Real (&mode)[3][8],
                                                   double* nodal) {
  using Real = typename Lanes<N>::Real;
  ABUT_UNROLLED (i, 0, 3) {
    Real n[8];
    from_hex_modes(mode[i], n);
    ABUT_UNROLLED (a, 0, 8) store<N>(n[a], nodal + (3 * a + i) * batch_lanes);
  }
}

template <class Real>
struct HexGradients {  // derivative in direction d at the four lines (signs of the other two)
  Real at[3][4][3];    // (d, line, component)
};

/// The three modes beside the linear one that vary along the other two directions e < f of d.
inline constexpr int hex_line_modes[3][4] = {
    {hex_mode::x, hex_mode::xy, hex_mode::zx, hex_mode::xyz},
    {hex_mode::y, hex_mode::xy, hex_mode::yz, hex_mode::xyz},
    {hex_mode::z, hex_mode::zx, hex_mode::yz, hex_mode::xyz}};
inline constexpr double gauss_point = 0.57735026918962576451;  // 1/sqrt(3)

/// At the 2x2x2 Gauss points: a derivative along a direction is the same at both points of a line.
/// Line e + 2 f with e, f = 0 for the point at -1/sqrt(3).
template <class Real>
[[gnu::always_inline]] inline void hex_gradients(const Real (&mode)[3][8],
                                                 HexGradients<Real>& out) {
  ABUT_UNROLLED (i, 0, 3)
    ABUT_UNROLLED (d, 0, 3) {
      const int(&m)[4] = hex_line_modes[d];
      const Real e = gauss_point * mode[i][m[1]], f = gauss_point * mode[i][m[2]];
      const Real ef = (1.0 / 3.0) * mode[i][m[3]], mean = mode[i][m[0]];
      const Real low = mean - f, high = mean + f, slope_low = e - ef, slope_high = e + ef;
      out.at[d][0][i] = low - slope_low;
      out.at[d][1][i] = low + slope_low;
      out.at[d][2][i] = high - slope_high;
      out.at[d][3][i] = high + slope_high;
    }
}

/// Transposed, scaled; adds nothing to mode 1.
template <class Real>
[[gnu::always_inline]] inline void hex_forces(const HexGradients<Real>& s, double scale,
                                              Real (&mode)[3][8]) {
  ABUT_UNROLLED (i, 0, 3) {
    ABUT_UNROLLED (m, 0, 8) mode[i][m] = Real{};
    ABUT_UNROLLED (d, 0, 3) {
      const int(&m)[4] = hex_line_modes[d];
      const Real low = s.at[d][1][i] + s.at[d][0][i], high = s.at[d][3][i] + s.at[d][2][i];
      const Real e_low = s.at[d][1][i] - s.at[d][0][i], e_high = s.at[d][3][i] - s.at[d][2][i];
      mode[i][m[0]] += scale * (high + low);
      mode[i][m[1]] += (scale * gauss_point) * (e_high + e_low);
      mode[i][m[2]] += (scale * gauss_point) * (high - low);
      mode[i][m[3]] += (scale / 3.0) * (e_high - e_low);
    }
  }
}

/// H = G cof^T / det, where J = dX/dxi has this cofactor and G = du/dxi; entries i + 3 J.
template <int N>
[[gnu::always_inline]] inline void displacement_gradient(const TensorLanes<N>& g,
                                                         const TensorLanes<N>& cof,
                                                         const typename Lanes<N>::Real& inverse,
                                                         TensorLanes<N>& h) {
  using Real = typename Lanes<N>::Real;
  ABUT_UNROLLED (i, 0, 3)
    ABUT_UNROLLED (j, 0, 3) {
      const Real sum =
          fused(g.entry[i], cof.entry[j],
                fused(g.entry[i + 3], cof.entry[j + 3], Real(g.entry[i + 6] * cof.entry[j + 6])));
      h.entry[i + 3 * j] = sum * inverse;
    }
}

/// Where a Gauss point of the cube has its history among the cell's: the last direction runs
/// fastest, as in quadrature().
constexpr int history_place(int a, int b, int c) { return 4 * a + 2 * b + c; }

/// Full 2x2x2 integration [M.50]. X and u from the modes: their common factor 8 cancels in F, and
/// becomes 8^3 in volumes.
struct Hex8 {
  static constexpr int nodes = 8;

  template <int N, class Law, class Sums>
  [[gnu::always_inline]] static void evaluate(const double* x, const double* u, double* force,
                                              const Law& law, const BatchedParameters&,
                                              Sums& sums) {
    using Real = typename Lanes<N>::Real;
    constexpr double scale = 1.0 / 512.0;
    Real mode[3][8];
    HexGradients<Real> along, moved, pull;
    load_hex_modes<N>(x, mode);
    hex_gradients(mode, along);
    load_hex_modes<N>(u, mode);
    hex_gradients(mode, moved);
    ABUT_UNROLLED (d, 0, 3)
      ABUT_UNROLLED (l, 0, 4)
        ABUT_UNROLLED (i, 0, 3) pull.at[d][l][i] = Real{};
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
      LaneResponse<N> response;
      law(history_place(a, b, c), h, response);
      sums.add(Real(scale * det), response);
      const Real* s = response.stress.entry;
      ABUT_UNROLLED (d, 0, 3)
        ABUT_UNROLLED (i, 0, 3) {
          Real& at = pull.at[d][line[d]][i];
          at = fused(
              s[i], cof.entry[3 * d],
              fused(s[i + 3], cof.entry[1 + 3 * d], fused(s[i + 6], cof.entry[2 + 3 * d], at)));
        }
    }
    hex_forces(pull, scale, mode);
    store_hex_modes<N>(mode, force);
  }
};

}  // namespace abut
