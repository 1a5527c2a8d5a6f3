#pragma once

#include "subdomain_solver/fe/batched_hex8.hpp"

namespace abut {

/// c += a x b of two modes.
template <class Real>
[[gnu::always_inline]] inline void add_cross(const Real (&mode)[3][8], int a, int b, Real (&c)[3]) {
  ABUT_UNROLLED (i, 0, 3) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    c[i] += fused(mode[j][a], mode[k][b], Real(-mode[k][a] * mode[j][b]));
  }
}

/// Integrals of the gradients of the modes over the cell, exactly: their Gauss sums in closed form
/// (products of modes that do not vanish by symmetry). Times 64 they are those of [M.51]; modes
/// xyz and 1 have none.
template <class Real>
struct HexMeanGradients {
  Real at[7][3];  // (modes x to xy, component); at[0] unused

  [[gnu::always_inline]] explicit HexMeanGradients(const Real (&x)[3][8]) {
    constexpr int linear[3] = {hex_mode::x, hex_mode::y, hex_mode::z};
    constexpr int product[3] = {hex_mode::yz, hex_mode::zx, hex_mode::xy};
    ABUT_UNROLLED (m, 0, 7)
      ABUT_UNROLLED (i, 0, 3) at[m][i] = Real{};
    ABUT_UNROLLED (d, 0, 3) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      // Mode d: (e x f) + 1/3 (de x df). Mode ef: 1/3 (f x df + de x e).
      Real third[3] = {};
      add_cross(x, product[f], product[e], third);
      ABUT_UNROLLED (i, 0, 3) at[linear[d]][i] = (1.0 / 3.0) * third[i];
      add_cross(x, linear[e], linear[f], at[linear[d]]);
      Real twice[3] = {};
      add_cross(x, linear[f], product[e], twice);
      add_cross(x, product[f], linear[e], twice);
      ABUT_UNROLLED (i, 0, 3) at[product[d]][i] = (1.0 / 3.0) * twice[i];
    }
  }

  /// 64 V, by V = sum x_a V db_a/dx.
  [[gnu::always_inline]] Real volume(const Real (&x)[3][8]) const {
    Real sum = x[0][1] * at[1][0];
    ABUT_UNROLLED (m, 2, 7) sum = fused(x[0][m], at[m][0], sum);
    return sum;
  }
  /// The mean displacement gradient, entries i + 3 j; `inverse` of volume().
  template <int N>
  [[gnu::always_inline]] void gradient(const Real (&u)[3][8], const Real& inverse,
                                       TensorLanes<N>& h) const {
    ABUT_UNROLLED (i, 0, 3)
      ABUT_UNROLLED (j, 0, 3) {
        Real sum = u[i][1] * at[1][j];
        ABUT_UNROLLED (m, 2, 7) sum = fused(u[i][m], at[m][j], sum);
        h.entry[i + 3 * j] = sum * inverse;
      }
  }
};

/// One point with the mean gradient of the cell, and a stiffness against the four hourglass fields
/// that is an energy of the distances by which the deformed cell fails to be an affine image of
/// the reference one (Flanagan and Belytschko 1981, in total Lagrangian form) [M.51, M.52].
struct Hex8OnePoint {
  static constexpr int nodes = 8;

  template <int N, class Law, class Sums>
  [[gnu::always_inline]] static void evaluate(const double* nodal_x, const double* nodal_u,
                                              double* force, const Law& law,
                                              const BatchedParameters& parameters, Sums& sums) {
    using Real = typename Lanes<N>::Real;
    Real x[3][8], u[3][8];
    load_hex_modes<N>(nodal_x, x);
    load_hex_modes<N>(nodal_u, u);
    const HexMeanGradients<Real> mean(x);
    const Real scaled = mean.volume(x), inverse = 1.0 / scaled, volume = (1.0 / 64.0) * scaled;
    TensorLanes<N> h;
    mean.template gradient<N>(u, inverse, h);
    LaneResponse<N> response;
    law(0, h, response);
    sums.add(volume, response);

    // k = coefficient M/24 V sum_a |b_a|^2; sum_a |V b_a|^2 = 8/64^2 sum_m |mean_m|^2.
    Real squares = mean.at[1][0] * mean.at[1][0];
    ABUT_UNROLLED (m, 1, 7)
      ABUT_UNROLLED (j, (m == 1 ? 1 : 0), 3) squares = fused(mean.at[m][j], mean.at[m][j], squares);
    const Real k = (parameters.hourglass / (24.0 * 8.0)) * squares * inverse;
    Real q[3][4], sum_q = Real{};  // k x gamma.u of the hourglasses 4 to 7
    ABUT_UNROLLED (i, 0, 3)
      ABUT_UNROLLED (m, 0, 4) {
        Real gap = u[i][m + 4];
        ABUT_UNROLLED (j, 0, 3) gap = fused(Real(-h.entry[i + 3 * j]), x[j][m + 4], gap);
        sum_q = fused(gap, gap, sum_q);
        q[i][m] = k * gap;
      }
    sums.stored = fused(Real(0.5 * k), sum_q, sums.stored);

    Real mode[3][8];
    ABUT_UNROLLED (i, 0, 3) {
      Real pull[3];  // what works on V b_a
      ABUT_UNROLLED (j, 0, 3) {
        Real moment = q[i][0] * x[j][4];
        ABUT_UNROLLED (m, 1, 4) moment = fused(q[i][m], x[j][m + 4], moment);
        pull[j] =
            fused(moment, Real(-64.0 * inverse), response.stress.entry[i + 3 * j]) * (1.0 / 64.0);
      }
      mode[i][0] = Real{};
      ABUT_UNROLLED (m, 1, 7) {
        mode[i][m] = fused(pull[0], mean.at[m][0],
                           fused(pull[1], mean.at[m][1], Real(pull[2] * mean.at[m][2])));
        if (m >= 4) mode[i][m] += q[i][m - 4];
      }
      mode[i][7] = q[i][3];
    }
    store_hex_modes<N>(mode, force);
  }
};

}  // namespace abut
