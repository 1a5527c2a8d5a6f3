// Goal: the work of a static step is looked for no further than roundings let it be known. Oracle:
// a body that its supports carry along has no forces, and no work is done on it.

#include <gtest/gtest.h>

#include "subdomain_solver/materials/neo_hookean.hpp"
#include "tests/support/solid_runs.hpp"

namespace abut::time_work_of_statics_tests {
namespace {

/// A model that counts how often it is asked.
class Counted final : public Model {
 public:
  explicit Counted(Model& of) : of_(of) {}
  int dofs() const override { return of_.dofs(); }
  bool is_linear() const override { return of_.is_linear(); }
  std::size_t history_size() const override { return of_.history_size(); }
  const SparseMatrix& mass() const override { return of_.mass(); }
  const Vector& lumped_mass() const override { return of_.lumped_mass(); }
  double roundoff(std::span<const double> q) const override { return of_.roundoff(q); }
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out) override {
    ++count;
    return of_.evaluate(q, history, want, out);
  }
  int count = 0;

 private:
  Model& of_;
};

TEST(WorkOfStatics, OfABodyThatIsCarriedCostsLittle) {
  Solid solid(unit_mesh("tri6", 4), std::make_unique<NeoHookean>(isotropic(1.0e3, 0.3), 1.0));
  solid.prescribe("bottom", 0, [](const Position&, double time) { return 0.3 * time; });
  solid.prescribe("bottom", 1, [](const Position&, double time) { return -0.7 * time; });
  Counted counted(solid.model);
  solid.problem.model = &counted;
  QuasiStatic run(solid.problem, {NewtonOptions{}, 8}, make_direct_solver());
  ASSERT_FALSE(run.begin(solid.motion, 0.0));
  for (int k = 0; k < 4; ++k) {
    counted.count = 0;
    ASSERT_FALSE(run.step(solid.motion, k, 1.0)) << k;
    EXPECT_LT(counted.count, 20) << k;  // corrections, places of the way; once 8000
  }
  EXPECT_NEAR(solid.motion.external_work, 0.0, 1.0e-9);  // [J] of 1e3 Pa m^2: roundings
}

}  // namespace
}  // namespace abut::time_work_of_statics_tests
