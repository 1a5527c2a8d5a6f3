// Goal: what nothing holds is held by springs that begin every step where it is, and that are told;
// what needs none feels none. Oracle: the springs' own law [M.143], and statics of a bar.
#include "subdomain_solver/time/stabilisation.hpp"

#include <gtest/gtest.h>

#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::time_stabilisation_tests {
namespace {

constexpr double youngs = 1.0e3, spring = 5.0;  // [Pa], [N/m]

VectorField up(double pressure) {
  return {ScalarField(), [pressure](const auto&, double) { return pressure; }, ScalarField()};
}

/// A unit square that nothing holds, stepped with these tractions [Pa] along y.
Solid float_up(double on_bottom, double on_top, int steps) {
  Solid solid(unit_mesh("quad4", 3), std::make_unique<LinearElastic>(isotropic(youngs, 0.0), 1.0));
  solid.pull("bottom", up(on_bottom));
  solid.pull("top", up(on_top));
  QuasiStatic::Options options;
  options.loose = loose_motions(solid.model, {});
  options.stabilised = spring;
  QuasiStatic run(solid.problem, options, make_direct_solver());
  EXPECT_FALSE(run.begin(solid.motion, 0.0));
  for (int k = 0; k < steps; ++k) EXPECT_FALSE(run.step(solid.motion, k, 1.0));
  return solid;
}

double mean_rise(const Solid& solid) {
  double sum = 0.0;
  for (std::size_t k = 1; k < solid.motion.q.size(); k += 2) sum += solid.motion.q[k];
  return 2.0 * sum / static_cast<double>(solid.motion.q.size());
}

TEST(Stabilisation, CarriesWhatNothingElseDoesAndTellsIt) {
  const double force = 3.0;
  for (const int steps : {1, 4}) {
    const Solid solid = float_up(0.0, force, steps);
    // m = s C^T u, and R has components of sqrt(2) along an axis of the plane: F = s u / 2.
    const double way = 2.0 * force / spring * steps;
    EXPECT_NEAR(mean_rise(solid), way, 1.0e-10 * way) << steps;  // round-off, of K over s: 200
    const Stabilisation::Told told = Stabilisation::told(solid.motion);
    EXPECT_NEAR(told.force, force, 1.0e-10 * force);             // the same
    EXPECT_NEAR(told.share, 1.0, 1.0e-10);                       // the same
    EXPECT_NEAR(told.work, force * way, 1.0e-10 * force * way);  // the same
    // Stretched by its own resistance, which is spread evenly: f y^2 / (2 E) at y, no more.
    EXPECT_NEAR(solid.motion.external_work - solid.motion.stored - solid.motion.dissipated, 0.0,
                1.0e-10 * force * way);  // the same
  }
}

TEST(Stabilisation, BearsNothingOfForcesInBalance) {
  const double pull = 3.0;
  const Solid solid = float_up(-pull, pull, 2);
  const double longer = solid.mean_displacement("top").y() - solid.mean_displacement("bottom").y();
  EXPECT_NEAR(longer, pull / youngs, roundoff(1.0e4, pull / youngs));  // of the factors
  EXPECT_LT(Stabilisation::told(solid.motion).share_most, 1.0e-12);    // round-off of K u
}

}  // namespace
}  // namespace abut::time_stabilisation_tests
