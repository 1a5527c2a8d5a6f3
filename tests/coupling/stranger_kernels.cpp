// Goal: contact with a surface of somebody else, who tells its kernel for forces that are constant
// in its substeps, whatever these are: it is taken, and saves iterations. Oracles: momentum and
// energy, which nothing else changes; the same run without the kernel; for ties the words.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/runs.hpp"

namespace abut::stranger_kernels_tests {
namespace {

constexpr double mass = 30.0;    // [kg]
constexpr double step = 1.0e-6;  // [s] of the block

/// A rigid block in the plane that turns nowhere. A force is constant in each of its substeps.
class Stranger final : public Subdomain {
 public:
  Stranger(double own_step, ForceSupport support, bool tells) : tells_(support) {
    description_.name = "stranger";
    description_.model = "rigid, of another program";
    description_.dim = 2;
    description_.dofs = 2;
    description_.mass = mass;
    description_.step = own_step;
    description_.stable_step = std::numeric_limits<double>::infinity();
    description_.conserves = description_.linear = true;
    description_.can.force = true;
    description_.can.kernel = tells;
    Port face;
    face.name = "face";
    face.geometry.dim = 2;
    face.geometry.points = {1.0e-5, 0.1, 1.0e-5, 0.0};
    face.geometry.normals = {-1.0, 0.0, -1.0, 0.0};
    face.geometry.facets = {0, 1};
    face.geometry.offsets = {0, 2};
    face.geometry.spacing = 0.1;
    description_.ports.push_back(face);
  }

  const Description& describe() const override { return description_; }
  void meet(const Meeting&) override {}
  void save() override { saved_ = state_; }
  void restore() override { state_ = saved_; }
  void start(const Advance& request) override { request_ = &request; }

  [[nodiscard]] Outcome finish(Response& response) override {
    const Advance& asked = *request_;
    const Substeps grid = Substeps::divide(asked.window, description_.step, asked.records);
    response = {};
    PortResponse& port = response.ports.emplace_back();
    port.trace.width = 4;
    port.trace.support = ForceSupport::step;
    tell(grid.begin, {}, port.trace);
    const int per_record = std::max(1, grid.count / asked.records);
    Box box = box_here();
    for (int i = 1; i <= grid.count; ++i) {
      const std::array<double, 2> impulse = impulse_in(grid.time(i - 1), grid.time(i));
      const double h = grid.time(i) - grid.time(i - 1);
      for (const std::size_t c : {0u, 1u}) {
        const double before = state_.v[c];
        state_.v[c] += impulse[c] / mass;
        state_.u[c] += 0.5 * h * (before + state_.v[c]);
        port.work += impulse[c] * 0.5 * (before + state_.v[c]);
      }
      widen(box);
      const bool due = i % per_record == 0;
      if (asked.sampling == Sampling::substeps || due)
        tell(grid.time(i), {impulse[0] / h, impulse[1] / h}, port.trace);
      if (due) record(grid.time(i), std::exchange(box, box_here()), port, response);
    }
    while (response.records.size() < index(asked.records))  // a window of no length
      record(grid.end, box, port, response);
    port.speed_bound = std::hypot(state_.v[0], state_.v[1]);
    response.steps = grid.count;
    return Advanced{};
  }

  PortKernel probe(const Probing& asked) override {
    const auto& [port, patterns, h, count, seen] = asked;
    PortKernel kernel;
    kernel.step = h;
    kernel.support = tells_;
    kernel.width = 4;
    kernel.patterns = static_cast<int>(patterns.size() / 4);
    for (int i = 0; i < count; ++i)
      for (std::size_t p = 0; p < patterns.size(); p += 4)
        for (const std::size_t c : {0u, 1u, 2u, 3u})
          kernel.displacement.push_back((patterns[p + c % 2] + patterns[p + 2 + c % 2]) * h * h *
                                        (i + 0.5) / mass);
    return kernel;
  }
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte>) override {}
  std::uint64_t state_hash() override { return 0; }

 private:
  using Box = std::array<double, 4>;  // lower, upper
  struct State {
    std::array<double, 2> u = {0.0, 0.0}, v = {-2.0, 0.0};
  };

  Box box_here() const {
    const double x = 1.0e-5 + state_.u[0], y = state_.u[1];
    return {x, y, x, y + 0.1};
  }
  void widen(Box& box) const {
    const Box now = box_here();
    for (const std::size_t c : {0u, 1u}) {
      box[c] = std::min(box[c], now[c]);
      box[c + 2] = std::max(box[c + 2], now[c + 2]);
    }
  }
  std::array<double, 2> impulse_in(double from, double to) const {
    std::array<double, 2> sum = {0.0, 0.0};
    for (const Waveform& force : request_->boundary[0].forces) {
      if (force.empty()) continue;
      std::vector<double> part(index(force.width));
      force.impulse(from, to, part);
      for (std::size_t k = 0; k < part.size(); ++k) sum[k % 2] += part[k];
    }
    return sum;
  }
  void tell(double time, const std::array<double, 2>& force, Waveform& to) const {
    to.time.push_back(time);
    for (const std::size_t c : {0u, 1u, 0u, 1u}) {
      to.u.push_back(state_.u[c]);
      to.v.push_back(state_.v[c]);
      to.a.push_back(force[c] / mass);
      to.f.push_back(0.5 * force[c]);
    }
  }
  void record(double time, const Box& box, PortResponse& port, Response& response) const {
    port.lower.insert(port.lower.end(), box.begin(), box.begin() + 2);
    port.upper.insert(port.upper.end(), box.begin() + 2, box.end());
    BodyRecord& record = response.records.emplace_back();
    record.time = time;
    const auto& v = state_.v;
    record.energy.kinetic = 0.5 * mass * (v[0] * v[0] + v[1] * v[1]);
    record.momentum = {mass * v[0], mass * v[1]};
  }

  ForceSupport tells_;
  Description description_;
  State state_, saved_;
  const Advance* request_ = nullptr;
};

std::string text(const std::string& way) {
  const SolidText block{.name = "block",
                        .material =
                            "linear_elastic: {youngs_modulus: 2.1e10, poissons_ratio: 0.0, "
                            "density: 7800.0}",
                        .integrator = implicit_scheme("newmark", step),
                        .position = {-0.1},
                        .sides = {"right"},
                        .block = {{0.1, 0.1}, {4, 4}}};
  return scene_text(
      3.0e-4, 6.0e-6, block.text() + "  stranger: {model: {external: {}}, launch: {connect: {}}}\n",
      fmt::format("network: {{endpoint: \"tcp://127.0.0.1:5555\"}}\n"
                  "interfaces: {{hit: {{sides: [block.right, stranger.face], {}: {{}}}}}}\n"
                  "schwarz: {{tolerance: 1.0e-8, max_iterations: 100}}\n",
                  way));
}

ResultPtr run_with(Stranger& stranger, const std::string& way = "contact") {
  const Document document = Document::from_text("test", text(way));
  const Scene scene = read_scene(document);
  const std::vector<std::unique_ptr<Subdomain>> here = launch_local(scene, document);
  auto result = std::make_unique<RunResult>();
  Controller(scene, {here[0].get(), &stranger}, {result.get()}).run();
  return result;
}

int most_sweeps(const RunResult& run) {
  int most = 0;
  for (const RunResult::Row& row : run.rows) most = std::max(most, row.iterations);
  return most;
}

class StrangerKernel : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Steps, StrangerKernel,
                         testing::Values(step, 0.5 * step, 2.0 * step, 3.0 * step, 6.0 * step));

TEST_P(StrangerKernel, ForSubstepsIsTakenAndSavesIterations) {
  Stranger with(GetParam(), ForceSupport::step, true);
  Stranger without(GetParam(), ForceSupport::step, false);
  const auto run = run_with(with), slow = run_with(without);
  ASSERT_TRUE(run->completed() && slow->completed());
  EXPECT_GT(run->velocity(1), 0.0);  // thrown back
  // Impulses are taken as they are given: rounding of some hundred sums.
  EXPECT_LT(run->momentum_error(), 1.0e-12);
  for (std::size_t r = 0; r < run->rows.size(); ++r)
    // Both converge to one motion, to some tolerances of 1e-8 of the step's way.
    EXPECT_NEAR(run->rows[r].u[1], slow->rows[r].u[1], 1.0e-6 * 2.0 * 3.0e-4) << r;
  EXPECT_LT(most_sweeps(*run), most_sweeps(*slow));
  if (GetParam() == step) {
    EXPECT_LE(most_sweeps(*run), 2);  // what is linear and exact needs no more
  }
}

TEST(StrangerTie, WhoseKernelIsForOtherForcesIsRefusedByNames) {
  Stranger stranger(step, ForceSupport::nodal, true);
  try {
    run_with(stranger, "tied");
    FAIL() << "no error";
  } catch (const RunError& error) {
    EXPECT_EQ(error.what_is_wrong,
              "stranger.face is tied to block.right, by forces that are constant in substeps, but "
              "tells its port kernel for others (NODAL, where STEP belongs)");
  }
}

}  // namespace
}  // namespace abut::stranger_kernels_tests
