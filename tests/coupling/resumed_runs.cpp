// Goal: the state lists are complete: a run that goes on from its state at any window, with a new
// coordinator and new bodies, ends as the uninterrupted one. Oracle: the hashes of the bodies at
// the end, bit for bit, of a scene of every kind of joint.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::resumed_runs_tests {
namespace {

/// The state of a whole run between two windows.
struct Kept {
  std::vector<std::byte> run;
  std::vector<std::vector<std::byte>> bodies;
};

/// A run of its own, with its own bodies.
class Whole {
 public:
  explicit Whole(const Document& document)
      : scene_(read_scene(document)), bodies_(launch_local(scene_, document)) {
    std::vector<Subdomain*> pointers;
    for (const std::unique_ptr<Subdomain>& body : bodies_) pointers.push_back(body.get());
    controller_ = std::make_unique<Controller>(scene_, pointers, std::vector<Observer*>{});
  }
  Kept keep() {
    Kept kept{controller_->save(), {}};
    for (const std::unique_ptr<Subdomain>& body : bodies_)
      kept.bodies.push_back(body->checkpoint());
    return kept;
  }
  RunEnd run(const std::function<void()>& between = {}) {
    controller_->between_windows = [between](const Pause& pause) {
      if (between && !pause.last) between();
    };
    return controller_->run();
  }
  RunEnd run_from(const Kept& kept) {
    controller_->load(kept.run);
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b]->resume(kept.bodies[b]);
    return controller_->run();
  }

 private:
  Scene scene_;
  std::vector<std::unique_ptr<Subdomain>> bodies_;
  std::unique_ptr<Controller> controller_;
};

struct Cut {
  std::string scene;
  int every = 1;  // windows between states that are kept; odd, so that all stages are met
  std::vector<std::string> overrides = {};
};

/// All of the coordinator's state but one number: exchanges, as kernels are asked for again.
bool alike(const std::vector<std::byte>& one, const std::vector<std::byte>& other) {
  if (one.size() != other.size()) return false;
  const auto first = std::mismatch(one.begin(), one.end(), other.begin()).first;
  const auto last = std::mismatch(one.rbegin(), one.rend(), other.rbegin()).first.base();
  return first == one.end() || last - first <= static_cast<std::ptrdiff_t>(sizeof(std::int64_t));
}

/// Kept at windows so many apart, and gone on with from each of them.
void expect_the_same(const Document& document, int every, std::int64_t unanswered = 0) {
  std::vector<Kept> kept;
  Whole whole(document);
  int window = 0;
  const RunEnd end = whole.run([&] {
    if (window++ % every == 0) kept.push_back(whole.keep());
  });
  ASSERT_EQ(end.status, "completed") << end.reason;
  ASSERT_GE(end.given_up.unanswered, unanswered);
  ASSERT_GT(kept.size(), 3u);  // else the scene is cut nowhere
  for (std::size_t k = 0; k < kept.size(); ++k) {
    Whole other(document);
    const RunEnd resumed = other.run_from(kept[k]);
    ASSERT_EQ(resumed.status, "completed") << resumed.reason;
    ASSERT_EQ(resumed.body_hashes, end.body_hashes) << "window " << k * every;
    ASSERT_EQ(resumed.state_hash, end.state_hash) << "window " << k * every;
    ASSERT_TRUE(alike(other.keep().run, whole.keep().run)) << "window " << k * every;
  }
}

class ResumedRuns : public testing::TestWithParam<Cut> {};

TEST_P(ResumedRuns, EndAsTheUninterruptedOne) {
  const Cut& cut = GetParam();
  const std::string path = std::string(ABUT_SOURCE_DIR) + "/configs/" + cut.scene + ".yaml";
  expect_the_same(Document::load(path, cut.overrides), cut.every);
}

/// Disks of few cells that go passively, fly apart and go passively again: what the first time left
/// behind counts for nothing.
TEST(ResumedRuns, BetweenPassiveTimesEndAsTheUninterruptedOne) {
  expect_the_same(Document::from_text("test", R"(time: {end: 0.14, window: 2.0e-4}
bodies:
  ball:
    copies: {grid: {count: [3, 2], spacing: [0.25, 0.25]}}
    model: {fe: {dimension: 2, mesh: {disk: {radius: 0.1, core: 2, layers: 2}}}}
    material: {neo_hookean: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000}}
    integrator: {central_difference: {step: 2.0e-4}}
    body_force: [0, -9.81]
    initial: {position: [0, 0.12], velocity: [0.0, -2.0]}
    ports: {skin: mantle}
  floor:
    model: {rigid_tool: {dimension: 2, mesh: {rectangle: {lengths: [2, 0.1], elements: [1, 1]}}}}
    initial: {position: [-0.5, -0.1]}
    ports: {top: top}
contact: {everything: {friction: 0.3}}
)"),
                  71, 2);
}

TEST(ResumedRuns, RefuseTheStateOfAnotherScene) {
  const std::string folder = std::string(ABUT_SOURCE_DIR) + "/configs/";
  Whole bars(Document::load(folder + "two_bars.yaml", {}));
  const Kept kept = bars.keep();
  const Document other = Document::load(folder + "bars/bouncing_bar.yaml", {});
  EXPECT_THROW(Whole(other).run_from(kept), RunError);
}

std::vector<Cut> cuts();
std::string name_of(const testing::TestParamInfo<Cut>& info) {
  std::string name = info.param.scene;
  for (char& c : name)
    if (c == '/' || c == '.') c = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(Coupling, ResumedRuns, testing::ValuesIn(cuts()), name_of);

std::vector<Cut> cuts() {
  return {
      {"two_bars", 7},
      {"two_bars_implicit", 7},
      {"two_bars_parallel", 7},
      {"bars/bouncing_bar", 1901},
      {"bars/cradle_five", 17},
      {"bars/finite_strain_bars_collide", 7},
      {"bars/hit_from_both_sides", 11},
      {"bars/impact_inside_window", 1},
      {"bars/plastic_bar_meets_a_wall", 7},
      {"bars/pressed_bar", 41},
      {"bars/solid_meets_bar", 9},
      {"bars/steps_three_to_two", 5},
      {"bars/subcycling", 5},
      {"bars/three_bars_with_gap", 13},
      {"bars/tied_graded_halves", 9},
      {"bars/wall_bounce_coarse", 301},
      {"methods/lagrange_explicit", 101},
      {"methods/schwarz_published_ee", 1301},
      {"methods/schwarz_published_ii", 301},
      {"methods/schwarz_projection_ii", 301},
      {"methods/schwarz_recommended_ii", 17},
      {"methods/schwarz_robin_kick_ee", 1301},
      {"methods/schwarz_robin_massless_ee", 1301},
      {"contact/ball_in_corner", 21},
      {"contact/ball_on_wall", 5},
      {"contact/balls", 91},
      {"contact/bars_2d", 23},
      {"contact/bars_2d_implicit", 13},
      // 100 rows that rub, one after the other, and a kernel of near points
      {"contact/bars_3d",
       5,
       {"meta.expect=[]", "output={}", "time.end=5.0e-4",
        "interfaces.impact.contact={friction: 0.3}",
        "interfaces.impact.transmission={unilateral: {kernel_memory: 0.5}}",
        "bodies.left.initial={position: [-0.2, 0.0, 0.0], velocity: [10.0, 3.0, 0.0]}",
        "bodies.left.model.fe.mesh={box: {lengths: [0.2, 0.2, 0.2], elements: [8, 8, 8]}}",
        "bodies.right.model.fe.mesh={box: {lengths: [0.2, 0.2, 0.2], elements: [9, 9, 9]}}"}},
      {"contact/belt_stick_slip", 401},
      {"contact/block_slides_and_stops", 71},
      {"contact/bolted_joint_slips", 31},
      {"contact/cattaneo_mindlin", 1},
      {"contact/cradle_bricks", 91},
      {"contact/disk_on_wall", 21},
      {"contact/edges_cross", 17},
      {"contact/incline", 61},
      {"contact/ladder_contact", 31},
      // rigid bodies: an impact goes on over some steps
      {"contact/rigid_ball_bounces",
       1,
       {"meta.expect=[]", "time.end=0.0118", "bodies.ball.initial.position=[0.0, 0.0, 0.1005]"}},
      {"contact/sphere_impact", 5},
      {"contact/stack_of_ten", 61},
      {"joined/block_in_four_rests", 31},
      {"joined/blocks_2x2x2", 7},
      {"joined/cantilever_split", 31},
      {"joined/notched_specimen", 133},
      {"joined/plate_with_insert", 7},
      {"joined/row_of_eight", 1},
      {"joined/torsion_multi_scale", 61},
      {"joined/weld_overlap", 3},
      {"robust/dominoes", 61},
      {"robust/falling_plates", 301},
      {"robust/one_cell_each", 71},
  };
}

}  // namespace
}  // namespace abut::resumed_runs_tests
