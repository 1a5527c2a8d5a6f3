// Goal: integrators of solids have their orders and keep what they must keep. Oracles: a natural
// mode of the discrete body, whose motion is a cosine; d'Alembert's waves; energy in closed form;
// conservation laws.
#include <cmath>
#include <numbers>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_dynamics_tests {
namespace {

void advance(Integrator& run, Motion& motion, int steps, double dt) {
  ASSERT_FALSE(run.begin(motion, 0.0));
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(run.step(motion, k * dt, dt)) << "step " << k;
}

/// A clamped plate of linear material, and its lowest natural mode.
struct Plate {
  Solid s;
  Vector mode;
  double frequency = 0.0;  // [rad/s]

  explicit Plate(bool lumped)
      : s(unit_mesh("quad4", 3), std::make_unique<LinearElastic>(isotropic(1.0, 0.3), 1.0)) {
    s.fix("left", 0);
    s.fix("left", 1);
    ModelResponse rest;
    const std::vector<double> q(index(s.model.dofs()), 0.0);
    EXPECT_TRUE(s.model.evaluate(q, {}, Model::Want::tangent, rest));
    const std::vector<int> free = FreeCoordinates(s.model.dofs(), s.problem.supports).list();
    const Eigen::MatrixXd mass =
        lumped ? Eigen::MatrixXd(s.model.lumped_mass().asDiagonal()) : s.model.mass().toDense();
    const EigenPairs eigen =
        generalized_eigen(rest.tangent.toDense()(free, free), mass(free, free));
    frequency = std::sqrt(eigen.values(0));
    mode = Vector::Zero(s.model.dofs());
    mode(free) = eigen.vectors.col(0).normalized();
    store(mode, s.motion.q);
  }

  /// Error after 1.3 periods, relative to the amplitude.
  double error(Integrator& run, int steps) {
    const double end = 1.3 * 2.0 * std::numbers::pi / frequency;
    advance(run, s.motion, steps, end / steps);
    return (view(s.motion.q) - std::cos(frequency * end) * mode).norm();
  }
};

double order_of(const AlphaWeights& weights) {
  std::vector<double> errors;
  for (int steps : {100, 200}) {
    Plate plate(false);
    ImplicitDynamics run(plate.s.problem, {weights, MassForm::consistent, {}},
                         make_direct_solver());
    errors.push_back(plate.error(run, steps));
  }
  return observed_order(errors[0], errors[1]);
}

// Second order; at 77 steps a period the terms of next order are (2 pi/77)^2 = 0.7 % of it, and a
// factor 1.01 in an error is 0.015 in the order. First-order damping terms double that.
constexpr double order_tolerance = 0.03;

TEST(NaturalMode, IsMetToSecondOrderByEveryIntegrator) {
  EXPECT_NEAR(order_of(AlphaWeights::newmark(0.25, 0.5)), 2.0, order_tolerance);
  EXPECT_NEAR(order_of(AlphaWeights::newmark(1.0 / 6.0, 0.5)), 2.0, order_tolerance);
  EXPECT_NEAR(order_of(AlphaWeights::hht(-0.1)), 2.0, order_tolerance);
  EXPECT_NEAR(order_of(AlphaWeights::spectral_radius(0.8)), 2.0, order_tolerance);
  std::vector<double> errors;
  for (int steps : {100, 200}) {
    Plate plate(true);
    ExplicitDynamics run(plate.s.problem);
    errors.push_back(plate.error(run, steps));
  }
  EXPECT_NEAR(observed_order(errors[0], errors[1]), 2.0, order_tolerance);
}

TEST(NaturalMode, NewmarkShiftsItsPeriodAsTheoryHasIt) {
  // The rule 1/4, 1/2 turns by 2 atan(w dt/2) a step (Hughes, The Finite Element Method,
  // sect. 9.1), at any step: round-off of 100 steps of a solve of condition 1e3.
  const int steps = 100;
  Plate plate(false);
  const double dt = 0.5 / plate.frequency;
  ImplicitDynamics run(plate.s.problem, {}, make_direct_solver());
  advance(run, plate.s.motion, steps, dt);
  const double angle = steps * 2.0 * std::atan(0.25);
  EXPECT_LT((view(plate.s.motion.q) - std::cos(angle) * plate.mode).norm(), roundoff(1.0e5, 1.0));
}

TEST(LinearBody, NewmarkKeepsItsEnergyAtAnyStep) {
  Plate plate(false);
  Motion& motion = plate.s.motion;
  motion.v = nodal(plate.s.model.mesh(), [](const Position& x) {
    return Position(std::sin(5.0 * x.x()), x.x() * x.y(), 0.0);
  });
  ImplicitDynamics run(plate.s.problem, {}, make_direct_solver());
  ASSERT_FALSE(run.begin(motion, 0.0));
  const double energy = run.kinetic(motion) + run.stored(motion);
  for (int k = 0; k < 1000; ++k) {
    ASSERT_FALSE(run.step(motion, 0.3 * k, 0.3));
    // Round-off alone: a thousand solves of a few dozen unknowns.
    ASSERT_NEAR(run.kinetic(motion) + run.stored(motion), energy, roundoff(1.0e4, energy));
  }
  // Algorithmic damping takes energy and never gives any over these steps.
  ImplicitDynamics damped(plate.s.problem, {AlphaWeights::hht(-0.1), MassForm::consistent, {}},
                          make_direct_solver());
  ASSERT_FALSE(damped.begin(motion, 0.0));
  for (int k = 0; k < 200; ++k) ASSERT_FALSE(damped.step(motion, 0.3 * k, 0.3));
  EXPECT_LT(damped.kinetic(motion) + damped.stored(motion), 0.9 * energy);
}

/// A plate whose left side is moved and whose right side is pulled, both from rest and smoothly.
struct DrivenPlate {
  Solid s{unit_mesh("quad4", 3), std::make_unique<LinearElastic>(isotropic(1.0, 0.3), 1.0)};

  DrivenPlate() {
    s.prescribe("left", 0, [](const Position&, double t) { return 0.1 * t * t * t; });
    s.fix("left", 1);
    s.pull("right", {[](const std::array<double, 3>&, double t) { return std::sin(t) * t; },
                     [](const std::array<double, 3>&, double t) { return 0.1 * t * t; }});
  }

  /// Energy less external work at time 1.5, while all of it moves; it begins with none.
  double imbalance(Integrator& run, int steps) {
    advance(run, s.motion, steps, 1.5 / steps);
    EXPECT_GT(std::abs(s.motion.external_work), 0.1);
    return run.kinetic(s.motion) + run.stored(s.motion) - s.motion.external_work;
  }
};

double order_of_imbalance(const AlphaWeights& weights) {
  std::vector<double> errors;
  for (int steps : {100, 200}) {
    DrivenPlate plate;
    ImplicitDynamics run(plate.s.problem, {weights, MassForm::consistent, {}},
                         make_direct_solver());
    errors.push_back(plate.imbalance(run, steps));
  }
  return observed_order(errors[0], errors[1]);
}

TEST(ExternalWork, BalancesTheEnergyToSecondOrderInTheStep) {
  // Terms of next order are 1 to 2 % of an error at 100 steps (order 0.03); work of first order
  // would give 1.
  constexpr double tolerance = 0.1;
  EXPECT_GT(order_of_imbalance(AlphaWeights::hht(-0.1)), 2.0 - tolerance);
  EXPECT_GT(order_of_imbalance(AlphaWeights::spectral_radius(0.8)), 2.0 - tolerance);
  EXPECT_GT(order_of_imbalance(AlphaWeights::spectral_radius(0.0)), 2.0 - tolerance);
  DrivenPlate plate, other;
  ImplicitDynamics newmark(plate.s.problem, {}, make_direct_solver());
  ExplicitDynamics central(other.s.problem, 1.5 / 100);
  // Newmark's and that of central differences are exact: round-off of 100 solves, or steps.
  EXPECT_NEAR(other.imbalance(central, 100), 0.0, roundoff(1.0e4, 1.0));
  EXPECT_NEAR(plate.imbalance(newmark, 100), 0.0, roundoff(1.0e4, 1.0));
}

TEST(ExternalWork, IsNoneOfADampedBodyThatNothingWorksOn) {
  Plate plate(false);
  ImplicitDynamics run(plate.s.problem, {AlphaWeights::hht(-0.1), MassForm::consistent, {}},
                       make_direct_solver());
  advance(run, plate.s.motion, 10, 0.3);
  EXPECT_EQ(plate.s.motion.external_work, 0.0);
}

TEST(MovedSide, KeepsTheVelocityThatItBeginsWith) {
  for (const MassForm mass : {MassForm::consistent, MassForm::lumped}) {
    DrivenPlate plate;
    for (Prescribed& p : plate.s.problem.supports) p.value = [](double t) { return 0.25 * t; };
    std::fill(plate.s.motion.v.begin(), plate.s.motion.v.end(), 7.0);
    ImplicitDynamics run(plate.s.problem, {{}, mass, {}}, make_direct_solver());
    plate.s.problem.set_rates(0.0, 0.01, plate.s.motion);
    ASSERT_FALSE(run.begin(plate.s.motion, 0.0));
    for (int k = 0; k < 100; ++k) {
      ASSERT_FALSE(run.step(plate.s.motion, 0.01 * k, 0.01));
      // Round-off of a difference over a step of 0.01, which alternates and adds up.
      for (const Prescribed& p : plate.s.problem.supports)
        ASSERT_NEAR(plate.s.motion.v[p.dof], 0.25, roundoff(1.0e4, 1.0));
    }
  }
}

TEST(ClampedWave, DispersesAsTheoryHasIt) {
  // A Gaussian pulse f at rest in the middle of a bar parts into two: u = (f(z - ct) + f(z +
  // ct))/2. Consistent mass and the trapezoidal rule at c dt = h slow a wave of number k by
  // (kh)^2/24, so that after a time t the error is c t h^2/24 times the third derivative of f; of
  // velocity and acceleration, of its derivatives. The norm of the n-th is
  // sqrt((2n-1)!!/2^n)/width^n.
  const double dt = 1.0e-6, c = 1000.0, h = 1.0e-3, a = 1.0e-3, width = 0.02, end = 1.0e-4;
  BoxMesh box;
  box.origin_at = Origin::centre;
  box.lengths = {h, h, 1.0};
  box.elements = {1, 1, 1000};
  Solid s(generate(box, "test"), std::make_unique<LinearElastic>(isotropic(1.0e9, 0.0), 1000.0));
  for (const char* side : {"left", "right"}) s.fix(side, 0);
  for (const char* side : {"bottom", "top"}) s.fix(side, 1);
  for (const char* side : {"back", "front"}) s.fix(side, 2);
  const auto f = [a, width](double z, int derivative) {
    const double s2 = width * width, value = a * std::exp(-0.5 * z * z / s2);
    if (derivative == 0) return value;
    if (derivative == 1) return -z / s2 * value;
    return (z * z / s2 - 1.0) / s2 * value;
  };
  s.motion.q =
      nodal(s.model.mesh(), [&f](const Position& x) { return Position(0.0, 0.0, f(x.z(), 0)); });
  ImplicitDynamics run(s.problem, {}, make_direct_solver());
  advance(run, s.motion, 100, dt);
  Eigen::Vector3d error = Eigen::Vector3d::Zero(), norm = error;
  for (int node = 0; node < s.model.mesh().node_count(); ++node) {
    const double z = position(s.model.mesh(), node).z();
    const std::size_t at = index(3 * node + 2);
    const double ahead = z + c * end, behind = z - c * end;
    const Eigen::Vector3d exact(0.5 * (f(behind, 0) + f(ahead, 0)),
                                0.5 * c * (f(ahead, 1) - f(behind, 1)),
                                0.5 * c * c * (f(ahead, 2) + f(behind, 2)));
    const Eigen::Vector3d found(s.motion.q[at], s.motion.v[at], s.motion.a[at]);
    error += (found - exact).cwiseAbs2();
    norm += exact.cwiseAbs2();
  }
  const Eigen::Vector3d relative = error.cwiseQuotient(norm).cwiseSqrt();
  const double lag = c * end * h * h / 24.0 / std::pow(width, 3);
  const Eigen::Vector3d theory(std::sqrt(15.0 / 8.0), std::sqrt(105.0 / 16.0 / (1.0 / 2.0)),
                               std::sqrt(945.0 / 32.0 / (3.0 / 4.0)));
  // Terms of next order are in all (h/width)^2 times a few units of n + 7/2: below 2 %.
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(relative(i), lag * theory(i), 0.02 * lag * theory(i)) << i;
}

/// A cantilever bent to u_y = k x^2 and released; energy lost after 1e-4 s, relative.
double loss_after_release(double dt) {
  // The bent shape is a simple shear of 2kx, at which neo-Hookean material stores mu/2 (2kx)^2, so
  // 2/3 mu k^2 L^3 A in all: 1506 J as published. Linear elements see its slope stepwise, which
  // takes the part 1/(4 n^2) from it exactly.
  const double length = 0.254, k = 0.393701;
  const int along = 20;
  const Moduli moduli = isotropic(6.895e9, 0.25);
  BoxMesh box;
  box.lengths = {length, 0.0254, 0.0127};
  box.elements = {along, 2, 1};
  Solid s(generate(box, "test"), std::make_unique<NeoHookean>(moduli, 2768.0));
  for (int i = 0; i < 3; ++i) s.fix("left", i);
  s.motion.q = nodal(s.model.mesh(),
                     [k](const Position& x) { return Position(0.0, k * x.x() * x.x(), 0.0); });
  ImplicitDynamics run(s.problem, {}, make_direct_solver());
  EXPECT_FALSE(run.begin(s.motion, 0.0));
  const double exact = 2.0 / 3.0 * moduli.shear * k * k * std::pow(length, 3) * 0.0254 * 0.0127;
  EXPECT_NEAR(exact, 1506.0, 1.0);
  const double energy = run.stored(s.motion);
  EXPECT_NEAR(energy, exact * (1.0 - 1.0 / (4.0 * along * along)), roundoff(1.0e4, exact));
  const int steps = static_cast<int>(std::lround(1.0e-4 / dt));
  for (int step = 0; step < steps; ++step)
    EXPECT_FALSE(run.step(s.motion, step * dt, dt)) << "step " << step;
  return 1.0 - (run.kinetic(s.motion) + run.stored(s.motion)) / energy;
}

TEST(ReleasedCantilever, StartsWithItsEnergyAndLosesItToSecondOrderInTheStep) {
  const double coarse = loss_after_release(1.0e-6), fine = loss_after_release(0.5e-6);
  // The next terms of an error of 1.4e-3 are its square and its product with c dt/h = 0.07.
  EXPECT_NEAR(observed_order(coarse, fine), 2.0, 0.1);
  // A wave of length 2h has w dt = pi c dt/h = 0.4, and the rule's error in its energy is the
  // square over 12.
  EXPECT_LT(std::abs(coarse), 0.4 * 0.4 / 12.0);
}

TEST(FreeBody, KeepsItsAngularMomentumOver100000ExplicitSteps) {
  Solid s(unit_mesh("hex8", 1), std::make_unique<NeoHookean>(isotropic(1.0, 0.3), 1.0));
  const Position spin(0.03, 0.05, -0.02), centre(0.5, 0.5, 0.5);
  s.motion.v = nodal(s.model.mesh(), [&spin, &centre](const Position& x) {
    return Position(spin.cross(x - centre));
  });
  const auto angular = [&s] {
    Position sum = Position::Zero();
    for (int node = 0; node < s.model.mesh().node_count(); ++node) {
      const Position x = position(s.model.mesh(), node) + s.displacement(node);
      const Position v(view(s.motion.v).segment<3>(3 * node));
      sum += s.model.lumped_mass()(3 * node) * x.cross(v);
    }
    return sum;
  };
  const Position before = angular();
  ExplicitDynamics run(s.problem);
  ASSERT_FALSE(run.begin(s.motion, 0.0));
  const double energy = run.kinetic(s.motion) + run.stored(s.motion);
  const int steps = 100000;
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(run.step(s.motion, 0.1 * k, 0.1));
  // Forces of order 1e-3 on arms of order 1 round at 1e-16 a step; all to one side at worst.
  EXPECT_LT((angular() - before).norm(), roundoff(steps, before.norm()));
  // The energy swings by (w dt)^2/8 of what vibrates, w below 4, and does not drift.
  EXPECT_NEAR(run.kinetic(s.motion) + run.stored(s.motion), energy, 0.02 * energy);
}

}  // namespace
}  // namespace abut::solids_dynamics_tests
