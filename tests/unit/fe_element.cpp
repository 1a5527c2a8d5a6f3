// Goal: every element of the table is what its name says.
// Oracles: interpolation identities, finite differences, the divergence theorem on distorted cells.

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_element_tests {
namespace {

using Vector = std::vector<double>;

class EveryElement : public testing::TestWithParam<Element> {
 protected:
  const Element& element = GetParam();
  const std::size_t dim = index(element.dim);
  const std::size_t nodes = index(element.nodes);
};

/// Points inside the reference shape, chosen without symmetry.
std::vector<Vector> inner_points(const Element& element) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.05, 0.30);
  std::vector<Vector> points(5, Vector(index(element.dim)));
  for (Vector& point : points)
    for (double& x : point) x = share(random);
  return points;
}

Vector values(const Element& element, const Vector& xi, Vector* derivatives = nullptr) {
  const auto nodes = index(element.nodes);
  Vector n(nodes), dn(nodes * xi.size());
  element.evaluate(xi, n, dn);
  if (derivatives != nullptr) *derivatives = dn;
  return n;
}

/// A polynomial of the element's order in all its coordinates.
double field(const Element& element, const double* x) {
  double value = 0.3;
  for (int d = 0; d < element.dim; ++d) {
    value += (1.0 + d) * x[d];
    for (int k = 0; k <= d && element.order == 2; ++k) value += (0.5 - d + 2.0 * k) * x[d] * x[k];
  }
  return value;
}

TEST_P(EveryElement, FunctionsSumToOneAndDerivativesToZero) {
  for (const Vector& xi : inner_points(element)) {
    Vector dn;
    const Vector n = values(element, xi, &dn);
    double sum = 0.0;
    for (double value : n) sum += value;
    EXPECT_NEAR(sum, 1.0, roundoff(64, 1.0));  // 20 nodes, 3 factors
    for (std::size_t d = 0; d < dim; ++d) {
      double slope = 0.0;
      for (std::size_t a = 0; a < nodes; ++a) slope += dn[a * dim + d];
      EXPECT_NEAR(slope, 0.0, roundoff(64, 4.0));  // slopes are at most 4
    }
  }
}

TEST_P(EveryElement, AFunctionIsOneAtItsNodeAndZeroAtTheOthers) {
  ASSERT_EQ(element.corners.size(), nodes * dim);
  for (std::size_t b = 0; b < nodes; ++b) {
    const auto from = element.corners.begin() + static_cast<std::ptrdiff_t>(b * dim);
    const Vector at(from, from + static_cast<std::ptrdiff_t>(dim));
    const Vector n = values(element, at);
    for (std::size_t a = 0; a < nodes; ++a) EXPECT_EQ(n[a], a == b ? 1.0 : 0.0) << a << " " << b;
  }
}

TEST_P(EveryElement, DerivativesAreThoseOfTheFunctions) {
  const double h = 1e-3;  // in one direction N is quadratic: central differences only round
  for (const Vector& xi : inner_points(element)) {
    Vector dn;
    values(element, xi, &dn);
    for (std::size_t d = 0; d < dim; ++d) {
      Vector ahead = xi, behind = xi;
      ahead[d] += h;
      behind[d] -= h;
      const Vector n_ahead = values(element, ahead), n_behind = values(element, behind);
      for (std::size_t a = 0; a < nodes; ++a) {
        const double slope = (n_ahead[a] - n_behind[a]) / (2.0 * h);
        EXPECT_NEAR(dn[a * dim + d], slope, roundoff(64, 1.0) / h) << a << " " << d;
      }
    }
  }
}

TEST_P(EveryElement, ReproducesPolynomialsOfItsOrder) {
  for (const Vector& xi : inner_points(element)) {
    const Vector n = values(element, xi);
    double interpolated = 0.0;
    for (std::size_t a = 0; a < nodes; ++a)
      interpolated += n[a] * field(element, element.corners.data() + a * dim);
    // sums of 20 values up to 20
    EXPECT_NEAR(interpolated, field(element, xi.data()), roundoff(64, 20.0));
  }
}

TEST_P(EveryElement, RestrictedToAFacetIsTheFacetsElement) {
  for (const std::vector<int>& facet : element.facets) {
    const Element& face = element_named(element.facet_name);
    ASSERT_EQ(face.dim, element.dim - 1);
    ASSERT_EQ(facet.size(), index(face.nodes));
    for (const Vector& s : inner_points(face)) {
      const Vector n_face = values(face, s);
      Vector xi(dim, 0.0), expected(nodes, 0.0);
      for (std::size_t a = 0; a < facet.size(); ++a) {
        const auto node = index(facet[a]);
        expected[node] = n_face[a];
        for (std::size_t d = 0; d < dim; ++d) xi[d] += n_face[a] * element.corners[node * dim + d];
      }
      EXPECT_LE(largest_difference(values(element, xi), expected), roundoff(64, 1.0));
    }
  }
}

/// Nodes of the cell moved by up to a tenth of the shape: curved edges and warped faces.
Vector distorted(const Element& element) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> move(-0.1, 0.1);
  Vector x = element.corners;
  for (double& value : x) value += move(random);
  return x;
}

double determinant(const double* j, std::size_t dim) {
  if (dim == 1) return j[0];
  if (dim == 2) return j[0] * j[3] - j[1] * j[2];
  return j[0] * (j[4] * j[8] - j[5] * j[7]) - j[1] * (j[3] * j[8] - j[5] * j[6]) +
         j[2] * (j[3] * j[7] - j[4] * j[6]);
}

/// dx_i / dxi_j at a point of the table, (space, table.dim).
Vector jacobian(const Tabulation& table, std::size_t q, const Vector& x, std::size_t space) {
  const auto nodes = index(table.nodes);
  const auto dim = index(table.dim);
  Vector j(space * dim, 0.0);
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t i = 0; i < space; ++i)
      for (std::size_t k = 0; k < dim; ++k)
        j[i * dim + k] += x[a * space + i] * table.dn[(q * nodes + a) * dim + k];
  return j;
}

/// Normal times area per reference area of a facet.
Vector area_vector(const Vector& j, std::size_t space, std::size_t local) {
  if (space == 1) return {local == 0 ? -1.0 : 1.0};
  if (space == 2) return {j[1], -j[0]};
  return {j[2] * j[5] - j[4] * j[3], j[4] * j[1] - j[0] * j[5], j[0] * j[3] - j[2] * j[1]};
}

TEST_P(EveryElement, FacetsCloseTheCellAndPointOutwards) {
  if (element.dim == 0) return;
  const int degree = 8;  // x . n dA of a quadratic face: at most 6 in each direction
  const Vector x = distorted(element);
  const Tabulation cell = tabulate(element, quadrature(element.shape, degree));
  double volume = 0.0;
  for (std::size_t q = 0; q < cell.weight.size(); ++q)
    volume += cell.weight[q] * determinant(jacobian(cell, q, x, dim).data(), dim);
  EXPECT_GT(volume, 0.0);

  const Element& face = element_named(element.facet_name);
  const Tabulation table = tabulate(face, quadrature(face.shape, degree));
  Vector closed(dim, 0.0);
  double flux = 0.0;
  for (std::size_t f = 0; f < element.facets.size(); ++f) {
    Vector y;
    for (int node : element.facets[f])
      for (std::size_t d = 0; d < dim; ++d) y.push_back(x[index(node) * dim + d]);
    for (std::size_t q = 0; q < table.weight.size(); ++q) {
      const Vector area = area_vector(jacobian(table, q, y, dim), dim, f);
      for (std::size_t d = 0; d < dim; ++d) {
        double position = 0.0;
        for (std::size_t a = 0; a < y.size() / dim; ++a)
          position += table.n[q * (y.size() / dim) + a] * y[a * dim + d];
        closed[d] += table.weight[q] * area[d];
        flux += table.weight[q] * area[d] * position;
      }
    }
  }
  // a few hundred terms of size at most 4
  for (double sum : closed) EXPECT_NEAR(sum, 0.0, roundoff(1000, 4.0));
  EXPECT_NEAR(flux, element.dim * volume, roundoff(1000, 8.0));
}

TEST_P(EveryElement, RulesOfItsMassAndStiffnessAreExact) {
  // held against a rule of twice the degree: N_a N_b and grad N_a . grad N_b on the reference cell
  for (bool mass : {true, false}) {
    const int degree = mass ? mass_degree(element) : stiffness_degree(element);
    Vector sums[2];
    for (int k : {0, 1}) {
      const Tabulation table = tabulate(element, quadrature(element.shape, (k + 1) * degree + k));
      sums[k].assign(nodes * nodes, 0.0);
      for (std::size_t q = 0; q < table.weight.size(); ++q) {
        const double* n = &table.n[q * nodes];
        const double* dn = table.dn.data() + q * nodes * dim;
        for (std::size_t a = 0; a < nodes; ++a)
          for (std::size_t b = 0; b < nodes; ++b) {
            double product = mass ? n[a] * n[b] : 0.0;
            for (std::size_t d = 0; d < dim && !mass; ++d)
              product += dn[a * dim + d] * dn[b * dim + d];
            sums[k][a * nodes + b] += table.weight[q] * product;
          }
      }
    }
    // up to 125 points with entries up to 10
    EXPECT_LE(largest_difference(sums[0], sums[1]), roundoff(500, 10.0)) << "mass " << mass;
  }
}

TEST_P(EveryElement, IsFoundByName) { EXPECT_EQ(element_named(element.name).nodes, element.nodes); }

INSTANTIATE_TEST_SUITE_P(Table, EveryElement,
                         testing::ValuesIn(all_elements().begin(), all_elements().end()),
                         [](const testing::TestParamInfo<Element>& item) {
                           return std::string(item.param.name);
                         });

TEST(Element, AnUnknownNameIsRefusedWithTheKnownOnes) {
  try {
    element_named("tri9");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tri9"), std::string::npos);
    EXPECT_NE(error.remedy.find("hex20"), std::string::npos);
  }
}

}  // namespace
}  // namespace abut::fe_element_tests
