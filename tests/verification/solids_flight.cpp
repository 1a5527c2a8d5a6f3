// Goal: bodies under laws of finite strain fly far: forces are differences of displacements that
// have grown to many times the size of a cell. Oracles: uniform motion; the body's own shape, to
// which it returns when its nodes are turned back.
#include <cmath>

#include <Eigen/SVD>

#include "tests/support/materials.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_flight_tests {
namespace {

constexpr double speed = 300.0, distance = 1000.0;  // [m/s], [m]
constexpr double density = 1000.0;

std::unique_ptr<const Material> polymer(const std::string& law) {
  const Moduli moduli = isotropic(1.0e9, 0.3);
  if (law == "saint_venant_kirchhoff")
    return std::make_unique<SaintVenantKirchhoff>(moduli, density);
  if (law == "neo_hookean") return std::make_unique<NeoHookean>(moduli, density);
  if (law == "mooney_rivlin")
    return std::make_unique<MooneyRivlin>(
        MooneyRivlinParameters{0.3 * moduli.shear, 0.2 * moduli.shear, moduli.bulk, density});
  if (law == "hencky") return std::make_unique<Hencky>(moduli, density);
  Hardening hardening;
  hardening.yield_stress = 1.0e7;
  return std::make_unique<J2Plasticity>(moduli, hardening, density);
}

Mesh brick(const std::string& element) {
  BoxMesh m;  // [m]
  m.lengths = {0.04, 0.02, 0.01};
  m.elements = {2, 1, 1};
  m.element = element;
  return generate(m, "test");
}

/// Largest distance of a node from where the rigid motion that fits best would put it.
double change_of_shape(const Solid& s) {
  const Mesh& mesh = s.model.mesh();
  Eigen::MatrixXd before(3, mesh.node_count()), after = before;
  for (int node = 0; node < mesh.node_count(); ++node) {
    before.col(node) = position(mesh, node);
    after.col(node) = position(mesh, node) + s.displacement(node);
  }
  before.colwise() -= before.rowwise().mean().eval();
  after.colwise() -= after.rowwise().mean().eval();
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(after * before.transpose(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d turn = parts.matrixU() * parts.matrixV().transpose();
  return (after - turn * before).colwise().norm().maxCoeff();
}

struct Flight {
  std::string law, integrator;
  Formulation formulation;
  double spin;  // [rad/s]
};
void PrintTo(const Flight& f, std::ostream* out) {
  *out << f.law << " " << f.integrator << " " << name_of(f.formulation) << " spin " << f.spin;
}

AlphaWeights weights_of(const std::string& integrator) {
  if (integrator == "newmark") return AlphaWeights::newmark(0.25, 0.5);
  if (integrator == "hht_alpha") return AlphaWeights::hht(-0.1);
  return AlphaWeights::spectral_radius(0.8);
}

class Flights : public testing::TestWithParam<Flight> {};

TEST_P(Flights, OfAKilometreAtTheSpeedOfAShellEndWell) {
  const Flight& flight = GetParam();
  // A spinning body takes more of them: the round-off of forces turns a stiff one, too, by what its
  // inertia lets it in the square of a step.
  const int steps = flight.spin > 0.0 ? 1000 : 100;
  const Position about = flight.spin * Position(0.0, 0.6, 0.8);
  Solid s(brick("hex8"), polymer(flight.law), {Plane::strain, flight.formulation});
  const Position centre(0.02, 0.01, 0.005);
  s.motion.v = nodal(s.model.mesh(), [&](const Position& x) {
    return Position(Position(speed, 0.0, 0.0) + about.cross(x - centre));
  });
  ImplicitDynamics run(s.problem, {weights_of(flight.integrator), MassForm::consistent, {}},
                       make_direct_solver());
  ASSERT_FALSE(run.begin(s.motion, 0.0));
  const double dt = distance / speed / steps;
  for (int k = 0; k < steps; ++k) {
    const std::optional<Failed> failed = run.step(s.motion, k * dt, dt);
    ASSERT_FALSE(failed) << "after " << speed * k * dt << " m: " << failed->detail;
  }
  // Round-off of the positions, added up over the steps.
  const Position moved = s.mean_displacement("boundary") - Position(distance, 0.0, 0.0);
  EXPECT_LT(moved.norm(), roundoff(10.0 * steps, distance));
  const double turn = flight.spin * dt, size = 0.046;
  // Positions of 1 km have no digits below 1e-13 m. The chord by which a step begins is (w dt)^2/8
  // of the size too long, and what makes it whole again may ring by as much.
  EXPECT_LT(change_of_shape(s), 1.0e-11 + 0.5 * turn * turn * size);
}

std::vector<Flight> flights() {
  std::vector<Flight> out;
  for (const std::string law :
       {"saint_venant_kirchhoff", "neo_hookean", "mooney_rivlin", "hencky", "j2_plasticity"}) {
    for (const std::string integrator : {"newmark", "hht_alpha", "generalized_alpha"}) {
      for (Formulation formulation : {Formulation::full, Formulation::mean_dilatation})
        for (const double spin : {0.0, 3.0}) out.push_back({law, integrator, formulation, spin});
    }
  }
  return out;
}
INSTANTIATE_TEST_SUITE_P(All, Flights, testing::ValuesIn(flights()));

}  // namespace
}  // namespace abut::solids_flight_tests
