// Goal: a body tells how far it has turned under a law for small rotations, and what it stores in
// hourglasses. Oracles: rotations and hourglasses put in by hand; the energy of the whole cell.
#include "subdomain_solver/validity_measures.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/index.hpp"
#include "subdomain_solver/fe/hourglass.hpp"
#include "subdomain_solver/fe/largest_rotation.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solver_validity_tests {
namespace {

using Position = Eigen::Vector3d;

std::vector<double> nodal(const Mesh& mesh, const std::function<Position(const Position&)>& field) {
  std::vector<double> u;
  const std::size_t dim = index(mesh.dim);
  for (std::size_t k = 0; k < mesh.points.size(); k += dim) {
    Position x = Position::Zero();
    for (std::size_t i = 0; i < dim; ++i) x(static_cast<Eigen::Index>(i)) = mesh.points[k + i];
    const Position value = field(x);
    u.insert(u.end(), value.data(), value.data() + dim);
  }
  return u;
}

TEST(LargestRotation, IsThatOfTheFieldWhateverStretchesIt) {
  const Position turn(0.3, -0.4, 1.2);
  for (const std::string& element : solid_elements()) {
    Mesh mesh = unit_mesh(element, 3);
    distort(mesh, 0.05);
    const std::vector<double> u =
        nodal(mesh, [&turn](const Position& x) { return Position(turn.cross(x) + 0.7 * x); });
    const double exact = mesh.dim == 3 ? turn.norm() : turn.z();
    // Gradients of order 10 of displacements of order 1.
    EXPECT_NEAR(largest_rotation(mesh, u), exact, roundoff(1000.0, 1.0)) << element;
    EXPECT_NEAR(largest_rotation(mesh, u, 7), exact, roundoff(1000.0, 1.0)) << element;
  }
}

TEST(LargestRotation, FindsTheCellThatTurnsMost) {
  const Mesh mesh = unit_mesh("quad4", 4);  // u_y = x^2: rotation x at the centres
  const std::vector<double> u =
      nodal(mesh, [](const Position& x) { return Position(0.0, x.x() * x.x(), 0.0); });
  EXPECT_NEAR(largest_rotation(mesh, u), 0.875, roundoff(100.0, 1.0));
}

/// One point and hourglass stiffness.
FeModel one_point(const std::string& element) {
  return FeModel(unit_mesh(element, 1), std::make_unique<LinearElastic>(test_moduli, 1.0),
                 {Plane::strain, Formulation::one_point});
}

TEST(HourglassEnergy, IsAllThatAnHourglassStoresAndNothingOfALinearField) {
  for (const std::string element : {"quad4", "hex8"}) {
    FeModel model = one_point(element);
    const std::vector<double> hourglass = nodal(model.mesh(), [](const Position& x) {
      return Position(0.01 * (2.0 * x.x() - 1.0) * (2.0 * x.y() - 1.0), 0.0, 0.0);
    });
    const std::vector<double> linear = nodal(
        model.mesh(), [](const Position& x) { return Position(0.01 * x.y(), -0.02 * x.x(), 0.0); });
    std::vector<double> both = linear;
    for (std::size_t k = 0; k < both.size(); ++k) both[k] += hourglass[k];
    ModelResponse alone, sum;
    ASSERT_TRUE(model.evaluate(hourglass, {}, Model::Want::force, alone));
    ASSERT_TRUE(model.evaluate(both, {}, Model::Want::force, sum));
    EXPECT_GT(alone.stored, 1.0e-7) << element;
    const double tolerance = roundoff(100.0, sum.stored);
    EXPECT_NEAR(hourglass_energy(model, hourglass), alone.stored, tolerance) << element;
    EXPECT_NEAR(hourglass_energy(model, linear), 0.0, tolerance) << element;
    EXPECT_NEAR(hourglass_energy(model, both), alone.stored, tolerance) << element;
    const std::vector<double> told = validity_measures(model, true, both, sum.stored, 0.0);
    EXPECT_EQ(
        validity_measure_names(model, true),
        (std::vector<std::string>{"rotation.max", "energy.hourglass", "energy.hourglass_share"}));
    ASSERT_EQ(told.size(), 3u);
    EXPECT_NEAR(told[0], 0.015, roundoff(100.0, 0.01)) << element;  // hourglasses turn no centre
    EXPECT_NEAR(told[2] * sum.stored, told[1], tolerance) << element;
  }
}

TEST(Validity, RotationsOnTheWayAreKept) {
  FeModel model = one_point("quad4");
  const std::vector<double> rest(model.mesh().points.size(), 0.0);
  EXPECT_EQ(validity_measures(model, true, rest, 0.0, 0.4).front(), 0.4);
}

TEST(Validity, LawsOfFiniteStrainAndBodiesThatCannotDeformTellNothing) {
  const FeModel finite(unit_mesh("hex8", 1), std::make_unique<NeoHookean>(test_moduli, 1.0), {});
  EXPECT_TRUE(validity_measure_names(finite, true).empty());
  EXPECT_TRUE(validity_measure_names(one_point("hex8"), false).empty());
}

}  // namespace
}  // namespace abut::solver_validity_tests
