// Quadrature rules on the reference shapes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/element.hpp"

namespace abut {
namespace {

/// Gauss-Legendre with n points: zeros of the Legendre polynomial by Newton from the usual
/// asymptotic guess, weights 2 / ((1 - x^2) P'^2).
Quadrature gauss(int n) {
  Quadrature rule;
  const auto count = index(n);
  rule.points.assign(count, 0.0);
  rule.weights.assign(count, 0.0);
  for (std::size_t i = 0; i < (count + 1) / 2; ++i) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
    if (2 * i + 1 == count) x = 0.0;
    double slope = 1.0;
    for (int newton = 0; newton < 8; ++newton) {  // quadratic from 3 digits: 4 suffice
      double before = 1.0, value = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1.0);
      if (2 * i + 1 != count) x -= value / slope;
    }
    const double weight = 2.0 / ((1.0 - x * x) * slope * slope);
    rule.points[i] = -x;
    rule.points[count - 1 - i] = x;
    rule.weights[i] = rule.weights[count - 1 - i] = weight;
  }
  return rule;
}

/// Points that make up degree 2 n - 1.
int gauss_points(int degree) { return degree / 2 + 1; }

/// The product rule on [-1, 1]^dim; the last direction runs fastest.
Quadrature gauss_product(int dim, int degree) {
  const Quadrature line = gauss(gauss_points(degree));
  Quadrature rule{{}, {1.0}};
  for (int d = 0; d < dim; ++d) {
    Quadrature next;
    for (std::size_t q = 0; q < rule.weights.size(); ++q) {
      const auto begin = rule.points.begin() + static_cast<std::ptrdiff_t>(q) * d;
      for (std::size_t i = 0; i < line.weights.size(); ++i) {
        next.points.insert(next.points.end(), begin, begin + d);
        next.points.push_back(line.points[i]);
        next.weights.push_back(rule.weights[q] * line.weights[i]);
      }
    }
    rule = std::move(next);
  }
  return rule;
}

/// The unit cube collapsed onto the simplex (Duffy): x_d = u_d prod_{k<d} (1 - u_k). The Jacobian
/// prod (1 - u_k)^(dim-1-k) costs dim - 1 more degrees.
Quadrature collapsed(int dim, int degree) {
  Quadrature rule = gauss_product(dim, degree + dim - 1);
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    double left = 1.0;
    for (int d = 0; d < dim; ++d) {
      double& x = rule.points[q * index(dim) + index(d)];
      const double u = 0.5 * (1.0 + x);
      rule.weights[q] *= 0.5 * left;
      x = u * left;
      left *= 1.0 - u;
    }
  }
  return rule;
}

/// Points that share a weight: all distinct permutations of barycentric coordinates, of which the
/// last is 1 minus the others.
template <std::size_t Dim>
struct Orbit {
  double weight;  // as a share of the volume, of every point
  std::array<double, Dim> coordinates;
};

template <std::size_t Dim>
Quadrature symmetric(std::initializer_list<Orbit<Dim>> orbits) {
  constexpr double volume = Dim == 2 ? 1.0 / 2.0 : 1.0 / 6.0;
  Quadrature rule;
  for (const Orbit<Dim>& orbit : orbits) {
    std::array<double, Dim + 1> point{};
    point[Dim] = 1.0;
    for (std::size_t d = 0; d < Dim; ++d) {
      point[d] = orbit.coordinates[d];
      point[Dim] -= point[d];
    }
    // coordinates that are meant to be equal may differ by a rounding in the last one
    for (std::size_t d = 0; d < Dim; ++d)
      if (std::abs(point[d] - point[Dim]) < 1e-14) point[Dim] = point[d];
    std::sort(point.begin(), point.end());
    do {
      rule.points.insert(rule.points.end(), point.begin(), point.begin() + Dim);
      rule.weights.push_back(orbit.weight * volume);
    } while (std::next_permutation(point.begin(), point.end()));
  }
  return rule;
}

/// Degrees 2: Hammer and Stroud 1956; 4 and 6: Strang and Fix 1973, Dunavant 1985; 5: Radon 1948.
/// Digits beyond the printed ones by Newton on the moment equations.
Quadrature triangle_rule(int degree) {
  constexpr double third = 1.0 / 3.0, sixth = 1.0 / 6.0;
  if (degree <= 1) return symmetric<2>({{1.0, {third, third}}});
  if (degree <= 2) return symmetric<2>({{third, {sixth, sixth}}});
  if (degree <= 4)
    return symmetric<2>(
        {{0.22338158967801146570, {0.44594849091596488632, 0.44594849091596488632}},
         {0.10995174365532186764, {0.09157621350977074346, 0.09157621350977074346}}});
  if (degree <= 5) {
    const double root = std::sqrt(15.0);
    const double a = (6.0 + root) / 21.0, b = (6.0 - root) / 21.0;
    return symmetric<2>({{9.0 / 40.0, {third, third}},
                         {(155.0 + root) / 1200.0, {a, a}},
                         {(155.0 - root) / 1200.0, {b, b}}});
  }
  if (degree <= 6)
    return symmetric<2>(
        {{0.11678627572637936603, {0.24928674517091042129, 0.24928674517091042129}},
         {0.05084490637020681692, {0.06308901449150222834, 0.06308901449150222834}},
         {0.08285107561837357519, {0.05314504984481694735, 0.31035245103378440542}}});
  return collapsed(2, degree);
}

/// Degrees 2: Hammer and Stroud 1956; 5: Walkington 2000; 6: Keast 1986. Degree 3 and 4 take the
/// rule of degree 5: smaller ones of theirs have negative weights.
Quadrature tetrahedron_rule(int degree) {
  if (degree <= 1) return symmetric<3>({{1.0, {0.25, 0.25, 0.25}}});
  if (degree <= 2) {
    const double a = (5.0 - std::sqrt(5.0)) / 20.0;
    return symmetric<3>({{0.25, {a, a, a}}});
  }
  if (degree <= 5) {
    constexpr double a = 0.3108859192633006098, b = 0.0927352503108912264;
    constexpr double c = 0.0455037041256496495;
    return symmetric<3>({{0.1126879257180158508, {a, a, a}},
                         {0.0734930431163619495, {b, b, b}},
                         {0.0425460207770814664, {c, c, 0.5 - c}}});
  }
  if (degree <= 6) {
    constexpr double a = 0.2146028712591520293, b = 0.0406739585346113531;
    constexpr double c = 0.3223378901422755103, d = 0.0636610018750175253;
    return symmetric<3>({{0.0399227502581674921, {a, a, a}},
                         {0.0100772110553206429, {b, b, b}},
                         {0.0553571815436547221, {c, c, c}},
                         {27.0 / 560.0, {d, d, 0.2696723314583158080}}});
  }
  return collapsed(3, degree);
}

}  // namespace

Quadrature quadrature(Shape shape, int degree) {
  ABUT_ASSERT(degree >= 0);
  switch (shape) {
    case Shape::point:
      return {{}, {1.0}};
    case Shape::line:
      return gauss_product(1, degree);
    case Shape::triangle:
      return triangle_rule(degree);
    case Shape::quadrilateral:
      return gauss_product(2, degree);
    case Shape::tetrahedron:
      return tetrahedron_rule(degree);
    case Shape::hexahedron:
      return gauss_product(3, degree);
  }
  ABUT_ASSERT(false && "shape without a rule");
  return {};
}

}  // namespace abut
