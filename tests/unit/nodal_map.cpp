// Goal: maps of a few nodal values are those of the whole. Oracle: the whole.
#include "subdomain_solver/nodal_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/modal/modal_map.hpp"
#include "subdomain_solver/port_map.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::nodal_map_tests {
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
    for (std::size_t k = 0; k < values.size(); ++k) EXPECT_DOUBLE_EQ(few[k], all[values[k]]);
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
  for (std::size_t k = 0; k < values.size(); ++k) spread[values[k]] += forces[k];
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

/// A node of both ports has a frame of its own, in which the coordinates are.
TEST(PortMap, SeesAndPushesNodesAlongTheAxesOfSpace) {
  Matrix3 axes = Matrix3::Identity();
  axes.topLeftCorner<2, 2>() << 0.6, -0.8, 0.8, 0.6;
  const FeModel model(unit_mesh("quad4", 2), std::make_unique<LinearElastic>(Moduli{1.0, 1.0}, 1.0),
                      {}, {{8, axes}});
  const IdentityMap map;
  const std::vector<NamedNodes> ports = {{"right", {2, 5, 8}}, {"corner", {8}}};
  const PortMap seen(model, map, ports);
  ASSERT_EQ(seen.values(), 8u);
  EXPECT_EQ(seen.first(1), 6u);
  std::vector<double> q(18);
  for (std::size_t k = 0; k < q.size(); ++k) q[k] = std::sin(double(k));
  std::vector<double> space = q, u, v, a;
  model.to_space(space);
  seen.displacement(q, u);
  seen.velocity({}, q, v);
  seen.acceleration({}, {}, q, a);
  const std::vector<double> expected = {space[4],  space[5],  space[10], space[11],
                                        space[16], space[17], space[16], space[17]};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_DOUBLE_EQ(u[k], expected[k]);
    EXPECT_DOUBLE_EQ(v[k], expected[k]);
    EXPECT_DOUBLE_EQ(a[k], expected[k]);
  }
  // Work is the same in both: f . u = Q . q.
  const std::vector<double> forces = {1.0, 2.0, -1.0, 0.5, 3.0, -2.0, 0.25, 4.0};
  Vector lifted = Vector::Zero(18);
  seen.lift(q, forces, lifted);
  double work = 0.0, generalised = 0.0;
  for (std::size_t k = 0; k < forces.size(); ++k) work += forces[k] * u[k];
  for (std::size_t k = 0; k < q.size(); ++k)
    generalised += lifted(static_cast<Eigen::Index>(k)) * q[k];
  EXPECT_NEAR(work, generalised, roundoff(50.0, 10.0));
}

}  // namespace
}  // namespace abut::nodal_map_tests
