// Goal: every element converges at its order in bending and shear. Oracle: Timoshenko's cantilever
// under an end load, exact in plane elasticity (Timoshenko and Goodier, Theory of Elasticity, 3rd
// ed., article 21; Augarde and Deeks 2008 on how to support and load it as the solution says).
#include <cmath>

#include "subdomain_solver/materials/linear_elastic.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_beam_tests {
namespace {

/// Half-height 1/2, length 2, force 1 upwards at the end x = L; plane strain by its own moduli.
struct Cantilever {
  double length = 2.0, height = 1.0, inertia = 1.0 / 12.0;
  double young, nu;  // of the plane

  Cantilever(double e, double poisson, Plane plane)
      : young(plane == Plane::strain ? e / (1.0 - poisson * poisson) : e),
        nu(plane == Plane::strain ? poisson / (1.0 - poisson) : poisson) {}

  Position displacement(const Position& at) const {
    const double x = at.x(), y = at.y(), d2 = height * height;
    const double scale = 1.0 / (6.0 * young * inertia);
    return {-scale * y * ((6.0 * length - 3.0 * x) * x + (2.0 + nu) * (y * y - d2 / 4.0)),
            scale * (3.0 * nu * y * y * (length - x) + (4.0 + 5.0 * nu) * d2 * x / 4.0 +
                     (3.0 * length - x) * x * x),
            0.0};
  }
  double bending_stress(const Position& at) const { return -(length - at.x()) * at.y() / inertia; }
  double shear_stress(double y) const { return (height * height / 4.0 - y * y) / (2.0 * inertia); }
};

Mesh beam_mesh(const std::string& element, int n) {
  if (element_named(element).dim == 2) {
    RectangleMesh m;
    m.origin = {0.0, -0.5};
    m.lengths = {2.0, 1.0};
    m.elements = {2 * n, n};
    m.element = element;
    return generate(m, "test");
  }
  BoxMesh m;  // one cell thick
  m.origin = {0.0, -0.5, 0.0};
  m.lengths = {2.0, 1.0, 1.0 / n};
  m.elements = {2 * n, n, 1};
  m.element = element;
  return generate(m, "test");
}

/// Reference position of a quadrature point.
Position place(const FeModel& model, const FeModel::PointState& at) {
  const CellBlock& cells = model.mesh().blocks[at.block];
  const Element& e = *cells.element;
  const Tabulation t = tabulate(e, quadrature(e.shape, stiffness_degree(e)));
  Position x = Position::Zero();
  for (int a = 0; a < e.nodes; ++a) {
    const std::int32_t node = cells.nodes[at.cell * e.nodes + a];
    x += t.n[at.point * e.nodes + a] * position(model.mesh(), node);
  }
  return x;
}

struct Errors {
  double tip = 0.0;     // of the mean deflection of the end, relative
  double energy = 0.0;  // energy norm of the error at the quadrature points, relative
};

Errors errors(const std::string& element, int n, Plane plane) {
  const double young = 3.0, nu = 0.3;
  const Cantilever exact(young, nu, plane);
  Solid s(beam_mesh(element, n), std::make_unique<LinearElastic>(isotropic(young, nu), 1.0),
          {plane, Formulation::full, 1.0});
  const int dim = s.model.mesh().dim;
  for (int i = 0; i < 2; ++i) {
    s.prescribe("left", i,
                [&exact, i](const Position& x, double) { return exact.displacement(x)(i); });
  }
  if (dim == 3) {
    s.fix("back", 2);
    s.fix("front", 2);
  }
  s.pull("right",
         {ScalarField(),
          [&exact](const std::array<double, 3>& x, double) { return exact.shear_stress(x[1]); },
          ScalarField()});
  s.settle();
  Errors out;
  double whole = 0.0;
  EXPECT_TRUE(s.model.visit(s.motion.q, s.motion.history, [&](const FeModel::PointState& at) {
    const Position x = place(s.model, at);
    Eigen::Matrix2d stress;
    stress << exact.bending_stress(x), exact.shear_stress(x.y()), exact.shear_stress(x.y()), 0.0;
    const auto energy = [&exact](const Eigen::Matrix2d& sigma) {  // complementary, in the plane
      return ((1.0 + exact.nu) * sigma.squaredNorm() - exact.nu * sigma.trace() * sigma.trace()) /
             exact.young;
    };
    whole += at.volume * energy(stress);
    out.energy += at.volume * energy(at.stress.topLeftCorner<2, 2>() - stress);
  }));
  out.energy = std::sqrt(out.energy / whole);
  double deflection = 0.0, sum = 0.0;
  for (std::int32_t node : s.model.mesh().nodes_of("right")) {
    deflection += s.displacement(node).y();
    sum += exact.displacement(position(s.model.mesh(), node)).y();
  }
  out.tip = std::abs(deflection / sum - 1.0);
  return out;
}

struct Beam {
  std::string element;
  Plane plane;
};
void PrintTo(const Beam& b, std::ostream* out) {
  *out << b.element << (b.plane == Plane::stress ? " plane stress" : " plane strain");
}

class Cantilevers : public testing::TestWithParam<Beam> {};

TEST_P(Cantilevers, ConvergeAtTheOrderOfTheElement) {
  const auto& [element, plane] = GetParam();
  const int order = element_named(element).order;
  const int n = order == 1 ? 8 : 4;
  const Errors coarse = errors(element, n, plane), fine = errors(element, 2 * n, plane);
  // Theory: order p in the energy norm, and at least p + 1 in the mean deflection (2p were its dual
  // problem smooth; it is a clamped one and has singular corners). When h is small: at these h
  // terms of next order, h relative to the height, are up to a tenth of it.
  EXPECT_GT(observed_order(coarse.energy, fine.energy), order - 0.1);
  EXPECT_GT(observed_order(coarse.tip, fine.tip), order + 1.0 - 0.1);
}

std::vector<Beam> beams() {
  std::vector<Beam> out;
  for (const std::string& element : solid_elements()) {
    out.push_back({element, Plane::strain});
    if (element_named(element).dim == 2) out.push_back({element, Plane::stress});
  }
  return out;
}
INSTANTIATE_TEST_SUITE_P(All, Cantilevers, testing::ValuesIn(beams()));

}  // namespace
}  // namespace abut::solids_beam_tests
