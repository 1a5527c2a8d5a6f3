// Goal: bars held together by closed interfaces move as one bar of their total length.
// Oracle: the undivided bar, where the discretisations agree: plain central difference with kicks,
// whose two half contact nodes make one whole node.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/couple.hpp"
#include "coordinator/coupling/compare/parallel_force.hpp"
#include "coordinator/coupling/line_watch.hpp"
#include "coordinator/coupling/unilateral.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::undivided_problem_tests {
namespace {

constexpr int elements = 40;   // of each bar, 1 m and 1 kg each; wave speed 1 m/s
constexpr double blow = 0.01;  // [N s] on the left end

BarText piece(const std::string& name, int first, int bars, double step) {
  BarText bar =
      unit_bar(name, elements * bars, elements * bars, explicit_scheme(step), first * elements);
  bar.layer = "kick: {}";
  bar.sides = {"left", "right"};
  return bar;
}

constexpr double tolerance = 1.0e-10;  // of the iteration

/// Displacements of the outermost ends over time.
struct Ends {
  std::vector<double> left, right;
  double momentum = 0.0, energy = 0.0;
};

Ends undivided(int bars, double step, int steps) {
  const std::unique_ptr<Subdomain> body = build(piece("whole", 0, bars, step));
  Advance request = free_request(*body, 0.0, steps * step);
  request.boundary[0].impulse = {blow};
  Response response;
  EXPECT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
  return {response.ports[0].trace.u, response.ports[1].trace.u, response.records[0].momentum[0],
          response.records[0].energy.total()};
}

/// The same in pieces; `kinematic` is the kinematic side of each interface.
class Pieces {
 public:
  Pieces(const std::vector<int>& kinematic, double step, bool parallel) : step_(step) {
    const int count = static_cast<int>(kinematic.size()) + 1;
    std::vector<Subdomain*> pointers;
    for (int b = 0; b < count; ++b) {
      owned_.push_back(build(piece("b" + std::to_string(b), b, 1, step)));
      pointers.push_back(owned_.back().get());
    }
    bodies_ = std::make_unique<Bodies>(pointers);
    bodies_->prepare({0, 0.0, 0.0}, 1, Sampling::substeps);
    EXPECT_FALSE(bodies_->advance_all());
    for (std::size_t i = 0; i < kinematic.size(); ++i) {
      const int left = static_cast<int>(i);
      Joint& joint =
          joints_.emplace_back(make_joint("i", {Side{left, 1}, Side{left + 1, 0}}, *bodies_));
      joint.role.kinematic = kinematic[i];
      joint.watch = std::make_unique<SharedNodeWatch>();
      joint.engage(blow);
      if (parallel) {
        joint.exchange = std::make_unique<ParallelForce>();
      } else {
        joint.exchange = std::make_unique<Unilateral>();
      }
      joint.exchange->introduce(joint, *bodies_);
    }
    SchwarzSpec spec;
    spec.tolerance = tolerance;
    schwarz_ = std::make_unique<Schwarz>(make_schwarz(spec));
  }

  Ends run(int steps, int per_window) {
    Ends ends{{0.0}, {0.0}};
    for (int w = 0; w < steps / per_window; ++w) {
      const TimeWindow window{w, w * per_window * step_, (w + 1) * per_window * step_};
      bodies_->save_all();
      bodies_->prepare(window, 1, Sampling::substeps);
      if (w == 0) bodies_->request(0).boundary[0].impulse = {blow};
      const std::vector<Island> islands = find_islands(joints_, bodies_->count());
      const auto result = schwarz_->solve(window, islands[0], joints_, *bodies_);
      const SchwarzReport* report = std::get_if<SchwarzReport>(&result);
      EXPECT_TRUE(report != nullptr && report->converged);
      if (report != nullptr) iterations_ = std::max(iterations_, report->iterations);
      schwarz_->accept(islands[0]);
      for (Joint& joint : joints_)
        joint.contact.force_scale =
            std::max(joint.contact.force_scale, joint.watch->peak_force(joint, *bodies_));
      append(bodies_->response(0).ports[0].trace.u, ends.left);
      append(bodies_->response(bodies_->count() - 1).ports[1].trace.u, ends.right);
    }
    for (const Response& r : bodies_->responses()) {
      ends.momentum += r.records[0].momentum[0];
      ends.energy += r.records[0].energy.total();
    }
    return ends;
  }
  int iterations() const { return iterations_; }

 private:
  static void append(const std::vector<double>& from, std::vector<double>& to) {
    to.insert(to.end(), from.begin() + 1, from.end());
  }

  double step_;
  std::vector<std::unique_ptr<Subdomain>> owned_;
  std::unique_ptr<Bodies> bodies_;
  std::vector<Joint> joints_;
  std::unique_ptr<Schwarz> schwarz_;
  int iterations_ = 0;
};

constexpr int steps = 400;  // several reflections at both ends

void expect_same(const Ends& pieces, const Ends& whole, int windows) {
  // Mismatch of the tolerance x speed x step in every window, and the roundings of 400 steps, which
  // waves carry on; displacements are up to 0.1 m.
  const double error = iteration(tolerance * blow, windows) + roundoff(400 * 20, 0.1);
  EXPECT_LT(largest_difference(pieces.left, whole.left), error);
  EXPECT_LT(largest_difference(pieces.right, whole.right), error);
  EXPECT_NEAR(pieces.momentum, blow, error);
  EXPECT_GT(largest_size(whole.right), 1e-3);  // the wave has come through
}

TEST(UndividedProblem, TwoBarsInContactAreOneBar) {
  for (double step : {1.0, 0.9, 0.5}) {
    const Ends whole = undivided(2, step, steps);
    for (int per_window : {1, 10, 100}) {
      for (int kinematic : {0, 1}) {
        Pieces pieces({kinematic}, step, false);
        expect_same(pieces.run(steps, per_window), whole, steps / per_window);
        EXPECT_LE(pieces.iterations(), 3) << "a correction, at times one of its roundings, a check";
      }
    }
  }
}

TEST(UndividedProblem, BothFormsAreTheSameBar) {
  const Ends whole = undivided(2, 0.9, steps);
  for (int per_window : {1, 10, 100}) {
    Pieces pieces({0}, 0.9, true);
    expect_same(pieces.run(steps, per_window), whole, steps / per_window);
  }
}

TEST(UndividedProblem, ThreeBarsAreOneBarWhateverTheRoles) {
  const Ends whole = undivided(3, 0.9, steps);
  for (const std::vector<int>& kinematic :
       std::vector<std::vector<int>>{{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
    for (int per_window : {1, 10}) {
      Pieces pieces(kinematic, 0.9, false);
      expect_same(pieces.run(steps, per_window), whole, steps / per_window);
    }
  }
}

}  // namespace
}  // namespace abut::undivided_problem_tests
