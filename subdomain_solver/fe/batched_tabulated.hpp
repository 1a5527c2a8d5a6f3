#pragma once

#include "subdomain_solver/fe/batched_hex8.hpp"

namespace abut {

/// Cells in space with so many nodes, at the points of the rule that the parameters have.
template <int count>
struct TabulatedCell {
  static constexpr int nodes = count;

  template <int N, class Law, class Sums>
  [[gnu::always_inline]] static void evaluate(const double* x, const double* u, double* force,
                                              const Law& law, const BatchedParameters& parameters,
                                              Sums& sums) {
    using Real = typename Lanes<N>::Real;
    for (int k = 0; k < 3 * nodes; ++k) store<N>(Real{}, force + k * batch_lanes);
    for (int p = 0; p < parameters.points; ++p) {
      const double* slope = parameters.slope + p * 3 * nodes;
      TensorLanes<N> cof, h;
      const Real det = cofactor(derivative<N>(x, slope), cof);
      displacement_gradient<N>(derivative<N>(u, slope), cof, Real(1.0 / det), h);
      LaneResponse<N> response;
      law(p, h, response);
      const Real volume = parameters.weight[p] * det;
      sums.add(volume, response);
      TensorLanes<N> pull;  // [J] by component and direction
      const Real weight = broadcast<Real>(parameters.weight[p]);
      ABUT_UNROLLED (d, 0, 3)
        ABUT_UNROLLED (i, 0, 3) {
          const Real *s = response.stress.entry + i, *c = cof.entry + 3 * d;
          pull.entry[i + 3 * d] = weight * fused(s[0], c[0], fused(s[3], c[1], Real(s[6] * c[2])));
        }
      add_forces<N>(pull, slope, force);
    }
  }

 private:
  /// d/dxi of values at the nodes: entry i + 3 d.
  template <int N>
  [[gnu::always_inline]] static TensorLanes<N> derivative(const double* values,
                                                          const double* slope) {
    using Real = typename Lanes<N>::Real;
    TensorLanes<N> out{};
    for (int a = 0; a < nodes; ++a)
      ABUT_UNROLLED (i, 0, 3) {
        const Real value = load<N>(values + (3 * a + i) * batch_lanes);
        ABUT_UNROLLED (d, 0, 3) {
          Real& sum = out.entry[i + 3 * d];
          sum = fused(value, broadcast<Real>(slope[3 * a + d]), sum);
        }
      }
    return out;
  }

  template <int N>
  [[gnu::always_inline]] static void add_forces(const TensorLanes<N>& pull, const double* slope,
                                                double* force) {
    using Real = typename Lanes<N>::Real;
    for (int a = 0; a < nodes; ++a)
      ABUT_UNROLLED (i, 0, 3) {
        double* at = force + (3 * a + i) * batch_lanes;
        Real sum = load<N>(at);
        ABUT_UNROLLED (d, 0, 3)
          sum = fused(pull.entry[i + 3 * d], broadcast<Real>(slope[3 * a + d]), sum);
        store<N>(sum, at);
      }
  }
};

}  // namespace abut
