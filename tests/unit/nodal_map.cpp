// Goal: maps of a few nodal values are those of the whole. Oracle: the whole.
#include "subdomain_solver/nodal_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "subdomain_solver/modal/modal_map.hpp"

namespace abut {
namespace {

/// Not linear in q, and without a short way to a few values.
class Curved final : public NodalMap {
 public:
  void displacement(std::span<const double> q, std::span<double> u) const override {
    for (std::size_t k = 0; k < u.size(); ++k) u[k] = q[k] * q[k];
  }
  void velocity(std::span<const double> q, std::span<const double> v,
                std::span<double> out) const override {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = 2.0 * q[k] * v[k];
  }
  void acceleration(std::span<const double> q, std::span<const double> v, std::span<const double> a,
                    std::span<double> out) const override {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = 2.0 * (q[k] * a[k] + v[k] * v[k]);
  }
  void lift(std::span<const double> q, std::span<const double> nodal,
            Vector& force) const override {
    for (std::size_t k = 0; k < nodal.size(); ++k)
      force(static_cast<Eigen::Index>(k)) += 2.0 * q[k] * nodal[k];
  }
};

constexpr std::size_t nodal = 8;
const std::vector<int> values = {5, 0, 6, 5};  // of two ports that share a node

void expect_that_of_the_whole(const NodalMap& whole, std::size_t coordinates) {
  std::vector<double> q(coordinates), v(coordinates), a(coordinates);
  for (std::size_t k = 0; k < coordinates; ++k) {
    q[k] = std::sin(1.0 + double(k));
    v[k] = std::cos(3.0 * double(k));
    a[k] = 0.25 * double(k) - 1.0;
  }
  const std::unique_ptr<NodalMap> some = whole.on(values, nodal);
  std::vector<double> all(nodal), few(values.size());
  const auto expect_equal = [&] {
    for (std::size_t k = 0; k < values.size(); ++k)
      EXPECT_DOUBLE_EQ(few[k], all[static_cast<std::size_t>(values[k])]);
  };
  whole.displacement(q, all);
  some->displacement(q, few);
  expect_equal();
  whole.velocity(q, v, all);
  some->velocity(q, v, few);
  expect_equal();
  whole.acceleration(q, v, a, all);
  some->acceleration(q, v, a, few);
  expect_equal();
  const std::vector<double> forces = {1.0, -2.0, 0.5, 3.0};
  std::vector<double> spread(nodal, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k)
    spread[static_cast<std::size_t>(values[k])] += forces[k];
  Vector one = Vector::Ones(static_cast<Eigen::Index>(coordinates)), other = one;
  whole.lift(q, spread, one);
  some->lift(q, forces, other);
  EXPECT_LT((one - other).norm(), 1.0e-15 * (1.0 + one.norm()) * 8.0);  // sums of 8, in two orders
}

TEST(NodalMapOfAFewValues, IsThatOfTheWhole) {
  expect_that_of_the_whole(IdentityMap(), nodal);
  expect_that_of_the_whole(ModalMap(Eigen::MatrixXd::Random(8, 3)), 3);
  expect_that_of_the_whole(Curved(), nodal);
}

}  // namespace
}  // namespace abut
