#include "subdomain_solver/fe/shape_functions.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

using Values = std::span<double>;

void constant(std::span<const double>, Values n, Values) { n[0] = 1.0; }

/// Barycentric coordinates of the unit simplex.
template <std::size_t Dim>
std::array<double, Dim + 1> barycentric(std::span<const double> xi) {
  std::array<double, Dim + 1> l{1.0};
  for (std::size_t d = 0; d < Dim; ++d) {
    l[d + 1] = xi[d];
    l[0] -= xi[d];
  }
  return l;
}

/// Derivative of barycentric coordinate a in direction d.
constexpr double slope(std::size_t a, std::size_t d) {
  return a == 0 ? -1.0 : (a == d + 1 ? 1.0 : 0.0);
}

template <std::size_t Dim>
void linear_simplex(std::span<const double> xi, Values n, Values dn) {
  const auto l = barycentric<Dim>(xi);
  for (std::size_t a = 0; a <= Dim; ++a) {
    n[a] = l[a];
    for (std::size_t d = 0; d < Dim; ++d) dn[a * Dim + d] = slope(a, d);
  }
}

/// Corners l (2 l - 1), between corners 4 l l'.
template <std::size_t Dim, const auto& Edges>
void quadratic_simplex(std::span<const double> xi, Values n, Values dn) {
  const auto l = barycentric<Dim>(xi);
  for (std::size_t a = 0; a <= Dim; ++a) {
    n[a] = l[a] * (2.0 * l[a] - 1.0);
    for (std::size_t d = 0; d < Dim; ++d) dn[a * Dim + d] = (4.0 * l[a] - 1.0) * slope(a, d);
  }
  for (std::size_t e = 0; e < Edges.size(); ++e) {
    const std::size_t node = Dim + 1 + e;
    const auto a = index(Edges[e][0]);
    const auto b = index(Edges[e][1]);
    n[node] = 4.0 * l[a] * l[b];
    for (std::size_t d = 0; d < Dim; ++d)
      dn[node * Dim + d] = 4.0 * (slope(a, d) * l[b] + l[a] * slope(b, d));
  }
}

/// A product of one factor per direction and its derivatives.
template <std::size_t Dim>
void product(const std::array<double, Dim>& factor, const std::array<double, Dim>& derivative,
             double scale, double& n, double* dn) {
  n = scale;
  for (std::size_t d = 0; d < Dim; ++d) {
    n *= factor[d];
    dn[d] = scale;
    for (std::size_t k = 0; k < Dim; ++k) dn[d] *= k == d ? derivative[k] : factor[k];
  }
}

/// Product of (1 + xi xi_a) / 2 over the directions.
template <std::size_t Dim>
void linear_cube(std::span<const double> xi, Values n, Values dn) {
  constexpr auto corner = cube_corners<Dim>();
  for (std::size_t a = 0; a < corner.size(); ++a) {
    std::array<double, Dim> factor{};
    for (std::size_t d = 0; d < Dim; ++d) factor[d] = 1.0 + xi[d] * corner[a][d];
    product<Dim>(factor, corner[a], 1.0 / static_cast<double>(corner.size()), n[a], &dn[a * Dim]);
  }
}

/// Serendipity of order 2. With p = product of (1 + xi xi_a): corners 2^-Dim p (sum xi xi_a - Dim +
/// 1), between corners 2^-(Dim-1) p with the factor of the edge's direction replaced by 1 - xi^2.
template <std::size_t Dim, const auto& Edges>
void serendipity(std::span<const double> xi, Values n, Values dn) {
  constexpr auto corner = cube_corners<Dim>();
  constexpr double scale = 1.0 / static_cast<double>(corner.size());
  for (std::size_t a = 0; a < corner.size(); ++a) {
    std::array<double, Dim> factor{};
    double sum = 1.0 - static_cast<double>(Dim);
    for (std::size_t d = 0; d < Dim; ++d) {
      factor[d] = 1.0 + xi[d] * corner[a][d];
      sum += xi[d] * corner[a][d];
    }
    double p = 0.0;
    std::array<double, Dim> dp{};
    product<Dim>(factor, corner[a], scale, p, dp.data());
    n[a] = p * sum;
    for (std::size_t d = 0; d < Dim; ++d) dn[a * Dim + d] = dp[d] * sum + p * corner[a][d];
  }
  for (std::size_t e = 0; e < Edges.size(); ++e) {
    const auto& from = corner[Edges[e][0]];
    const auto& to = corner[Edges[e][1]];
    std::array<double, Dim> factor{}, derivative{};
    for (std::size_t d = 0; d < Dim; ++d) {
      const bool along = from[d] != to[d];
      factor[d] = along ? 1.0 - xi[d] * xi[d] : 1.0 + xi[d] * from[d];
      derivative[d] = along ? -2.0 * xi[d] : from[d];
    }
    const std::size_t node = corner.size() + e;
    product<Dim>(factor, derivative, 2.0 * scale, n[node], &dn[node * Dim]);
  }
}

/// Products of the quadratic polynomials of a line, which are 1 at one of -1, 0, 1 and 0 at the
/// others.
void quadratic_square(std::span<const double> xi, Values n, Values dn) {
  constexpr int at[9][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1},
                            {0, -1},  {1, 0},  {0, 1}, {-1, 0}, {0, 0}};
  for (std::size_t a = 0; a < 9; ++a) {
    std::array<double, 2> factor{}, derivative{};
    for (std::size_t d = 0; d < 2; ++d) {
      const double s = at[a][d];
      factor[d] = s == 0.0 ? 1.0 - xi[d] * xi[d] : 0.5 * xi[d] * (xi[d] + s);
      derivative[d] = s == 0.0 ? -2.0 * xi[d] : xi[d] + 0.5 * s;
    }
    product<2>(factor, derivative, 1.0, n[a], &dn[a * 2]);
  }
}

}  // namespace

const ShapeFunctions& shape_functions() {
  static const ShapeFunctions all = {
      .point1 = constant,
      .bar2 = linear_cube<1>,
      .bar3 = serendipity<1, line_edges>,
      .tri3 = linear_simplex<2>,
      .tri6 = quadratic_simplex<2, triangle_edges>,
      .quad4 = linear_cube<2>,
      .quad8 = serendipity<2, quadrilateral_edges>,
      .quad9 = quadratic_square,
      .tet4 = linear_simplex<3>,
      .tet10 = quadratic_simplex<3, tetrahedron_edges>,
      .hex8 = linear_cube<3>,
      .hex20 = serendipity<3, hexahedron_edges>,
  };
  return all;
}

}  // namespace abut
