// Goal: tangents of cells in batches are those of the cells one by one and the differences of the
// forces in batches; threads and widths of registers change no bit of any assembly.
#include "base/dense.hpp"
#include "subdomain_solver/fe/batched_stiffness.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "tests/support/cell_models.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_batched_tangents_tests {
namespace {

/// Batches that are not full, and more cells than are asked at a time.
FeModel model_of(const BatchCase& c, bool batched, int threads = 1) {
  const Element& element = element_named(c.element);
  Mesh mesh = unit_mesh(c.element, element.order > 1 ? 2 : element.dim == 3 ? 3 : 7);
  distort(mesh, 0.02);
  FeOptions options{Plane::strain, c.formulation, 0.7};
  options.batched = batched;
  options.threads = threads;
  return FeModel(std::move(mesh), law_named(c.law), options);
}

ModelResponse tangent_of(FeModel& model, double size) {
  const std::vector<double> history(model.history_size(), 0.0);
  ModelResponse out;
  EXPECT_TRUE(model.evaluate(displaced(model, size), history, Model::Want::tangent, out));
  return out;
}

std::vector<BatchCase> cases() {
  std::vector<BatchCase> out;
  for (const std::string element : {"hex8", "quad4", "tet4", "tri3"})
    for (const Formulation formulation : {Formulation::full, Formulation::mean_dilatation})
      for (const std::string law : {"saint_venant_kirchhoff", "neo_hookean"})
        out.push_back({element, formulation, law});
  for (const std::string element : {"tet10", "hex20"})
    out.push_back({element, Formulation::full, "neo_hookean"});
  return out;
}

class BatchedTangentsOf : public testing::TestWithParam<BatchCase> {};
INSTANTIATE_TEST_SUITE_P(Laws, BatchedTangentsOf, testing::ValuesIn(cases()));

TEST_P(BatchedTangentsOf, AreTheCellByCellOnes) {
  FeModel one = model_of(GetParam(), false), many = model_of(GetParam(), true);
  for (const double size : {1.0e-8, 1.0e-2, 0.04}) {
    const ModelResponse wanted = tangent_of(one, size), found = tangent_of(many, size);
    const Eigen::MatrixXd all = wanted.tangent, others = found.tangent;
    // Sums of some hundred products in another order.
    EXPECT_LT((all - others).cwiseAbs().maxCoeff(), roundoff(1000.0, all.cwiseAbs().maxCoeff()))
        << size;
    // Of a force of 0.01 at least: the law's stress is exact to rounding of a modulus.
    EXPECT_LT((wanted.force - found.force).cwiseAbs().maxCoeff(),
              roundoff(1000.0, std::max(wanted.force.cwiseAbs().maxCoeff(), 0.01)));
  }
}

TEST_P(BatchedTangentsOf, AreDifferencesOfForces) {
  FeModel model = model_of(GetParam(), true);
  const ModelResponse here = tangent_of(model, 0.02);
  const std::vector<double> q = displaced(model, 0.02);
  const Eigen::MatrixXd tangent = here.tangent;
  const double scale = tangent.cwiseAbs().maxCoeff();
  constexpr double step = 1.0e-5;
  ModelResponse more, less;
  for (int dof = 0; dof < model.dofs(); dof += 7) {
    std::vector<double> moved = q;
    moved[index(dof)] += step;
    ASSERT_TRUE(model.evaluate(moved, {}, Model::Want::force, more));
    moved[index(dof)] -= 2.0 * step;
    ASSERT_TRUE(model.evaluate(moved, {}, Model::Want::force, less));
    const Vector difference = (more.force - less.force) / (2.0 * step);
    // Central differences err by the square of the step over a cell's edge of a third, times what
    // the third derivative is of the first (about ten); and by rounding over the step.
    EXPECT_LT((difference - tangent.col(dof)).cwiseAbs().maxCoeff(), 1.0e-7 * scale) << dof;
  }
}

TEST_P(BatchedTangentsOf, AreTheSameBitsForAllThreads) {
  FeModel one = model_of(GetParam(), true), three = model_of(GetParam(), true, 3);
  const ModelResponse wanted = tangent_of(one, 0.02), found = tangent_of(three, 0.02);
  EXPECT_EQ((wanted.tangent - found.tangent).norm(), 0.0);
  EXPECT_EQ(wanted.force, found.force);
}

/// Cells that are answered for one by one.
TEST(CellAnswers, AreTheSameBitsForAllThreads) {
  for (const std::string element : {"hex20", "quad8", "hex8"}) {
    const BatchCase c{element, Formulation::full, "j2_plasticity"};
    FeModel one = model_of(c, false), three = model_of(c, false, 3);
    const ModelResponse wanted = tangent_of(one, 0.004), found = tangent_of(three, 0.004);
    EXPECT_EQ((wanted.tangent - found.tangent).norm(), 0.0);
    EXPECT_EQ(wanted.force, found.force);
    EXPECT_EQ(wanted.history, found.history);
    EXPECT_EQ(wanted.stored, found.stored);
    EXPECT_EQ(wanted.dissipation, found.dissipation);
  }
}

TEST(CellAnswers, TellOfCellsThatAreInsideOut) {
  for (const bool batched : {false, true}) {
    FeModel model = model_of({"hex8", Formulation::mean_dilatation, "neo_hookean"}, batched, 2);
    std::vector<double> q(index(model.dofs()), 0.0);
    q[index(model.dofs()) - 3] = -2.0;  // the last node past its neighbours
    ModelResponse out;
    EXPECT_FALSE(model.evaluate(q, {}, Model::Want::tangent, out)) << batched;
  }
}

TEST(StiffnessKernels, HaveTheSameBitsForEveryWidthOfRegisters) {
  constexpr int nodes = 8, points = 8, dim = 3;
  DrawTensors draw;
  std::vector<double> volume, gradient, displacement;
  for (int k = 0; k < points * batch_lanes; ++k) volume.push_back(draw.between(0.5, 1.0));
  for (int k = 0; k < points * nodes * dim * batch_lanes; ++k)
    gradient.push_back(draw.between(-1.0, 1.0));
  for (int k = 0; k < nodes * dim * batch_lanes; ++k)
    displacement.push_back(draw.between(-0.02, 0.02));
  BatchedParameters parameters;
  parameters.moduli = test_moduli;
  for (const BatchedLaw law : {BatchedLaw::saint_venant_kirchhoff, BatchedLaw::neo_hookean}) {
    for (const bool one_volume : {false, true}) {
      std::vector<std::vector<double>> found;
      for (const StiffnessKernels* kernels : {&stiffness_generic, &stiffness_here()}) {
        std::vector<double>& k = found.emplace_back(nodes * (nodes + 1) / 2 * dim * dim * 8);
        EXPECT_TRUE(kernels->of(law, dim, one_volume)(
            {nodes, points, volume.data(), gradient.data(), displacement.data(), k.data()},
            parameters));
      }
      EXPECT_EQ(found[0], found[1]);
    }
  }
}

/// A body whose surface has mass has no layer, and is asked for it all the same: by what answers
/// port kernels from rest.
TEST(LayerWithoutCells, AnswersWithNothing) {
  for (const char* law :
       {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean", "j2_plasticity"}) {
    for (const Model::Want want : {Model::Want::force, Model::Want::tangent}) {
      FeModel model = model_of({"hex8", Formulation::full, law}, true);
      const std::vector<double> history(model.history_size(), 0.0);
      LayerResponse out;
      EXPECT_TRUE(model.evaluate_layer(displaced(model, 0.0), history, want, out)) << law;
      EXPECT_EQ(out.force.size(), 0) << law;
    }
  }
}

}  // namespace
}  // namespace abut::fe_batched_tangents_tests
