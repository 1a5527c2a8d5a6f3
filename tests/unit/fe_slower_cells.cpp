// Goal: cells that are told slower than a frequency are, all that are by more than rounding are
// told, and stable steps have the bits that cells one by one give. Oracle: eigenvalues of every
// cell.
#include "subdomain_solver/fe/slower_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/highest_frequency.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "tests/support/cell_models.hpp"
#include "tests/support/solids.hpp"

namespace abut::fe_slower_cells_tests {
namespace {

FeModel model_of(const BatchCase& c) {
  Mesh mesh = unit_mesh(c.element, c.element == "hex20" ? 2 : 3);
  distort(mesh, 0.03);
  return FeModel(std::move(mesh), law_named(c.law), {Plane::strain, c.formulation, 0.7});
}

/// [1/s^2] of all cells by eigenvalues.
std::vector<double> squares_of(FeModel& model, const std::vector<double>& q) {
  const std::vector<double> history(model.history_size(), 0.0);
  std::vector<double> out;
  Eigen::MatrixXd stiffness;
  for (int c = 0; c < model.mesh().blocks[0].count(); ++c) {
    EXPECT_TRUE(model.cell_tangent(0, c, q, history, stiffness));
    out.push_back(highest_square(stiffness, model.cell_mass(0, c)));
  }
  return out;
}

std::vector<BatchCase> cases() {
  std::vector<BatchCase> out;
  for (const std::string element : {"hex8", "hex20", "tet4", "tet10", "quad4", "quad9", "tri6"})
    for (const std::string law : {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean",
                                  "mooney_rivlin", "hencky", "j2_plasticity"})
      out.push_back({element, Formulation::full, law});
  for (const std::string element : {"hex8", "tet4", "quad4", "tri3"})
    for (const std::string law : {"saint_venant_kirchhoff", "neo_hookean", "j2_plasticity"})
      out.push_back({element, Formulation::mean_dilatation, law});
  return out;
}

class SlowerCellsOf : public testing::TestWithParam<BatchCase> {};
INSTANTIATE_TEST_SUITE_P(Laws, SlowerCellsOf, testing::ValuesIn(cases()));

/// Groups that are not full, too. A millionth is far above what tangents and masses in another
/// order of sums change, and above the margin of 1e-9.
TEST_P(SlowerCellsOf, AreThoseWhoseEigenvaluesAreLower) {
  FeModel model = model_of(GetParam());
  SlowerCells slower(model);
  if (!slower.can(0)) GTEST_SKIP() << "no fused multiply-add";
  const std::vector<double> history(model.history_size(), 0.0);
  const bool everywhere = GetParam().law == "neo_hookean" || model.is_linear() ||
                          GetParam().law == "saint_venant_kirchhoff";
  for (const double size : {0.0, 0.02}) {
    const std::vector<double> q = displaced(model, size);
    const std::vector<double> squares = squares_of(model, q);
    const int count = static_cast<int>(squares.size());
    for (int first = 0; first < count; first += 7) {
      std::vector<int> cells(index(std::min(7, count - first)));
      std::iota(cells.begin(), cells.end(), first);
      for (const int c : cells)
        for (const double factor : {1.0 - 1.0e-6, 1.0 + 1.0e-6}) {
          const double square = factor * squares[index(c)];
          const unsigned told = slower.find(0, cells, q, history, square);
          for (const int other : cells) {
            const bool is_told = (told >> (other - first) & 1u) != 0;
            const bool known = size == 0.0 || everywhere;
            EXPECT_EQ(is_told, known && squares[index(other)] < square) << size << " " << other;
          }
        }
    }
  }
}

TEST_P(SlowerCellsOf, LeaveTheBitsOfStableSteps) {
  FeModel model = model_of(GetParam());
  const std::vector<double> history(model.history_size(), 0.0);
  HighestFrequency frequency(model);
  for (const double size : {0.0, 0.02}) {
    const std::vector<double> q = displaced(model, size);
    const std::vector<double> squares = squares_of(model, q);
    const double most = *std::max_element(squares.begin(), squares.end());
    EXPECT_EQ(stable_step(model, q, history), 2.0 / (std::sqrt(most) * (1.0 + 1.0e-6)));
    const double from = 0.5 * most;
    const auto bound = frequency.bound(q, history, from, FrequencyWatch::Effort::exact);
    ASSERT_TRUE(bound.has_value());
    EXPECT_EQ(bound->square, most);
  }
}

TEST(SlowerCells, AreToldByTheSameBitsForEveryWidthOfRegisters) {
  constexpr int nodes = 4, points = 2, dim = 3, size = nodes * dim;
  DrawTensors draw;
  const auto drawn = [&draw](int count, double low, double high) {
    std::vector<double> out(index(count));
    for (double& x : out) x = draw.between(low, high);
    return out;
  };
  const std::vector<double> weight = drawn(points, 0.5, 1.0), mass = drawn(nodes * 8, 1.0, 2.0),
                            slope = drawn(points * size, -1.0, 1.0),
                            place = drawn(size * 8, -1.0, 1.0);
  const int numbers = nodes * (nodes + 1) / 2 * dim * dim * 8;
  const std::vector<double> stiffness = drawn(numbers, -0.5, 0.5);
  std::vector<std::vector<double>> found;
  std::vector<unsigned> told;
  for (const StiffnessKernels* kernels : {&stiffness_generic, &stiffness_here()}) {
    std::vector<double>& out = found.emplace_back(index(points * (1 + size) * 8));
    double* gradient = out.data() + points * 8;
    kernels->space_shape(
        {nodes, points, weight.data(), slope.data(), place.data(), out.data(), gradient});
    std::vector<double> rows(index(size * (size + 1) / 2 * 8));
    told.push_back(
        kernels->space_slowness({nodes, 1.0, stiffness.data(), mass.data(), rows.data()}));
    out.insert(out.end(), rows.begin(), rows.end());
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(told[0], told[1]);
  EXPECT_NE(told[0], 0U);  // some are definite, some are not
  EXPECT_NE(told[0], 255U);
}

TEST(SlowerCells, AreNotToldWhereACellHasNoAnswer) {
  FeModel model = model_of({"hex8", Formulation::full, "neo_hookean"});
  std::vector<double> q(index(model.dofs()), 0.0);
  q[index(model.dofs()) - 3] = -2.0;  // the last node past its neighbours
  EXPECT_TRUE(std::isnan(stable_step(model, q, {})));
}

}  // namespace
}  // namespace abut::fe_slower_cells_tests
