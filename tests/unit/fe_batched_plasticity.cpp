// Goal: batches of cells of plastic bodies go through their histories as single cells do, whatever
// the element, the formulation and the number of cells; explicit steps of them keep energy.
// Oracles: cells one by one; the first law of thermodynamics; the same run again.

#include <cmath>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/highest_frequency.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_batched_plasticity_tests {
namespace {

struct Case {
  std::string element;
  Formulation formulation;
};

void PrintTo(const Case& c, std::ostream* out) {
  const char* names[] = {" full", " mean_dilatation", " one_point"};
  *out << c.element << names[static_cast<int>(c.formulation)];
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const char* element : {"hex8", "quad4", "tet4", "tri3"})
    for (const Formulation formulation :
         {Formulation::full, Formulation::mean_dilatation, Formulation::one_point})
      out.push_back({element, formulation});
  for (const char* element : {"tet10", "hex20"}) out.push_back({element, Formulation::full});
  return out;
}

/// Of neighbouring nodes, in edges of a cell.
double spacing(const std::string& element) { return element_named(element).order > 1 ? 0.5 : 1.0; }

/// `count` cubes or squares of side 1 in a row, distorted.
Mesh row(const std::string& element, int count) {
  Mesh mesh;
  if (element_named(element).dim == 2) {
    RectangleMesh m;
    m.lengths = {1.0 * count, 1.0};
    m.elements = {count, 1};
    m.element = element;
    mesh = generate(m, "test");
  } else {
    BoxMesh m;
    m.lengths = {1.0 * count, 1.0, 1.0};
    m.elements = {count, 1, 1};
    m.element = element;
    mesh = generate(m, "test");
  }
  DrawTensors draw;
  for (double& x : mesh.points) x += spacing(element) * draw.between(-0.1, 0.1);
  return mesh;
}

FeModel model_of(const Case& c, Mesh mesh, bool batched, int threads = 1) {
  FeOptions options;
  options.formulation = c.formulation;
  options.thickness = 0.7;
  options.batched = batched;
  options.threads = threads;
  return FeModel(std::move(mesh),
                 std::make_unique<J2Plasticity>(test_moduli, test_hardening(), 1.0), options);
}

class BatchedPlasticity : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, BatchedPlasticity, testing::ValuesIn(cases()));

TEST_P(BatchedPlasticity, HasTheHistoriesOfSingleCells) {
  for (const int count : {1, 2, 3, 4, 5, 6, 7, 8, 9, 17}) {
    SCOPED_TRACE(count);
    FeModel single = model_of(GetParam(), row(GetParam().element, count), false);
    FeModel batched = model_of(GetParam(), row(GetParam().element, count), true);
    ASSERT_EQ(single.batched(), nullptr);
    ASSERT_NE(batched.batched(), nullptr);
    DrawTensors draw;
    std::vector<double> q(index(single.dofs()), 0.0);
    std::vector<double> history(single.history_size(), 0.0);
    bool unloaded = false;
    for (int step = 0; step < 10; ++step) {
      // Back to where it was every third time.
      for (double& u : q)
        u = step % 3 == 2 ? 0.7 * u
                          : u + 0.03 * spacing(GetParam().element) * draw.between(-1.0, 1.0);
      ModelResponse a, b;
      ASSERT_TRUE(single.evaluate(q, history, Model::Want::force, a));
      ASSERT_TRUE(batched.evaluate(q, history, Model::Want::force, b));
      // Sums of some hundred roundings of stresses of order 1, and of C_p^-1, which is near I.
      EXPECT_LT((a.force - b.force).lpNorm<Eigen::Infinity>(), roundoff(200.0, 1.0));
      EXPECT_LT(largest_difference(a.history, b.history), roundoff(200.0, 1.0));
      const double scale = static_cast<double>(count);
      EXPECT_NEAR(a.stored, b.stored, roundoff(200.0, scale));
      EXPECT_NEAR(a.dissipation, b.dissipation, roundoff(200.0, scale));
      for (std::size_t k = 6; k < history.size(); k += 7)
        unloaded = unloaded || (history[k] > 0.0 && a.history[k] == history[k]);
      history = a.history;
    }
    EXPECT_TRUE(unloaded);
    EXPECT_GT(*std::max_element(history.begin(), history.end()), 0.005);  // it has flown
  }
}

/// A body that is stretched and sheared at once, and yields.
struct Flung {
  Flung(const Case& c, bool batched, int threads = 1)
      : mesh(row(c.element, 5)), model(model_of(c, Mesh(mesh), batched, threads)) {
    problem.model = &model;
    scheme = std::make_unique<ExplicitDynamics>(problem);
    motion.q.assign(index(model.dofs()), 0.0);
    motion.v.assign(motion.q.size(), 0.0);
    const std::size_t dim = index(mesh.dim);
    for (std::size_t n = 0; n < motion.v.size(); n += dim) {
      motion.v[n] = 0.05 * (mesh.points[n] - 2.5);
      motion.v[n + 1] = 0.05 * mesh.points[n + 1];
    }
    EXPECT_FALSE(scheme->begin(motion, 0.0));
  }
  double energy() const { return scheme->kinetic(motion) + motion.stored + motion.dissipated; }
  /// Largest change of energy, of the first.
  double advance(double end, int steps) {
    const double first = energy();
    double most = 0.0;
    for (int k = 0; k < steps; ++k) {
      EXPECT_FALSE(scheme->step(motion, end / steps * k, end / steps));
      most = std::max(most, std::abs(energy() - first));
    }
    return most / first;
  }

  Mesh mesh;
  FeModel model;
  Problem problem;
  std::unique_ptr<ExplicitDynamics> scheme;
  Motion motion;
};

TEST_P(BatchedPlasticity, ExplicitStepsKeepEnergy) {
  Flung coarse(GetParam(), true), fine(GetParam(), true);
  const double error = coarse.advance(4.0, 100), halved = fine.advance(4.0, 200);
  EXPECT_GT(fine.motion.dissipated, 0.1 * fine.energy());
  // Of second order where the flow is smooth; points that begin to yield within a step leave a
  // part of the third order of theirs.
  EXPECT_LT(error, 2.0e-3);
  EXPECT_LT(halved, 0.5 * error);
}

TEST_P(BatchedPlasticity, ARunIsTheSameBitsAgainAndWithThreads) {
  Flung first(GetParam(), true), again(GetParam(), true), threaded(GetParam(), true, 3);
  first.advance(4.0, 100);
  for (Flung* other : {&again, &threaded}) {
    other->advance(4.0, 100);
    EXPECT_EQ(first.motion.q, other->motion.q);
    EXPECT_EQ(first.motion.history, other->motion.history);
    EXPECT_EQ(first.motion.dissipated, other->motion.dissipated);
  }
}

TEST_P(BatchedPlasticity, ARunIsThatOfSingleCells) {
  Flung batched(GetParam(), true), single(GetParam(), false);
  batched.advance(4.0, 100);
  single.advance(4.0, 100);
  // Roundings of forces of order 1 on masses of 0.1, over 4^2/2 of time, which grow as the body
  // vibrates: some hundred of them.
  EXPECT_LT(largest_difference(batched.motion.q, single.motion.q), roundoff(1.0e5, 1.0));
  EXPECT_LT(largest_difference(batched.motion.history, single.motion.history),
            roundoff(1.0e5, 1.0));
}

/// The watch of the stable step bounds frequencies in the midst of flow, and closely.
TEST_P(BatchedPlasticity, FrequenciesHaveABoundThroughTheFlow) {
  Flung run(GetParam(), true);
  if (!run.model.batched()->bounds()) return;  // cells with mean dilatation: one by one
  HighestFrequency watch(run.model);
  for (int k = 0; k < 5; ++k) {
    run.advance(1.0, 25);
    using Effort = FrequencyWatch::Effort;
    const auto bound = watch.bound(run.motion.q, run.motion.history, 0.1, Effort::bounded);
    const auto exact = watch.bound(run.motion.q, run.motion.history, 0.1, Effort::exact);
    ASSERT_TRUE(bound && exact);
    EXPECT_GE(bound->square, exact->square * (1.0 - 1.0e-12));  // of eigenvalues
  }
}

}  // namespace
}  // namespace abut::fe_batched_plasticity_tests
