// Goal: modal bodies that supports hold have contact, passively, and tell what their supports bear.
// Oracles: the same beam of finite elements; balance of momentum; energy.

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::passive_modes_tests {
namespace {

/// Momentum of the beam, what its support bears and what presses on it, along y, by window.
struct Balance : Observer {
  void on_window(const WindowReport& report) override {
    const BodyRecord& record = report.responses[0].records.back();
    momentum.push_back(record.momentum[1]);
    bears.push_back(record.columns[1]);
    const Waveform& trace = report.responses[0].ports[0].trace;
    double sum = 0.0;
    const std::size_t width = index(trace.width);
    for (std::size_t k = 1; k < width; k += 2) sum += trace.f[trace.f.size() - width + k];
    pressed.push_back(sum);
    passive.push_back(trace.support == ForceSupport::step);
  }
  std::vector<double> momentum, bears, pressed;
  std::vector<char> passive;
};

constexpr double step = 2.0e-4;

/// A cantilever is struck near its end, by `what`.
ResultPtr struck(const std::string& model, const std::string& keys, const SolidText& what,
                 Balance* balance) {
  const SolidText beam{
      .name = "beam",
      .material = "linear_elastic: {youngs_modulus: 2.0e9, poissons_ratio: 0.3, density: 1200.0}",
      .integrator = "newmark: {step: " + number(step) + "}",
      .port = "sole",
      .side = "bottom",
      .model = model,
      .keys = keys,
      .more = "    constraints: {root: {on: left, fixed: true}}\n",
      .block = block_in(2, {0.2, 0.01}, {20, 2})};
  return run_text(scene_text(0.02, step, texts_of({beam, what}),
                             "interfaces:\n  hit: {sides: [beam.sole, hammer.top], contact: {}}\n"),
                  balance);
}

SolidText hammer(const std::string& model) {
  SolidText out{
      .name = "hammer",
      .material = "linear_elastic: {youngs_modulus: 2.0e9, poissons_ratio: 0.3, density: 1200.0}",
      .integrator = model == "rigid" ? "rigid_motion: {step: " + number(step) + "}"
                                     : "newmark: {step: " + number(step) + "}",
      .position = {0.15, -0.0102},
      .velocity = {0.0, 0.1},
      .port = "top",
      .side = "top",
      .model = model,
      .block = block_in(2, {0.03, 0.01}, {6, 4})};
  return out;
}

/// Steps over 0.02 s; twenty modes have what the beam does in them.
TEST(PassiveModes, OfAHeldBeamMeetWhatTheBeamMeets) {
  for (const std::string partner : {"fe", "rigid"}) {
    SCOPED_TRACE(partner);
    Balance balance;
    const auto modes = struck("modal", "modes: 20, ", hammer(partner), &balance);
    const auto cells = struck("fe", "", hammer(partner), nullptr);
    ASSERT_TRUE(modes->completed()) << modes->end.reason;
    ASSERT_TRUE(cells->completed()) << cells->end.reason;
    EXPECT_GT(modes->end.given_up.windows, 0);
    // Accurate contact of elements loses what a step's length loses.
    EXPECT_NEAR(modes->measure("contact.hit.impulse"), cells->measure("contact.hit.impulse"),
                0.05 * cells->measure("contact.hit.impulse"));
    double most = 0.0, error = 0.0;
    int compared = 0;  // passive windows of one step
    for (std::size_t k = 1; k < balance.momentum.size(); ++k) {
      const double change = (balance.momentum[k] - balance.momentum[k - 1]) / step;
      most = std::max(most, std::abs(balance.bears[k]));
      const double length = modes->rows[k].time - modes->rows[k - 1].time;
      if (balance.passive[k] == 0 || length > 1.001 * step) continue;
      printf("W %g dP/h %.6g bears %.6g pressed %.6g\n", modes->rows[k].time, change,
             balance.bears[k], balance.pressed[k]);
      ++compared;
      error = std::max(error, std::abs(change - balance.bears[k] - balance.pressed[k]));
    }
    EXPECT_GT(compared, 4);
    EXPECT_GT(most, 1.0);
    // Of sums of ten-thousand products, by modes that are found to 1e-10.
    EXPECT_LT(error, 1.0e-8 * most);
  }
}

}  // namespace
}  // namespace abut::passive_modes_tests
