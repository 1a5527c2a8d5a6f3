// Goal: quadrature rules have the degree that was asked for, positive weights and inner points.
// Oracle: closed integrals of all monomials.

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_quadrature_tests {
namespace {

struct Case {
  Shape shape;
  int dim;
  bool simplex;
  int highest;  // degree tested
  const char* name;
};

const Case cases[] = {{Shape::line, 1, false, 15, "line"},
                      {Shape::triangle, 2, true, 9, "triangle"},
                      {Shape::quadrilateral, 2, false, 9, "quadrilateral"},
                      {Shape::tetrahedron, 3, true, 9, "tetrahedron"},
                      {Shape::hexahedron, 3, false, 7, "hexahedron"}};

double factorial(int n) { return std::tgamma(n + 1.0); }

/// Integral of x^i y^j z^k over the reference shape.
double exact(const Case& c, const int (&power)[3]) {
  if (c.simplex) {
    return factorial(power[0]) * factorial(power[1]) * factorial(power[2]) /
           factorial(power[0] + power[1] + power[2] + c.dim);
  }
  double value = 1.0;
  for (int d = 0; d < c.dim; ++d) value *= power[d] % 2 == 1 ? 0.0 : 2.0 / (power[d] + 1.0);
  return value;
}

double by_rule(const Case& c, const Quadrature& rule, const int (&power)[3]) {
  double sum = 0.0;
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    double term = rule.weights[q];
    for (int d = 0; d < c.dim; ++d)
      term *= std::pow(rule.points[q * index(c.dim) + index(d)], power[d]);
    sum += term;
  }
  return sum;
}

class EveryShape : public testing::TestWithParam<Case> {};

TEST_P(EveryShape, IntegratesAllMonomialsOfItsDegree) {
  const Case c = GetParam();
  for (int degree = 0; degree <= c.highest; ++degree) {
    const Quadrature rule = quadrature(c.shape, degree);
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; j <= (c.dim > 1 ? degree : 0); ++j)
        for (int k = 0; k <= (c.dim > 2 ? degree : 0); ++k) {
          if (c.simplex && i + j + k > degree) continue;
          // coordinates are known to a rounding, powers up to 15 of at most 512 terms, sum <= 8
          EXPECT_NEAR(by_rule(c, rule, {i, j, k}), exact(c, {i, j, k}), roundoff(200, 8.0))
              << degree << ": " << i << j << k;
        }
  }
}

TEST_P(EveryShape, HasPositiveWeightsAndInnerPoints) {
  const Case c = GetParam();
  for (int degree = 0; degree <= c.highest; ++degree) {
    const Quadrature rule = quadrature(c.shape, degree);
    for (double weight : rule.weights) EXPECT_GT(weight, 0.0);
    for (std::size_t q = 0; q < rule.weights.size(); ++q) {
      double sum = 0.0;
      for (std::size_t d = 0; d < index(c.dim); ++d) {
        const double x = rule.points[q * index(c.dim) + d];
        sum += x;
        EXPECT_GT(x, c.simplex ? 0.0 : -1.0);
        EXPECT_LT(x, 1.0);
      }
      EXPECT_LT(sum, c.simplex ? 1.0 : c.dim);
    }
  }
}

// Smallest rules: an accidental permutation twice over would still integrate, at twice the cost.
TEST(Quadrature, HasTheNumberOfPointsOfTheLiterature) {
  const int triangle[] = {1, 1, 3, 6, 6, 7, 12}, tetrahedron[] = {1, 1, 4, 14, 14, 14, 24};
  for (int degree = 0; degree <= 6; ++degree) {
    EXPECT_EQ(quadrature(Shape::triangle, degree).count(), triangle[degree]) << degree;
    EXPECT_EQ(quadrature(Shape::tetrahedron, degree).count(), tetrahedron[degree]) << degree;
    EXPECT_EQ(quadrature(Shape::line, degree).count(), degree / 2 + 1) << degree;
  }
  EXPECT_EQ(quadrature(Shape::quadrilateral, 3).count(), 4);
  EXPECT_EQ(quadrature(Shape::hexahedron, 3).count(), 8);
  EXPECT_EQ(quadrature(Shape::point, 4).count(), 1);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(cases),
                         [](const testing::TestParamInfo<Case>& item) {
                           return std::string(item.param.name);
                         });

}  // namespace
}  // namespace abut::fe_quadrature_tests
