// Goal: equilibrium of bodies that yield, that rest on inclined planes, and whose load is too much
// for one step. Oracles: the law of plasticity integrated in closed form; the same problem turned;
// the same load in small steps.
#include <cmath>

#include <Eigen/Geometry>

#include "base/index.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_statics_tests {
namespace {

NewtonOptions tight() {
  NewtonOptions newton;
  newton.tolerance = 1.0e-12;
  return newton;
}

TEST(YieldingCube, FollowsTheUniaxialLawThroughLoadAndUnload) {
  // Logarithmic strain e = ln l, Kirchhoff stress t: t = E e up to s0, then t = s0 + h a and
  // e = t/E + a; back along E. In small steps and large ones alike, because loading is radial.
  const double young = 200.0, s0 = 0.4, h = 5.0, loaded = 0.1, back = 0.0985;
  Hardening hardening;
  hardening.yield_stress = s0;
  hardening.modulus = h;
  for (const std::string element : {"hex8", "tet10"}) {
    for (Formulation formulation : {Formulation::full, Formulation::mean_dilatation}) {
      Solid s(unit_mesh(element, 1),
              std::make_unique<J2Plasticity>(isotropic(young, 0.3), hardening, 1.0),
              {Plane::strain, formulation, 1.0});
      s.fix("left", 0);
      s.fix("bottom", 1);
      s.fix("back", 2);
      // Logarithmic strain: up during the first second, back during the next.
      s.prescribe("right", 0, [loaded, back](const Position&, double time) {
        return std::expm1(time < 1.0 ? loaded * time : loaded + (back - loaded) * (time - 1.0));
      });
      QuasiStatic run(s.problem, {tight(), 8}, make_direct_solver());
      ASSERT_FALSE(run.begin(s.motion, 0.0));
      const auto kirchhoff = [&s] {
        double sum = 0.0, volume = 0.0;
        EXPECT_TRUE(s.model.visit(s.motion.q, s.motion.history, [&](const FeModel::PointState& at) {
          sum += at.volume * (at.stress * at.deformation.transpose())(0, 0);
          volume += at.volume;
        }));
        return sum / volume;
      };
      for (int k = 0; k < 20; ++k) {
        ASSERT_FALSE(run.step(s.motion, 0.1 * k, 0.1)) << element << " step " << k;
        const double time = 0.1 * (k + 1);
        const double e = time < 1.0 ? loaded * time : loaded + (back - loaded) * (time - 1.0);
        const double most = std::min(e, loaded);
        const double reached = time < 1.0 + 1e-12 ? most : loaded;
        const double plastic = std::max(0.0, (young * reached - s0) / (young + h));
        const double exact = young * (e - plastic);
        // Newton's tolerance of 1e-12 of the forces; the history sums twenty of them.
        EXPECT_NEAR(kirchhoff(), exact, 1.0e-10 * s0) << element << " time " << time;
      }
      // What is neither stored nor given back is dissipated: s0 a.
      const double plastic = (young * loaded - s0) / (young + h);
      EXPECT_NEAR(s.motion.dissipated, s0 * plastic, 1.0e-10 * s0) << element;  // as kirchhoff()
    }
  }
}

/// A block on rollers under a pull across and a pull along; everything turned by an angle.
std::vector<double> block_on_rollers(std::unique_ptr<const Material> law, double angle) {
  const Matrix3 turn = Eigen::AngleAxisd(angle, Position::UnitZ()).toRotationMatrix();
  Mesh mesh = unit_mesh("quad8", 3);
  distort(mesh, 0.03);
  const std::vector<std::int32_t> rollers = mesh.nodes_of("bottom");
  const std::int32_t corner = mesh.nodes_of("left_bottom").front();
  move(mesh, [&turn](const Position& x) { return Position(turn * x); });
  std::vector<NodeFrame> frames;
  for (std::int32_t node : rollers) frames.push_back({node, turn});
  Solid s(std::move(mesh), std::move(law), {}, frames);
  s.fix("bottom", 1);
  s.prescribe_node(corner, 0, [](const Position&, double) { return 0.0; });
  const Position pull = turn * Position(0.02, 0.05, 0.0);
  s.pull("top", {[pull](const auto&, double time) { return time * pull.x(); },
                 [pull](const auto&, double time) { return time * pull.y(); }, ScalarField()});
  s.settle(2, tight());
  std::vector<double> u = s.motion.q;
  s.model.to_space(u);
  const Eigen::Matrix2d undo = turn.topLeftCorner<2, 2>().transpose();
  for (std::size_t at = 0; at < u.size(); at += 2)
    view(u).segment<2>(static_cast<Eigen::Index>(at)) =
        (undo * view(u).segment<2>(static_cast<Eigen::Index>(at))).eval();
  return u;
}

TEST(InclinedRollers, CarryATurnedBodyAsLevelOnesDo) {
  const Moduli moduli = isotropic(1.0, 0.3);
  for (double angle : {0.5, 2.0}) {
    // Newton's tolerance of 1e-12 of the forces, over the softest mode: the block tilts on its
    // rollers by some ten times the strain.
    EXPECT_LT(
        largest_difference(block_on_rollers(std::make_unique<LinearElastic>(moduli, 1.0), angle),
                           block_on_rollers(std::make_unique<LinearElastic>(moduli, 1.0), 0.0)),
        1.0e-11);
    EXPECT_LT(largest_difference(block_on_rollers(std::make_unique<NeoHookean>(moduli, 1.0), angle),
                                 block_on_rollers(std::make_unique<NeoHookean>(moduli, 1.0), 0.0)),
              1.0e-11);
  }
}

/// A bar whose end is turned by one radian about its axis.
struct TwistedBar : Solid {
  TwistedBar()
      : Solid(unit_mesh("hex8", 2), std::make_unique<NeoHookean>(isotropic(1.0, 0.4), 1.0)) {
    for (int i = 0; i < 3; ++i) fix("left", i);
    const Position axis(0.0, 0.5, 0.5);
    for (int i = 0; i < 3; ++i) {
      prescribe("right", i, [axis, i](const Position& x, double time) {
        const Eigen::AngleAxisd turn(1.0 * time, Position::UnitX());
        return (turn * (x - axis) - (x - axis))(i);
      });
    }
  }
};

TEST(QuasiStatic, HalvesAStepThatIsTooLong) {
  NewtonOptions few = tight();
  few.max_iterations = 4;
  TwistedBar whole;
  {
    QuasiStatic run(whole.problem, {few, 0}, make_direct_solver());
    ASSERT_FALSE(run.begin(whole.motion, 0.0));
    const Motion before = whole.motion;
    const std::optional<Failed> failed = run.step(whole.motion, 0.0, 1.0);
    ASSERT_TRUE(failed);
    EXPECT_EQ(failed->cause, Failed::Cause::no_convergence);
    EXPECT_EQ(whole.motion.q, before.q);
    EXPECT_EQ(whole.motion.external_work, before.external_work);
  }
  QuasiStatic run(whole.problem, {few, 8}, make_direct_solver());
  ASSERT_FALSE(run.begin(whole.motion, 0.0));
  ASSERT_FALSE(run.step(whole.motion, 0.0, 1.0));
  EXPECT_GT(run.iterations(), few.max_iterations);
  TwistedBar fine;
  fine.settle(20, tight());
  // Elastic: the way does not matter, but for Newton's tolerance of 1e-12 of the forces.
  EXPECT_LT(largest_difference(whole.motion.q, fine.motion.q), 1.0e-10);
}

/// Two unit cells in a row that share one corner alone.
Mesh hinged(const std::string& element) {
  const Mesh one = unit_mesh(element, 1);
  const std::size_t dim = index(one.dim);
  Mesh both = one;
  std::int32_t joint = 0;  // the corner farthest from the origin, which the second begins at
  const auto sum = [&one, dim](std::int32_t node) {
    double total = 0.0;
    for (std::size_t i = 0; i < dim; ++i) total += one.points[index(node) * dim + i];
    return total;
  };
  for (std::int32_t node = 1; node < one.node_count(); ++node)
    if (sum(node) > sum(joint)) joint = node;
  std::vector<std::int32_t> number;  // of the second cell's nodes
  for (std::int32_t node = 0; node < one.node_count(); ++node) {
    number.push_back(sum(node) == 0.0 ? joint : both.node_count());
    if (number.back() == joint) continue;
    for (std::size_t i = 0; i < dim; ++i)
      both.points.push_back(one.points[index(node) * dim + i] + 1.0);
  }
  for (std::int32_t node : one.blocks[0].nodes) both.blocks[0].nodes.push_back(number[node]);
  return both;
}

/// A body that is pulled along its second axis and has no answer.
void expect_singular(Solid& s, const std::string& words) {
  s.problem.loads.push_back(std::make_unique<BodyForce>(
      s.model,
      VectorField{[](const auto&, double time) { return 0.3 * time; },
                  [](const auto& x, double time) { return time * (1.0 + x[0]); }, ScalarField()}));
  QuasiStatic run(s.problem, {{}, 4}, make_direct_solver());
  ASSERT_FALSE(run.begin(s.motion, 0.0)) << words;
  const std::optional<Failed> failed = run.step(s.motion, 0.0, 1.0);
  ASSERT_TRUE(failed) << words << ": moved by " << view(s.motion.q).lpNorm<Eigen::Infinity>();
  EXPECT_NE(failed->detail.find("singular"), std::string::npos) << words << failed->detail;
}

TEST(QuasiStatic, SaysThatAHingeHasNoAnswer) {
  for (const std::string& element : solid_elements()) {
    for (const bool linear : {true, false}) {
      std::unique_ptr<const Material> law =
          std::make_unique<LinearElastic>(isotropic(1.0, 0.3), 1.0);
      if (!linear) law = std::make_unique<NeoHookean>(isotropic(1.0, 0.3), 1.0);
      Solid s(hinged(element), std::move(law));
      for (int i = 0; i < s.model.mesh().dim; ++i) s.fix("left", i);
      expect_singular(s, element + (linear ? " linear " : " neo-Hookean "));
    }
  }
}

TEST(QuasiStatic, SaysThatHourglassesWithoutStiffnessHaveNoAnswer) {
  for (const std::string element : {"quad4", "hex8"}) {
    for (const int n : {2, 5, 8}) {
      FeOptions options;
      options.formulation = Formulation::one_point;
      options.hourglass = 0.0;
      Solid s(unit_mesh(element, n), std::make_unique<LinearElastic>(isotropic(1.0, 0.3), 1.0),
              options);
      s.fix("left", 0);
      s.fix("bottom", 1);
      if (s.model.mesh().dim == 3) s.fix("back", 2);
      expect_singular(s, element + " " + std::to_string(n) + " ");
    }
  }
}

}  // namespace
}  // namespace abut::solids_statics_tests
