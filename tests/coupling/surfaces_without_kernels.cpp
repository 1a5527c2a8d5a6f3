// Goal: a contact whose port kernel finds no room converges by motion alone, to the same contact.
// Oracle: the run whose kernel finds room; the goals of 6 sweeps in the mean and 20 at most.

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::surfaces_without_kernels_tests {
namespace {

const std::string folder = ABUT_SOURCE_DIR "/configs/contact/";
const std::string no_room = "interfaces.impact.transmission={unilateral: {kernel_memory: 1.0e-6}}";

struct Shipped {
  std::string name;
  std::vector<std::string> smaller;  // in place of its own
  double same;                       // part of the impulse that the sweeps' tolerance leaves open
  std::string finder = {};           // empty: chosen
};

std::string mesh_of(const std::string& body, const std::string& kind, int core, int layers) {
  return fmt::format("bodies.{}.model.fe.mesh={{{}: {{radius: 0.5, core: {}, layers: {}}}}}", body,
                     kind, core, layers);
}

std::vector<Shipped> shipped_scenes() {
  // Longer windows than the scenes' own in the last rows: 8 substeps and 20.
  const std::vector<std::string> balls = {mesh_of("left", "sphere", 4, 3),
                                          mesh_of("right", "sphere", 4, 2)};
  const std::string doubled = "integrator={central_difference: {step: 6.0e-6}}";
  const std::vector<std::string> disks = {mesh_of("left", "disk", 6, 3),
                                          mesh_of("right", "disk", 4, 3), "bodies.left." + doubled,
                                          "bodies.right." + doubled, "time.window=3.0e-5"};
  const auto with = [](std::vector<std::string> all, const std::string& more) {
    all.push_back(more);
    return all;
  };
  // Their surfaces are alike, so that names would choose. In windows of 24 substeps sweeps are 5.8
  // where this one finds the contact, and 7.5 where the other does, of three layers of cells.
  const std::string thinner = "interfaces.impact.transmission.unilateral.kinematic=right.skin";
  return {{"balls", balls, 1.0e-5},
          {"disks_oblique", disks, 1.0e-3},
          {"disks_head_on", disks, 1.0e-3},
          {"bars_2d", {}, 1.0e-5},
          {"bars_2d_implicit", {}, 1.0e-5},
          {"balls", with(balls, "time.window=9.6e-5"), 1.0e-5, thinner},
          {"bars_2d", with({}, "time.window=2.5e-4"), 1.0e-5}};
}

void expect_goals(const RunResult& run, const std::string& what) {
  ASSERT_TRUE(run.completed()) << what;
  EXPECT_LE(run.measure("schwarz.iterations_mean"), 6.0) << what;
  EXPECT_LE(run.measure("schwarz.iterations_max"), 20.0) << what;
  EXPECT_LE(run.measure("momentum.total"), 1.0e-11) << what;  // in every iterate
}

TEST(NoRoomForKernels, ContactConvergesToTheSame) {
  for (const Shipped& scene : shipped_scenes()) {
    std::vector<std::string> overrides = scene.smaller;
    overrides.push_back("meta.expect=[]");
    if (!scene.finder.empty()) overrides.push_back(scene.finder);
    const auto usual = run_file(folder + scene.name + ".yaml", overrides);
    overrides.push_back(no_room);
    if (!scene.finder.empty()) overrides.push_back(scene.finder);
    const auto alone = run_file(folder + scene.name + ".yaml", overrides);
    ASSERT_TRUE(usual->completed()) << scene.name;
    expect_goals(*alone, scene.name);
    const double impulse = usual->measure("contact.impact.impulse");
    EXPECT_NEAR(alone->measure("contact.impact.impulse"), impulse, scene.same * impulse)
        << scene.name;
    // Of the same goal as with kernels: what meshes of this size leave.
    EXPECT_NEAR(alone->measure("energy.total.relative_drift_end"),
                usual->measure("energy.total.relative_drift_end"), scene.same)
        << scene.name;
  }
}

TEST(NoRoomForKernels, ContactConvergesWhicheverSideIsSofter) {
  // The finer mesh finds the contact, whatever it is made of: of stiff bodies that find soft ones
  // the plain iteration grows by the ratio in every sweep, so that all depends on the first factor.
  for (const std::string body : {"left", "right"}) {
    for (const double modulus : {1.0e7, 1.0e8, 1.0e10, 1.0e11}) {
      const std::string what =
          fmt::format("bodies.{}.material.linear_elastic.youngs_modulus={}", body, modulus);
      const auto run =
          run_file(folder + "bars_2d_implicit.yaml", {"meta.expect=[]", what, no_room});
      expect_goals(*run, what);
    }
  }
}

}  // namespace
}  // namespace abut::surfaces_without_kernels_tests
