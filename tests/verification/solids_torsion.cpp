// Goal: a neo-Hookean column twisted by its initial velocity, the benchmark of finite-strain
// dynamics. Oracles: conservation of momentum; the recorded result of an independent code.
#include <algorithm>
#include <array>
#include <cmath>

#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/nodal_stress.hpp"
#include "subdomain_solver/solid_measures.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_torsion_tests {
namespace {

Mesh column() {
  BoxMesh box;
  box.origin_at = Origin::centre;
  box.lengths = {0.05, 0.05, 1.0};
  box.elements = {2, 2, 40};
  return generate(box, "test");
}

/// Linear and angular momentum about the origin, of the present positions.
struct Momenta {
  Position linear = Position::Zero(), angular = Position::Zero();
};

Momenta momenta(const FeModel& model, const Motion& motion) {
  const Vector p = model.mass() * view(motion.v);
  Momenta out;
  for (int node = 0; node < model.mesh().node_count(); ++node) {
    const Position x = position(model.mesh(), node) + Position(view(motion.q).segment<3>(3 * node));
    out.linear += p.segment<3>(3 * node);
    out.angular += x.cross(Position(p.segment<3>(3 * node)));
  }
  return out;
}

TEST(TorsionColumn, KeepsItsMomentaAndMeetsTheRecordedTwist) {
  const double dt = 1.0e-6;
  const int steps = 500;
  Solid s(column(), std::make_unique<NeoHookean>(isotropic(1.0e9, 0.25), 1000.0));
  const Mesh& mesh = s.model.mesh();
  s.motion.v = nodal(mesh, [](const Position& x) {
    return Position(-8000.0 * x.y() * x.z(), 8000.0 * x.x() * x.z(), 0.0);
  });
  ImplicitDynamics run(s.problem, {}, make_direct_solver());
  ASSERT_FALSE(run.begin(s.motion, 0.0));
  const double energy = run.kinetic(s.motion);
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(run.step(s.motion, k * dt, dt)) << "step " << k;

  double least_x = 0.0, most_z = 0.0;
  for (int node = 0; node < mesh.node_count(); ++node) {
    least_x = std::min(least_x, s.displacement(node).x());
    most_z = std::max(most_z, s.displacement(node).z());
  }
  // Recorded by another code, to as many digits as are given here: half a unit of the last one.
  EXPECT_NEAR(least_x, -0.0443808576, 0.5e-10);
  EXPECT_NEAR(most_z, 8.0338e-5, 0.5e-9);

  // Both turn against each other: nothing in sum. Each step stops at 1e-9 of the forces, and
  // 500 of them could all err to one side; the scale is one half's own share of momentum, M v/4
  // with v = 100 m/s at its end's edge, and that on an arm of 0.025 m.
  const Momenta m = momenta(s.model, s.motion);
  const double mass = 2.5, velocity = 100.0;
  const double bound = iteration(1.0e-9, steps);
  EXPECT_LT(m.linear.norm(), bound * mass * velocity / 4.0);
  EXPECT_LT(m.angular.norm(), bound * mass * velocity / 4.0 * 0.025);
  // Newmark's rule conserves the energy of linear models; of this one to second order in the part
  // of an element that a wave crosses in a step, (c dt/h)^2/12, c = 1095 m/s and h = 0.025 m.
  EXPECT_NEAR(run.kinetic(s.motion) + run.stored(s.motion), energy, 1.6e-4 * energy);
}

/// [Pa] largest von Mises stress at a node of a cell and at a quadrature point.
struct Peak {
  double nodes = 0.0, points = 0.0;
};

Peak peak_of(Solid& s) {
  Peak peak;
  peak.nodes = nodal_stress(s.model, s.motion.q, s.motion.history).most_of_cells;
  const bool told =
      s.model.visit(s.motion.q, s.motion.history, [&](const FeModel::PointState& point) {
        const Matrix3 stress = cauchy_stress(s.model.material(), point.stress, point.deformation);
        peak.points = std::max(peak.points, von_mises(stress));
      });
  EXPECT_TRUE(told);
  return peak;
}

/// At 7.8e-4 and at 7.9e-4 s.
std::array<Peak, 2> peaks(MassForm mass) {
  const double dt = 1.0e-6;
  Solid s(column(), std::make_unique<NeoHookean>(isotropic(1.0e9, 0.25), 1000.0));
  s.motion.v = nodal(s.model.mesh(), [](const Position& x) {
    return Position(-8000.0 * x.y() * x.z(), 8000.0 * x.x() * x.z(), 0.0);
  });
  ImplicitDynamics run(s.problem, {{}, mass, {}}, make_direct_solver());
  EXPECT_FALSE(run.begin(s.motion, 0.0));
  std::array<Peak, 2> out;
  for (int k = 1; k <= 790; ++k) {
    const bool failed = run.step(s.motion, (k - 1) * dt, dt).has_value();
    EXPECT_FALSE(failed) << "step " << k;
    if (failed) return out;
    if (k == 780) out[0] = peak_of(s);
  }
  out[1] = peak_of(s);
  return out;
}

TEST(TorsionColumn, HasThePublishedPeakStressAtItsNodes) {
  // Published for this mesh, material and step at about 7.9e-4 s: Norma and Carina 150.0 MPa, LCM
  // 150.1 (consistent mass), Sierra 155.1 (lumped mass). They are stresses that cells carry to
  // their corners; recomputed apart from this program they are 149.8 to 150.4 and 155.0 MPa, and at
  // quadrature points 118.3, a fifth lower. Half a unit of these last digits.
  const std::array<Peak, 2> consistent = peaks(MassForm::consistent);
  EXPECT_NEAR(consistent[0].nodes, 150.4e6, 0.05e6);
  EXPECT_NEAR(consistent[1].nodes, 149.8e6, 0.05e6);
  EXPECT_NEAR(consistent[0].points, 118.3e6, 0.05e6);
  EXPECT_NEAR(peaks(MassForm::lumped)[1].nodes, 155.0e6, 0.05e6);
}

}  // namespace
}  // namespace abut::solids_torsion_tests
