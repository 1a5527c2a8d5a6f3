#pragma once

#include "subdomain_solver/fe/batched_flat_cells.hpp"
#include "subdomain_solver/fe/batched_hex8.hpp"

namespace abut {

/// The points of a cell with one volume change [M.44]: from their displacement gradients H to the
/// stresses that work on F, [M.44] and what CellKernel::split_force() says.
template <int N, int points>
struct DilatedPoints {
  using Real = typename Lanes<N>::Real;
  TensorLanes<N> h[points];       // H, which stays
  TensorLanes<N> stress[points];  // [Pa] per volume of the point
  Real volume[points];            // [m^3]

  template <class Law, class Sums>
  [[gnu::always_inline]] void respond(const Law& law, Sums& sums, const int (&place)[points]) {
    Real growth[points], third[points], stretch[points], whole = Real{}, swollen = Real{};
    for (int p = 0; p < points; ++p) {
      growth[p] = volume_growth(h[p]);
      whole += volume[p];
      swollen = fused(volume[p], growth[p], swollen);
    }
    const Real mean = swollen / whole, theta = 1.0 + mean;
    sums.valid &= theta > 0.0;
    Real amount = Real{};
    for (int p = 0; p < points; ++p) {
      sums.valid &= growth[p] > -1.0;
      const Real more = inverse_cube_root_less_one<N>(Real((growth[p] - mean) / theta));
      stretch[p] = 1.0 + more;
      TensorLanes<N> f = plus_identity(h[p]), carried;  // Fbar - I = H + (s - 1) F
      ABUT_UNROLLED (k, 0, 9) carried.entry[k] = fused(more, f.entry[k], h[p].entry[k]);
      LaneResponse<N> response;
      law(place[p], carried, response);
      sums.add(volume[p], response);
      stress[p] = response.stress;
      Real work = stress[p].entry[0] * f.entry[0];  // P : F
      ABUT_UNROLLED (k, 1, 9) work = fused(stress[p].entry[k], f.entry[k], work);
      third[p] = (1.0 / 3.0) * stretch[p] * work;
      amount = fused(volume[p], third[p], amount);
    }
    amount = amount / (theta * whole);
    for (int p = 0; p < points; ++p) {
      TensorLanes<N> cof;
      const Real j = cofactor(plus_identity(h[p]), cof);
      const Real pressure = amount - third[p] / j;
      ABUT_UNROLLED (k, 0, 9)
        stress[p].entry[k] = fused(pressure, cof.entry[k], Real(stretch[p] * stress[p].entry[k]));
    }
  }

 private:
  /// det(I + H) - 1 without the difference.
  [[gnu::always_inline]] static Real volume_growth(const TensorLanes<N>& h) {
    TensorLanes<N> minors;
    const Real determinant = cofactor(h, minors);
    const Real trace = h.entry[0] + h.entry[4] + h.entry[8];
    return trace + (minors.entry[0] + minors.entry[4] + minors.entry[8]) + determinant;
  }
};

/// Mean dilatation with 2x2x2 points, as Hex8 otherwise.
struct Hex8MeanDilatation {
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
    DilatedPoints<N, 8> points;
    TensorLanes<N> cof[8];
    int place[8];
    for (int p = 0; p < 8; ++p) {
      const int a = p & 1, b = (p >> 1) & 1, c = p >> 2;
      const int line[3] = {b + 2 * c, a + 2 * c, a + 2 * b};
      place[p] = history_place(a, b, c);
      TensorLanes<N> j, g;
      ABUT_UNROLLED (d, 0, 3)
        ABUT_UNROLLED (i, 0, 3) {
          j.entry[i + 3 * d] = along.at[d][line[d]][i];
          g.entry[i + 3 * d] = moved.at[d][line[d]][i];
        }
      const Real det = cofactor(j, cof[p]);
      displacement_gradient<N>(g, cof[p], Real(1.0 / det), points.h[p]);
      points.volume[p] = scale * det;
    }
    points.respond(law, sums, place);
    for (int p = 0; p < 8; ++p) {
      const int a = p & 1, b = (p >> 1) & 1, c = p >> 2;
      const int line[3] = {b + 2 * c, a + 2 * c, a + 2 * b};
      const Real* s = points.stress[p].entry;
      ABUT_UNROLLED (d, 0, 3)
        ABUT_UNROLLED (i, 0, 3) {
          Real& at = pull.at[d][line[d]][i];
          const Real* along_d = cof[p].entry + 3 * d;
          at =
              fused(s[i], along_d[0], fused(s[i + 3], along_d[1], fused(s[i + 6], along_d[2], at)));
        }
    }
    hex_forces(pull, scale, mode);
    store_hex_modes<N>(mode, force);
  }
};

/// The same of plane strain with 2x2 points, as Quad4 otherwise.
struct Quad4MeanDilatation {
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
    const double scale = parameters.thickness / 16.0;
    DilatedPoints<N, 4> points;
    QuadPoint<N> at[4];
    int place[4];
    for (int p = 0; p < 4; ++p) {
      place[p] = quad_history_place(p);
      at[p].set(x, quad_sign(p & 1), quad_sign(p >> 1));
      Real h[2][2];
      at[p].gradient(u, h);
      points.h[p] = plane_gradient<N>(h);
      points.volume[p] = scale * at[p].det;
    }
    points.respond(law, sums, place);
    for (int p = 0; p < 4; ++p) at[p].add_pull(points.stress[p], scale, pull);
    pull.store_to(force);
  }
};

}  // namespace abut
