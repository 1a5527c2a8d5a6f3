// Goal: a surface that loses its mass leaves it to what can move. Oracle: identity, the mass of
// all free coordinates along an axis is that of the plain body, whatever is held.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"

namespace abut::fe_model_layer_tests {
namespace {

FeModel body(const std::string& element, int cells) {
  return {unit_mesh(element, cells), std::make_unique<LinearElastic>(test_moduli, 1.0), {}};
}

std::vector<int> dofs_of(const FeModel& model, const std::string& side) {
  std::vector<int> dofs;
  for (const std::int32_t node : model.mesh().nodes_of(side))
    for (int i = 0; i < model.mesh().dim; ++i) dofs.push_back(node * model.mesh().dim + i);
  std::ranges::sort(dofs);
  return dofs;
}

/// Contact touches the top, the left side is held, or the bottom; corners on both are held.
struct Sides {
  std::vector<int> bare, held;
};

Sides sides(const FeModel& model, const std::string& held) {
  Sides s;
  s.held = dofs_of(model, held);
  std::ranges::set_difference(dofs_of(model, model.mesh().dim == 3 ? "front" : "top"), s.held,
                              std::back_inserter(s.bare));
  return s;
}

/// [kg] of free coordinates along axis 0.
double moving(const FeModel& model, const Vector& lumped, const std::vector<int>& held) {
  double sum = 0.0;
  for (int dof = 0; dof < model.dofs(); dof += model.mesh().dim)
    if (!std::ranges::binary_search(held, dof)) sum += lumped(dof);
  return sum;
}

/// Columns of the consistent matrix, entries among free coordinates alone.
double moving(const FeModel& model, const std::vector<int>& held) {
  double sum = 0.0;
  const SparseMatrix& mass = model.mass();
  const auto free = [&](auto dof) {
    return dof % model.mesh().dim == 0 && !std::ranges::binary_search(held, static_cast<int>(dof));
  };
  for (Eigen::Index c = 0; c < mass.outerSize(); ++c)
    for (SparseMatrix::InnerIterator at(mass, c); at; ++at)
      if (free(at.row()) && free(at.col())) sum += at.value();
  return sum;
}

class Layers : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Elements, Layers, testing::ValuesIn(solid_elements()),
                         [](const auto& param) { return param.param; });

TEST_P(Layers, LeaveTheirMassToWhatMoves) {
  for (const char* held : {"left", "bottom"}) {
    for (const int cells : {2, 3}) {
      const FeModel plain = body(GetParam(), cells);
      FeModel layered = body(GetParam(), cells);
      const Sides s = sides(layered, held);
      ASSERT_FALSE(s.bare.empty());
      layered.make_massless(s.bare, s.held);
      const double expected = moving(plain, plain.lumped_mass(), s.held);
      // Round-off of sums over some hundred cells of mass below 1.
      EXPECT_NEAR(moving(layered, layered.lumped_mass(), s.held), expected, 1e-13)
          << held << " " << cells;
      for (const int dof : s.bare) EXPECT_EQ(layered.lumped_mass()(dof), 0.0);
      // Of the consistent matrix free nodes also share what they have with held ones.
      EXPECT_GT(moving(layered, s.held), moving(plain, s.held) - 1e-13) << held << " " << cells;
    }
  }
}

/// Explicit steps find the forces on a layer by batches of its cells, and its stiffness cell by
/// cell.
TEST(BatchedLayers, HaveTheForcesOfSingleCells) {
  for (const char* element : {"hex8", "tet4", "quad4", "tri3"}) {
    for (const bool plastic : {false, true}) {
      SCOPED_TRACE(std::string(element) + (plastic ? " plastic" : ""));
      FeOptions options;
      options.formulation = plastic ? Formulation::mean_dilatation : Formulation::full;
      std::array<LayerResponse, 2> responses;
      for (const bool batched : {false, true}) {
        options.batched = batched;
        std::unique_ptr<const Material> law = std::make_unique<NeoHookean>(test_moduli, 1.0);
        if (plastic) law = std::make_unique<J2Plasticity>(test_moduli, test_hardening(), 1.0);
        FeModel model(unit_mesh(element, 3), std::move(law), options);
        const Sides s = sides(model, "left");
        model.make_massless(s.bare, s.held);
        ASSERT_EQ(model.batched() != nullptr, batched);
        std::vector<double> q(index(model.dofs()));
        for (std::size_t i = 0; i < q.size(); ++i) q[i] = 0.03 * std::sin(7.0 * double(i));
        // Every point has flown in its own way.
        std::vector<double> history(model.history_size());
        for (std::size_t i = 0; i < history.size(); ++i)
          history[i] = 0.01 * std::abs(std::sin(3.0 * double(i)));
        ASSERT_TRUE(model.evaluate_layer(q, history, Model::Want::force, responses[batched]));
      }
      // Some dozen roundings of stresses of order 1.
      EXPECT_LT((responses[0].force - responses[1].force).lpNorm<Eigen::Infinity>(), 1e-14);
      EXPECT_GT(responses[0].force.lpNorm<Eigen::Infinity>(), 1e-3);
    }
  }
}

/// One layer of cells between what is touched and what is held: nothing that moves would have mass.
TEST_P(Layers, RefuseWhereNothingMovesThatCouldTakeIt) {
  FeModel layered = body(GetParam(), 1);
  const Sides s = sides(layered, layered.mesh().dim == 3 ? "back" : "bottom");
  if (element_named(GetParam()).order > 1) {  // nodes between both sides take it
    layered.make_massless(s.bare, s.held);
    return;
  }
  EXPECT_THROW(layered.make_massless(s.bare, s.held), InputError);
}

/// One cell that nothing holds would have its mass on one side, and turn about that.
TEST(LayersOfWhatFlies, KeepTheirMassWhereTheCentreWouldMove) {
  for (const char* element : {"quad4", "tri3", "hex8", "tet4"}) {
    SCOPED_TRACE(element);
    FeModel one = body(element, 1), three = body(element, 3);
    const std::string top = one.mesh().dim == 3 ? "front" : "top";
    const Vector before = one.lumped_mass();
    EXPECT_THROW(one.make_massless(dofs_of(one, top), {}), InputError);
    EXPECT_EQ(one.lumped_mass(), before);
    EXPECT_EQ(one.whole_mass(), before);
    EXPECT_TRUE(one.massless().empty());
    EXPECT_NO_THROW(three.make_massless(dofs_of(three, top), {}));
  }
}

}  // namespace
}  // namespace abut::fe_model_layer_tests
