// Goal: the bound on the highest frequency of a deformed body is one, for every element,
// formulation and law, however it deforms; and no larger than its derivation says. Oracles:
// eigenvalues of the assembled problem and of its cells; identities.
#include "subdomain_solver/fe/highest_frequency.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "base/index.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solid_runs.hpp"

namespace abut::solids_frequency_bound_tests {
namespace {

using Effort = FrequencyWatch::Effort;

struct Case {
  std::string element;
  Formulation formulation;
  int law;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.element << " " << static_cast<int>(c.formulation) << " " << all_laws()[c.law].name;
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const std::string& element : solid_elements())
    for (Formulation formulation :
         {Formulation::full, Formulation::mean_dilatation, Formulation::one_point})
      for (int law = 0; law < static_cast<int>(all_laws().size()); ++law)
        if (formulation != Formulation::one_point || element_named(element).order == 1)
          out.push_back({element, formulation, law});
  return out;
}

/// A law of all_laws() of one's own.
std::unique_ptr<const Material> law_of(int i) {
  const Moduli& m = test_moduli;
  switch (i) {
    case 0:
      return std::make_unique<LinearElastic>(m, 1.0);
    case 1:
      return std::make_unique<SaintVenantKirchhoff>(m, 1.0);
    case 2:
      return std::make_unique<NeoHookean>(m, 1.0);
    case 3:
      return std::make_unique<MooneyRivlin>(MooneyRivlinParameters{0.15, 0.1, m.bulk, 1.0});
    case 4:
      return std::make_unique<Hencky>(m, 1.0);
    default:
      return std::make_unique<J2Plasticity>(m, test_hardening(), 1.0);
  }
}

/// Cells of different shapes and sizes.
Mesh uneven_mesh(const std::string& element, double distortion) {
  Mesh mesh = unit_mesh(element, 2);
  distort(mesh, distortion);
  for (std::size_t i = 0; i < mesh.points.size(); i += index(mesh.dim))
    mesh.points[i] *= 2.0 + mesh.points[i];
  return mesh;
}

FeOptions options_of(Formulation formulation, int threads = 1) {
  FeOptions options;
  options.formulation = formulation;
  options.thickness = 0.7;
  options.batched = true;
  options.threads = threads;
  return options;
}

double frequency_of_assembled(FeModel& model, const std::vector<double>& q,
                              const std::vector<double>& history) {
  ModelResponse response;
  EXPECT_TRUE(model.evaluate(q, history, Model::Want::tangent, response));
  return highest_square(
      Eigen::MatrixXd(response.tangent),
      model.lumped_mass()(Eigen::seqN(0, model.mesh().node_count(), model.mesh().dim)));
}

/// Stretches and shears of the whole body, and of each cell in its own way.
std::vector<double> deformed(const Mesh& mesh, double size, DrawTensors& draw) {
  const Matrix3 h = draw.matrix(size);
  std::vector<double> q = nodal(mesh, [&h](const Position& x) { return h * x; });
  for (double& u : q) u += 0.1 * size * draw.between(-1.0, 1.0);
  return q;
}

class FrequencyBoundOf : public testing::TestWithParam<Case> {};

TEST_P(FrequencyBoundOf, IsAboveAllFrequenciesOfTheAssembledBody) {
  const Case& c = GetParam();
  FeModel model(uneven_mesh(c.element, 0.04), law_of(c.law), options_of(c.formulation));
  HighestFrequency watch(model);
  const std::vector<double> history(model.history_size(), 0.0);
  DrawTensors draw;
  for (const double size : {0.0, 0.01, 0.1, 0.2, 0.3}) {
    const std::vector<double> q = deformed(model.mesh(), size, draw);
    const double limit = stable_step(model, q, history);
    if (std::isnan(limit)) continue;  // inverted, or a point without an answer
    const double truth = frequency_of_assembled(model, q, history);
    const double cells = 4.0 / (limit * limit);
    const auto bound = watch.bound(q, history, 0.5 * cells, Effort::bounded);
    ASSERT_TRUE(bound);
    // Rounding of eigenvalues of matrices of this size.
    EXPECT_GE(bound->square, truth * (1.0 - 1.0e-12)) << size;
    // Cells alone, within the margin of stable_step; and what F varies by in a cell, some 0.2 of
    // size to both sides, changes moduli by up to ten times that.
    EXPECT_GE(bound->square, cells * (1.0 - 3.0e-6)) << size;
    EXPECT_LE(bound->square, cells * (1.3 + 4.0 * size)) << size;
  }
}

TEST_P(FrequencyBoundOf, IsDecidedByEigenvaluesOfCells) {
  const Case& c = GetParam();
  FeModel model(uneven_mesh(c.element, 0.04), law_of(c.law), options_of(c.formulation));
  HighestFrequency watch(model);
  const std::vector<double> history(model.history_size(), 0.0);
  DrawTensors draw;
  for (const double size : {0.0, 0.1}) {
    const std::vector<double> q = deformed(model.mesh(), size, draw);
    const double limit = stable_step(model, q, history);
    const double cells = 4.0 / (limit * limit);
    // stable_step is told apart from its own square by the margin of equal cells, 2e-6.
    const auto above = watch.bound(q, history, cells * 0.9999, Effort::exact);
    ASSERT_TRUE(above);
    EXPECT_GE(above->cell, 0);
    EXPECT_NEAR(above->square, cells, 1.1e-4 * cells);
    EXPECT_NE(watch.place(*above).find("cell "), std::string::npos);
    const auto below = watch.bound(q, history, cells * 1.0001, Effort::exact);
    ASSERT_TRUE(below);
    EXPECT_EQ(below->cell, -1);
    EXPECT_EQ(below->square, cells * 1.0001);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FrequencyBoundOf, testing::ValuesIn(cases()));

TEST(FrequencyBound, IsThatOfTheCellsWhereAllAreParallelepipedsInUniformStrain) {
  for (const char* element : {"hex8", "quad4", "tet4"}) {
    for (const int law : {1, 2}) {
      Mesh mesh = unit_mesh(element, 2);
      for (std::size_t i = 0; i < mesh.points.size(); i += index(mesh.dim)) {
        mesh.points[i] += 0.3 * mesh.points[i + 1];
        mesh.points[i + 1] *= 5.0;
      }
      FeModel model(std::move(mesh), law_of(law), options_of(Formulation::full));
      HighestFrequency watch(model);
      Matrix3 h;
      h << -0.4, 0.1, 0.0, 0.2, 0.3, 0.0, 0.0, 0.0, model.mesh().dim == 3 ? 0.1 : 0.0;
      const std::vector<double> q = nodal(model.mesh(), [&h](const Position& x) { return h * x; });
      const double limit = stable_step(model, q, {});
      const double cells = 4.0 / (limit * limit);
      const auto bound = watch.bound(q, {}, 0.7 * cells, Effort::bounded);
      ASSERT_TRUE(bound);
      // Bounds rise by a hundredth at a time.
      EXPECT_LE(bound->square, 1.0101 * cells) << element << " " << law;
      EXPECT_GE(bound->square, cells * (1.0 - 3.0e-6)) << element << " " << law;
    }
  }
}

TEST(FrequencyBound, IsTheSameBitsForAllThreads) {
  const auto bound = [](int threads) {
    FeModel model(unit_mesh("hex8", 14), law_of(2), options_of(Formulation::full, threads));
    HighestFrequency watch(model);
    DrawTensors draw;
    std::vector<double> q(index(model.dofs()));
    for (double& u : q) u = 0.005 * draw.between(-1.0, 1.0);
    return watch.bound(q, {}, 1.0, Effort::bounded)->square;
  };
  EXPECT_EQ(bound(1), bound(3));
}

TEST(FrequencyBound, HasNoAnswerForAnInvertedCell) {
  for (const Formulation formulation : {Formulation::full, Formulation::mean_dilatation}) {
    FeModel model(unit_mesh("hex8", 3), law_of(2), options_of(formulation));
    HighestFrequency watch(model);
    std::vector<double> q(index(model.dofs()), 0.0);
    q[0] = 2.0;
    for (const Effort effort : {Effort::bounded, Effort::exact})
      EXPECT_FALSE(watch.bound(q, {}, 1.0, effort));
  }
}

}  // namespace
}  // namespace abut::solids_frequency_bound_tests
