// Goal: modal bodies are the mesh's bodies in fewer coordinates. Oracles: the same body by finite
// elements, with which all modes agree to round-off; natural frequencies and modal sums in closed
// form; statics; conservation laws.
#include <cmath>
#include <numbers>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/modal_solid.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_modal_tests {
namespace {

std::unique_ptr<const Material> elastic(double young = 1.0, double nu = 0.3) {
  return std::make_unique<LinearElastic>(isotropic(young, nu), 1.0);
}

constexpr int all = -1;

/// Modes with fixed ports that a body has: its free coordinates without the port's, and without
/// the rigid motions that a port leaves free.
WantedModes wanted_of(const Solid& s, const std::string& port, int count, int loose) {
  if (count != all) return lowest(count);
  const std::vector<int> ports = ModalSolid::ports(s, port), held = ModalSolid::supports(s);
  std::vector<int> both;
  std::set_union(ports.begin(), ports.end(), held.begin(), held.end(), std::back_inserter(both));
  return lowest(s.model.dofs() - static_cast<int>(both.size()) - loose);
}

/// A body, how it is held, and its port.
struct Case {
  std::string name, element, clamp, port;
  int loose;      // rigid motions with the port fixed
  bool inclined;  // the bottom slides along an inclined plane
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

Solid solid_of(const Case& c) {
  Mesh mesh = unit_mesh(c.element, element_named(c.element).order == 1 ? 3 : 1);
  distort(mesh, 0.05);
  std::vector<NodeFrame> frames;
  Matrix3 axes;
  axes << 0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0;
  if (c.inclined) {
    for (std::int32_t node : mesh.nodes_of("bottom")) frames.push_back({node, axes});
  }
  const std::vector<std::int32_t> bottom = mesh.nodes_of("bottom");
  Solid s(std::move(mesh), elastic(), {}, frames);
  if (c.inclined) s.fix("bottom", 0);
  for (int i = 0; i < s.model.mesh().dim && !c.clamp.empty(); ++i) s.fix(c.clamp, i);
  // Any motion: the largest frequency that a mesh has takes part as much as the lowest one.
  std::mt19937_64 engine(3);
  const auto draw = [&engine] { return static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5; };
  for (double& q : s.motion.q) q = 0.1 * draw();
  for (double& v : s.motion.v) v = draw();
  for (const Prescribed& p : s.problem.supports) {
    s.motion.q[p.dof] = 0.0;
    s.motion.v[p.dof] = 0.0;
  }
  return s;
}

class AllModes : public testing::TestWithParam<Case> {};
class Ports : public testing::TestWithParam<Case> {};

std::unique_ptr<Load> pulsating_traction(const FeModel& model) {
  const ScalarField f = [](const std::array<double, 3>& x, double t) {
    return (1.0 + x[1]) * std::sin(3.0 * t);
  };
  return std::make_unique<Traction>(model, "right", VectorField{f, f, ScalarField()});
}

void advance(Integrator& run, Motion& motion, int steps, double dt) {
  ASSERT_FALSE(run.begin(motion, 0.0));
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(run.step(motion, k * dt, dt)) << "step " << k;
}

void expect_same(const Solid& fe, const ModalSolid& modal, double tolerance) {
  const std::vector<double> u = modal.nodal(modal.motion.q), v = modal.nodal(modal.motion.v);
  EXPECT_LT(largest_difference(fe.motion.q, u), tolerance * largest_size(fe.motion.q));
  EXPECT_LT(largest_difference(fe.motion.v, v), tolerance * largest_size(fe.motion.v));
  EXPECT_NEAR(fe.motion.stored, modal.motion.stored, tolerance * fe.motion.stored);
  const double work = std::abs(fe.motion.external_work) + fe.motion.stored;
  EXPECT_NEAR(fe.motion.external_work, modal.motion.external_work, tolerance * work);
}

/// Both find all frequencies to round-off of the highest one, 8 at most on these meshes; what that
/// moves in a time of 5 is 5 * 8 eps; some hundred operations each make a thousand of it.
constexpr double all_modes_tolerance = 1.0e-11;

TEST_P(AllModes, MoveAsFiniteElementsByNewmark) {
  for (const MassForm form : {MassForm::consistent, MassForm::averaged, MassForm::lumped}) {
    Solid s = solid_of(GetParam());
    ModalSolid modal(s, GetParam().port, form,
                     wanted_of(s, GetParam().port, all, GetParam().loose));
    s.problem.loads.push_back(pulsating_traction(s.model));
    modal.take(pulsating_traction(s.model));
    const ImplicitDynamics::Options options{AlphaWeights::newmark(0.25, 0.5), form, {1.0e-13, 25}};
    ImplicitDynamics one(s.problem, options, make_direct_solver());
    ImplicitDynamics other(modal.problem, {options.weights, MassForm::lumped, options.newton},
                           make_direct_solver());
    advance(one, s.motion, 50, 0.1);
    advance(other, modal.motion, 50, 0.1);
    expect_same(s, modal, all_modes_tolerance);
  }
}

TEST_P(AllModes, MoveAsFiniteElementsByCentralDifferences) {
  Solid s = solid_of(GetParam());
  ModalSolid modal(s, GetParam().port, MassForm::lumped,
                   wanted_of(s, GetParam().port, all, GetParam().loose));
  s.problem.loads.push_back(pulsating_traction(s.model));
  modal.take(pulsating_traction(s.model));
  ExplicitDynamics one(s.problem), other(modal.problem);
  const double dt = 0.9 * modal.model.stable_step();
  const int steps = static_cast<int>(5.0 / dt);
  advance(one, s.motion, steps, dt);
  advance(other, modal.motion, steps, dt);
  expect_same(s, modal, all_modes_tolerance);
}

TEST_P(Ports, StaticAnswersToForcesOnAPortNeedNone) {
  Solid s = solid_of(GetParam());
  std::fill(s.motion.q.begin(), s.motion.q.end(), 0.0);
  ModalSolid modal(s, GetParam().port, MassForm::consistent, lowest(0));
  // Forces that a free body could not bear have their rigid part taken off them.
  const Eigen::MatrixXd rigid = modal.basis.shapes.leftCols(modal.basis.rigid);
  Vector force = Vector::Zero(s.model.dofs());
  for (int dof : ModalSolid::ports(s, GetParam().port)) force(dof) = std::cos(double(dof));
  const double given_size = force.norm();
  if (modal.basis.rigid > 0) {
    const std::vector<int> port = ModalSolid::ports(s, GetParam().port);
    const Eigen::MatrixXd there = rigid(port, Eigen::all);
    const Vector given = force(port);
    force(port) = given - there * (pseudo_inverse(there, 1.0e-12) * given);
  }
  // K u = f on the space of static shapes, and on all coordinates: the residual tells.
  const Vector lifted = modal.basis.shapes.transpose() * force;
  const Eigen::Index first = modal.basis.rigid, elastic = lifted.size() - first;
  const Vector q =
      lifted.tail(elastic).cwiseQuotient(modal.basis.frequencies.tail(elastic).cwiseAbs2());
  const Vector u = modal.basis.shapes.rightCols(elastic) * q;
  ModelResponse answer;
  const std::vector<double> list(u.data(), u.data() + u.size());
  ASSERT_TRUE(s.model.evaluate(list, {}, Model::Want::force, answer));
  Vector residual = answer.force - force;
  for (const Prescribed& p : s.problem.supports) residual(p.dof) = 0.0;
  EXPECT_LT(residual.norm(), 1.0e-12 * given_size);  // round-off times a condition of some hundred
}

TEST_P(Ports, EveryDisplacementOfAPortIsReached) {
  Solid s = solid_of(GetParam());
  const ModalSolid modal(s, GetParam().port, MassForm::consistent, lowest(2));
  const std::vector<int> ports = ModalSolid::ports(s, GetParam().port);
  const std::vector<int> held = ModalSolid::supports(s);
  std::vector<int> free;
  std::set_difference(ports.begin(), ports.end(), held.begin(), held.end(),
                      std::back_inserter(free));
  ASSERT_EQ(modal.basis.port_coordinates, static_cast<int>(free.size()));
  const Eigen::MatrixXd there = modal.basis.shapes(free, Eigen::all);
  const Vector wanted = Vector::LinSpaced(static_cast<Eigen::Index>(free.size()), -1.0, 2.0);
  const Vector q = pseudo_inverse(there, 1.0e-12) * wanted;
  // Round-off times a condition of some hundred.
  EXPECT_LT((there * q - wanted).norm(), 1.0e-12 * wanted.norm());
}

const Case without_port[] = {{"clamped_without_port", "quad4", "left", "", 0, false},
                             {"free_quad4", "quad4", "", "", 3, false},
                             {"inclined_roller_without_port", "quad4", "", "", 1, true},
                             {"free_hex8", "hex8", "", "", 6, false}};
const Case with_port[] = {{"clamped_quad4", "quad4", "left", "right", 0, false},
                          {"free_quad8", "quad8", "", "right", 0, false},
                          {"port_of_one_node", "quad4", "", "right_top", 1, false},
                          {"inclined_roller", "quad4", "", "right", 0, true},
                          {"hex8_with_port_of_one_node", "hex8", "", "right_top_front", 3, false},
                          {"clamped_tet4", "tet4", "left", "right", 0, false}};

INSTANTIATE_TEST_SUITE_P(WithoutPort, AllModes, testing::ValuesIn(without_port));
INSTANTIATE_TEST_SUITE_P(WithPort, AllModes, testing::ValuesIn(with_port));
INSTANTIATE_TEST_SUITE_P(Of, Ports, testing::ValuesIn(with_port));

/// A strip that moves along x alone: a bar, whose natural frequencies are those of its elements,
/// w^2 = 6 (1 - cos kh)/(2 + cos kh) c^2/h^2 with consistent mass, 2 (1 - cos kh) c^2/h^2 with
/// lumped mass; c = 1 at E = rho = 1, nu = 0.
TEST(Frequencies, OfABarAreThoseOfItsElements) {
  constexpr int n = 300, count = 12;
  RectangleMesh m;
  m.lengths = {3.0, 0.01};
  m.elements = {n, 1};
  const double h = m.lengths[0] / n;
  for (const bool clamped : {true, false}) {
    for (const MassForm form : {MassForm::consistent, MassForm::lumped}) {
      Solid s(generate(m, "test"), elastic(1.0, 0.0));
      s.fix("boundary", 1);
      if (clamped) s.fix("left", 0);
      const ModalSolid modal(s, "", form, lowest(count));
      ASSERT_EQ(modal.basis.rigid, clamped ? 0 : 1);
      const Vector found = modal.basis.frequencies.tail(count);
      for (int k = 0; k < count; ++k) {
        const double angle = std::numbers::pi * (clamped ? k + 0.5 : k + 1.0) / n;
        const double lumped = 2.0 * (1.0 - std::cos(angle)) / (h * h);
        const double square =
            form == MassForm::lumped ? lumped : lumped * 3.0 / (2.0 + std::cos(angle));
        // Round-off of the mesh's highest square, 12/h^2, in the matrices.
        EXPECT_NEAR(found(k) * found(k), square, roundoff(10.0, 12.0 / (h * h))) << k;
      }
      EXPECT_EQ(modal.basis.frequencies(0) == 0.0, !clamped);
    }
  }
}

/// Slender beam of quad8, plane stress: unit section, length 40.
Mesh slender() {
  RectangleMesh m;
  m.lengths = {40.0, 1.0};
  m.elements = {40, 1};
  m.element = "quad8";
  return generate(m, "test");
}

/// Bending frequencies w = (beta L)^2 / L^2 sqrt(E I/(rho A)) with cos(beta L) cosh(beta L) = 1 of
/// the free beam, -1 of the clamped one; I/A = 1/12.
TEST(Frequencies, OfABeamAreEulersAndBernoullis) {
  constexpr double free_beta[] = {4.730040744862704, 7.853204624095838},
                   clamped_beta[] = {1.875104068711961, 4.694091132974175};
  FeOptions stress;
  stress.plane = Plane::stress;
  for (const bool clamped : {true, false}) {
    Solid s(slender(), elastic(1.0, 0.0), stress);
    if (clamped) {
      s.fix("left", 0);
      s.fix("left", 1);
    }
    const ModalSolid modal(s, "", MassForm::consistent, lowest(2));
    for (int k = 0; k < 2; ++k) {
      const double beta = clamped ? clamped_beta[k] : free_beta[k];
      const double exact = beta * beta / 1600.0 / std::sqrt(12.0);
      const double found = modal.basis.frequencies(modal.basis.rigid + k);
      // Shear and rotary inertia lower a frequency by about (beta/L)^2 (1 + E/(G k'))/24 of it
      // (sine waves; G = E/2, k' = 5/6), ends by as much again for these two modes: at most twice
      // that.
      const double lower = std::pow(beta / 40.0, 2) * (1.0 + 2.4) / 24.0;
      EXPECT_LT(found, exact);
      EXPECT_GT(found, exact * (1.0 - 2.0 * lower)) << "mode " << k << " clamped " << clamped;
    }
  }
}

/// Under an end force the modes of a cantilever give 12/(beta_i L)^4 of the deflection each.
TEST(Modes, OfACantileverAddUpToItsDeflection) {
  constexpr double beta[] = {1.875104068711961, 4.694091132974175, 7.854757438237613};
  FeOptions stress;
  stress.plane = Plane::stress;
  double sum = 0.0, before = 1.0;
  for (int count = 1; count <= 3; ++count) {
    Solid s(slender(), elastic(1.0, 0.0), stress);
    s.fix("left", 0);
    s.fix("left", 1);
    ModalSolid modal(s, "", MassForm::consistent, lowest(count));
    modal.take(std::make_unique<Traction>(
        s.model, "right",
        VectorField{ScalarField(), [](const std::array<double, 3>&, double) { return 1.0e-4; },
                    ScalarField()}));
    QuasiStatic run(modal.problem, {{}, 8}, make_direct_solver());
    ASSERT_FALSE(run.begin(modal.motion, 0.0));
    s.motion.q = modal.nodal(modal.motion.q);
    const double exact = 1.0e-4 * std::pow(40.0, 3) / (3.0 / 12.0);
    const double part = s.mean_displacement("right").y() / exact;
    sum += 12.0 / std::pow(beta[count - 1], 4);
    // Shear adds E/(G k') I/A 3/L^2 = 4e-4 to the deflection, and lowers frequencies as above: for
    // the third mode, 4e-3 of the sum, by 1.1 % of its square.
    EXPECT_NEAR(part, sum, 1.0e-3) << count << " modes";
    EXPECT_LT(std::abs(1.0 - part), before);
    before = std::abs(1.0 - part);
  }
}

/// Largest difference between the tips of a cantilever by modes and by finite elements under an end
/// force that grows from zero, relative to the largest deflection.
double tip_error(int modes) {
  FeOptions stress;
  stress.plane = Plane::stress;
  Solid s(slender(), elastic(1.0, 0.0), stress);
  s.fix("left", 0);
  s.fix("left", 1);
  ModalSolid modal(s, "", MassForm::consistent, lowest(modes));
  const auto force = [&s] {
    return std::make_unique<Traction>(
        s.model, "right",
        VectorField{ScalarField(),
                    [](const std::array<double, 3>&, double t) { return 1.0e-9 * t; },
                    ScalarField()});
  };
  s.problem.loads.push_back(force());
  modal.take(force());
  const AlphaWeights newmark = AlphaWeights::newmark(0.25, 0.5);
  ImplicitDynamics one(s.problem, {newmark, MassForm::consistent, {}}, make_direct_solver());
  ImplicitDynamics other(modal.problem, {newmark, MassForm::lumped, {}}, make_direct_solver());
  EXPECT_FALSE(one.begin(s.motion, 0.0) || other.begin(modal.motion, 0.0));
  const double dt = 20.0;  // 500 of them are the longest period, 2 pi 1600 sqrt(12)/1.8751^2
  double error = 0.0, size = 0.0;
  for (int k = 0; k < 500; ++k) {
    EXPECT_FALSE(one.step(s.motion, k * dt, dt) || other.step(modal.motion, k * dt, dt));
    const double tip = s.mean_displacement("right").y();
    const std::vector<double> kept = s.motion.q;
    s.motion.q = modal.nodal(modal.motion.q);
    error = std::max(error, std::abs(s.mean_displacement("right").y() - tip));
    s.motion.q = kept;
    size = std::max(size, std::abs(tip));
  }
  return error / size;
}

TEST(Modes, OfACantileverTendToItsMotion) {
  // What the left-out modes take of the deflection, 12/beta_i^4 with beta_i = (i - 1/2) pi, twice
  // as much while they vibrate: a sum that falls with the cube of the number of modes.
  for (const int modes : {1, 2, 4, 8}) {
    const double left_out = 12.0 / (3.0 * std::pow(std::numbers::pi, 4) * std::pow(modes, 3));
    const double error = tip_error(modes);
    EXPECT_LT(error, 2.0 * left_out) << modes;
    EXPECT_GT(error, 0.2 * left_out) << modes;
  }
}

Eigen::Vector3d momentum(const Solid& s, const SparseMatrix& mass, const std::vector<double>& v) {
  const Vector p = mass * view(v);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < p.size(); ++k) sum(k % s.model.mesh().dim) += p(k);
  return sum;
}

Eigen::Vector3d spin(const Solid& s, const SparseMatrix& mass, const std::vector<double>& v) {
  const Vector p = mass * view(v);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int node = 0; node < s.model.mesh().node_count(); ++node)
    sum += position(s.model.mesh(), node).cross(Eigen::Vector3d(p.segment<3>(3 * node)));
  return sum;
}

/// Momenta of a free body with few modes are those of the mesh, at the start and under loads.
TEST(FreeBody, HasTheMomentaOfItsMesh) {
  for (const MassForm form : {MassForm::consistent, MassForm::lumped}) {
    Mesh mesh = unit_mesh("hex8", 4);
    distort(mesh, 0.05);
    Solid s(std::move(mesh), elastic());
    s.motion.v = nodal(s.model.mesh(), [](const Position& x) {
      return Position(1.0 - 2.0 * x.y() + x.x() * x.y(), 2.0 * x.x(), 3.0 + std::sin(x.z()));
    });
    ModalSolid modal(s, "right", form, lowest(5));
    // Amplitudes of what is not in the space differ, momenta do not: rigid motions are in it.
    const std::vector<double> v = modal.nodal(modal.motion.v);
    const double size = roundoff(1.0e3, 10.0);
    EXPECT_LT((momentum(s, modal.mass, v) - momentum(s, modal.mass, s.motion.v)).norm(), size);
    EXPECT_LT((spin(s, modal.mass, v) - spin(s, modal.mass, s.motion.v)).norm(), size);
    const Eigen::Vector3d start = momentum(s, modal.mass, v), turning = spin(s, modal.mass, v);
    modal.take(pulsating_traction(s.model));
    const ImplicitDynamics::Options options{AlphaWeights::newmark(0.25, 0.5), MassForm::lumped, {}};
    ImplicitDynamics run(modal.problem, options, make_direct_solver());
    const double dt = 0.05;
    advance(run, modal.motion, 40, dt);
    // Impulses of the resultants by the trapezoidal rule, which Newmark's steps are.
    Vector resultant = Vector::Zero(s.model.dofs());
    for (int k = 0; k <= 40; ++k) {
      Vector f = Vector::Zero(s.model.dofs());
      pulsating_traction(s.model)->add(k * dt, {}, f);
      resultant += (k % 40 == 0 ? 0.5 : 1.0) * dt * f;
    }
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero(), twist = impulse;
    for (int node = 0; node < s.model.mesh().node_count(); ++node) {
      const Eigen::Vector3d f = resultant.segment<3>(3 * node);
      impulse += f;
      twist += position(s.model.mesh(), node).cross(f);
    }
    const std::vector<double> later = modal.nodal(modal.motion.v);
    // Newton's method leaves 1e-9 of the forces in each step, at most of the order of one.
    const double iterated = iteration(1.0e-9, 40 * dt) * 10.0;
    EXPECT_LT((momentum(s, modal.mass, later) - start - impulse).norm(), iterated);
    EXPECT_LT((spin(s, modal.mass, later) - turning - twist).norm(), iterated);
  }
}

TEST(Reduction, GivesTheSameBits) {
  Solid s = solid_of(with_port[0]);
  const ModalSolid once(s, "right", MassForm::consistent, lowest(4));
  const ModalSolid again(s, "right", MassForm::consistent, lowest(4));
  EXPECT_EQ(once.basis.shapes, again.basis.shapes);
  EXPECT_EQ(once.basis.frequencies, again.basis.frequencies);
}

TEST(Reduction, IsRefusedWhenThereAreTooFewModes) {
  Solid s = solid_of(with_port[0]);
  const int free = s.model.dofs() - 8 - 8;
  EXPECT_NO_THROW(ModalSolid(s, "right", MassForm::consistent, lowest(free)));
  EXPECT_THROW(ModalSolid(s, "right", MassForm::consistent, lowest(free + 1)), InputError);
}

TEST(Reduction, IsRefusedWhenTheMeshIsAMechanism) {
  FeOptions options;
  options.formulation = Formulation::one_point;
  options.hourglass = 0.0;
  Solid s(unit_mesh("quad4", 4), elastic(), options);  // nothing resists its hourglasses
  EXPECT_THROW(ModalSolid(s, "", MassForm::consistent, lowest(3)), InputError);
  EXPECT_THROW(ModalSolid(s, "right_top", MassForm::consistent, lowest(3)), InputError);
}

}  // namespace
}  // namespace abut::solids_modal_tests
