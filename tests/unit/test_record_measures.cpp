// Goal: measures say what the run did. Oracle: runs made by hand from the exact solution with a
// known error put in, so that every measure follows by mental arithmetic.
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/record/measure_recorder.hpp"
#include "tests/unit/record_run.hpp"

namespace abut::test_record_measures {
namespace {

// Sums of some hundred numbers of size 1.
constexpr double roundoff = 1e-13;

double measure(const MeasureRecorder& recorder, const std::string& name) {
  const std::map<std::string, double>& values = recorder.measures().values;
  EXPECT_TRUE(values.contains(name)) << name;
  return values.contains(name) ? values.at(name) : std::nan("");
}

TEST(Measures, ExactRunHasNoErrors) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  run.play(recorder);
  const std::vector<std::pair<std::string, double>> expected = {
      {"contact.impact.begin", 0.1},
      {"contact.impact.end", 2.1},
      {"contact.impact.duration", 2.0},
      {"contact.impact.count", 1.0},
      {"contact.impact.impulse", 2.0},
      {"contact.impact.force_mean", 1.0},
      {"contact.impact.force_peak", 1.0},
      {"contact.impact.force_max_error", 0.0},
      {"contact.impact.force_rms_error", 0.0},
      {"contact.impact.force_rms_error_tail", 0.0},
      {"contact.impact.begin_error", 0.0},
      {"contact.impact.release_error", 0.0},
      {"contact.impact.velocity_rms_error", 0.0},
      {"contact.impact.gap_min", 0.0},
      {"energy.left.relative_error_max", 0.0},
      {"energy.right.relative_error_end", 0.0},
      {"energy.total.relative_drift_max", 0.0},
      {"momentum.total", 0.0},
      {"momentum.left.end", -1.0},
      {"mean_velocity.right.end", 1.0},
      {"position.left.tip.max", 0.0},
      {"schwarz.iterations_mean", 2.0},
      {"schwarz.iterations_max", 2.0},
      {"exchanges", 142.0},
      {"windows", 30.0},
      {"contact_windows", 20.0}};
  for (const auto& [name, value] : expected)
    EXPECT_NEAR(measure(recorder, name), value, roundoff) << name;
  EXPECT_EQ(recorder.non_finite(), "");
}

TEST(Measures, ReportedNamesAreTheKnownNames) {
  for (const bool with_form : {false, true}) {
    HandMadeRun run;
    MeasureRecorder recorder(with_form ? &run.form : nullptr);
    run.play(recorder);
    std::vector<std::string> reported;
    for (const auto& [name, value] : recorder.measures().values) reported.push_back(name);
    MeasureScope scope;
    scope.bodies = {"left", "right"};
    scope.ports = {"left.tip", "right.tip"};
    scope.interfaces = {"impact"};
    if (with_form) scope.exact = {"impact"};
    EXPECT_EQ(reported, known_measures(scope));
  }
}

TEST(Measures, AlternatingForceErrorIsItsRootMeanSquareInBothSupports) {
  for (const ForceSupport support : {ForceSupport::step, ForceSupport::nodal}) {
    HandMadeRun run;
    run.support = support;
    MeasureRecorder recorder(&run.form);
    // 28 % up and down from one substep (0.05 s) to the next. The half percent keeps times of one
    // substep together.
    run.f = [](int side, double time) {
      const int substep = static_cast<int>(std::floor(time / 0.05 + 0.005));
      const double p = substep % 2 == 0 ? 1.28 : 0.72;
      return side == 0 ? -p : p;
    };
    run.play(recorder);
    // 5 to 95 % are 0.2 s to 2.0 s: whole substeps.
    EXPECT_NEAR(measure(recorder, "contact.impact.force_rms_error"), 0.28, roundoff);
    EXPECT_NEAR(measure(recorder, "contact.impact.force_max_error"), 0.28, roundoff);
    EXPECT_NEAR(measure(recorder, "contact.impact.force_peak"), 1.28, roundoff);
  }
}

TEST(Measures, TimeWithoutContactCountsAsWholeForceError) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  recorder.on_start(run.start);
  run.event(recorder, RunEvent::Kind::contact_closed, 0.1);
  run.window(recorder, 0.1, 1.1, true, 2);
  run.event(recorder, RunEvent::Kind::contact_opened, 1.1);
  run.f = [](int, double) { return 0.0; };
  run.window(recorder, 1.1, 3.0, false);
  recorder.on_end(run.end());
  // Half of [0.2, 2.0] lacks all of the force.
  EXPECT_NEAR(measure(recorder, "contact.impact.force_rms_error"), std::sqrt(0.5), roundoff);
  EXPECT_NEAR(measure(recorder, "contact.impact.force_max_error"), 1.0, roundoff);
  EXPECT_NEAR(measure(recorder, "contact.impact.release_error"), -0.5, roundoff);
  EXPECT_NEAR(measure(recorder, "contact.impact.impulse"), 1.0, roundoff);
}

TEST(Measures, HalfForceTimeIsInterpolatedInAFallingForce) {
  HandMadeRun run;
  run.support = ForceSupport::nodal;
  MeasureRecorder recorder(&run.form);
  // Full until 2.0, then linear to zero at 2.2: half at the exact release, 2.1.
  run.f = [](int side, double time) {
    const double p = time <= 2.0 ? 1.0 : std::max(0.0, (2.2 - time) / 0.2);
    return side == 0 ? -p : p;
  };
  recorder.on_start(run.start);
  run.event(recorder, RunEvent::Kind::contact_closed, 0.1);
  for (int k = 1; k < 22; ++k) run.window(recorder, 0.1 * k, 0.1 * (k + 1), true, 1);
  run.event(recorder, RunEvent::Kind::contact_opened, 2.2);
  run.window(recorder, 2.2, 3.0, false);
  recorder.on_end(run.end());
  EXPECT_NEAR(measure(recorder, "contact.impact.release_error_half_force"), 0.0, roundoff);
  EXPECT_NEAR(measure(recorder, "contact.impact.release_error"), 0.05, roundoff);
}

TEST(Measures, ForceCutAtFullHeightFallsThroughHalfWithinTheNextSubstep) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  run.play(recorder);
  // Last sample at the middle of the last substep, 2.075; gone one substep (0.05) later; half way
  // is 2.1.
  EXPECT_NEAR(measure(recorder, "contact.impact.release_error_half_force"), 0.0, roundoff);
}

TEST(Measures, SecondContactIsCountedAndEndsTheContact) {
  HandMadeRun run;
  MeasureRecorder recorder(nullptr);
  run.f = [](int side, double time) {
    const double p = time < 0.3 || (time > 0.4 && time < 0.6) ? 1.0 : 0.0;
    return side == 0 ? -p : p;
  };
  recorder.on_start(run.start);
  run.event(recorder, RunEvent::Kind::contact_closed, 0.1);
  run.window(recorder, 0.1, 0.3, true, 2);
  run.event(recorder, RunEvent::Kind::contact_opened, 0.3);
  run.window(recorder, 0.3, 0.4, false);
  run.event(recorder, RunEvent::Kind::contact_closed, 0.4);
  run.window(recorder, 0.4, 0.6, true, 5);
  run.event(recorder, RunEvent::Kind::contact_opened, 0.6);
  run.window(recorder, 0.6, 0.7, false);
  recorder.on_end(run.end());
  EXPECT_EQ(measure(recorder, "contact.impact.count"), 2.0);
  EXPECT_NEAR(measure(recorder, "contact.impact.duration"), 0.5, roundoff);
  EXPECT_NEAR(measure(recorder, "contact.impact.force_mean"), 1.0, roundoff);
  EXPECT_EQ(measure(recorder, "schwarz.iterations_mean"), 3.5);
  EXPECT_EQ(measure(recorder, "schwarz.iterations_max"), 5.0);
}

TEST(Measures, RunWithoutContactHasNotesInsteadOfNumbers) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  recorder.on_start(run.start);
  run.window(recorder, 0.0, 0.1, false);
  recorder.on_end(run.end());
  const std::map<std::string, std::string>& notes = recorder.measures().notes;
  EXPECT_EQ(notes.at("contact.impact.begin"), "the interface never closed");
  EXPECT_EQ(notes.at("contact.impact.force_rms_error"),
            "the run ends before the exact contact does");
  EXPECT_TRUE(std::isnan(measure(recorder, "contact.impact.end")));
  EXPECT_EQ(measure(recorder, "schwarz.iterations_mean"), 0.0);
}

TEST(Measures, ContactThatLastsBeyondTheRunHasABeginAndNoEnd) {
  HandMadeRun run;
  MeasureRecorder recorder(nullptr);
  recorder.on_start(run.start);
  run.event(recorder, RunEvent::Kind::contact_closed, 0.1);
  run.window(recorder, 0.1, 0.3, true, 2);
  recorder.on_end(run.end());
  EXPECT_EQ(measure(recorder, "contact.impact.begin"), 0.1);
  EXPECT_EQ(recorder.measures().notes.at("contact.impact.duration"),
            "the interface was closed when the run ended");
}

TEST(Measures, EnergyErrorIsRelativeToTheExactEnergyWithAForm) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  // 1 % of the bar's 0.5 J too much, for a while.
  run.stored = [&run](int side, double time) {
    const double extra = side == 0 && time > 1.0 && time < 1.5 ? 0.005 : 0.0;
    return run.form.row.stored(side, time) + extra;
  };
  run.play(recorder);
  EXPECT_NEAR(measure(recorder, "energy.left.relative_error_max"), 0.01, roundoff);
  EXPECT_NEAR(measure(recorder, "energy.left.relative_error_end"), 0.0, roundoff);
  EXPECT_NEAR(measure(recorder, "energy.right.relative_error_max"), 0.0, roundoff);
  EXPECT_NEAR(measure(recorder, "energy.total.relative_drift_max"), 0.005, roundoff);
}

TEST(Measures, EnergyDriftKeepsItsSignAtTheEnd) {
  HandMadeRun run;
  MeasureRecorder recorder(nullptr);
  run.stored = [](int, double time) { return time > 2.0 ? -0.1 : 0.0; };
  run.kinetic = [](int side, double) { return side == 0 ? 0.75 : 0.25; };
  run.play(recorder, false);
  EXPECT_NEAR(measure(recorder, "energy.total.relative_drift_end"), -0.2, roundoff);
  EXPECT_NEAR(measure(recorder, "energy.left.relative_error_end"), -0.1 / 0.75, roundoff);
}

TEST(Measures, EnergyThatBecameHeatIsNoDrift) {
  HandMadeRun run;
  MeasureRecorder recorder(nullptr);
  // 0.2 J of 1 J become heat, and 0.01 J are lost.
  run.kinetic = [](int side, double) { return side == 0 ? 0.5 : 0.25; };
  run.stored = [](int side, double time) { return side == 0 && time > 1.0 ? 0.04 : 0.25; };
  run.dissipated = [](int side, double time) { return side == 0 && time > 1.0 ? 0.2 : 0.0; };
  run.play(recorder);
  EXPECT_NEAR(measure(recorder, "energy.total.begin"), 1.25, roundoff);
  EXPECT_NEAR(measure(recorder, "energy.total.relative_drift_max"), 0.01 / 1.25, roundoff);
  EXPECT_NEAR(measure(recorder, "energy.total.relative_drift_end"), -0.01 / 1.25, roundoff);
}

TEST(Measures, EnergyErrorOfARunThatBeginsWithNoneIsRelativeToTheLargest) {
  for (const double begin : {0.0, 1.0e-20}) {  // none, and the round-off of none
    HandMadeRun run;
    MeasureRecorder recorder(nullptr);
    run.stored = [](int, double) { return 0.0; };
    run.kinetic = [begin](int side, double time) {
      const double peak = side == 0 ? 5.0 : 0.0;
      return time < 0.15 ? begin : (time < 2.0 ? peak : 0.2 * peak);
    };
    run.play(recorder, false);
    EXPECT_NEAR(measure(recorder, "energy.left.relative_error_max"), 1.0, roundoff);
    EXPECT_NEAR(measure(recorder, "energy.left.relative_error_end"), 0.2, roundoff);
    EXPECT_NEAR(measure(recorder, "energy.total.relative_drift_max"), 1.0, roundoff);
    EXPECT_NEAR(measure(recorder, "energy.total.relative_drift_end"), 0.2, roundoff);
  }
}

TEST(Measures, EnergyOfABodyThatPassedSomeOnHasNoErrorWithoutAForm) {
  for (const bool contact : {false, true}) {
    HandMadeRun run;
    MeasureRecorder recorder(nullptr);
    run.play(recorder, contact);
    for (const char* name : {"energy.left.relative_error_max", "energy.right.relative_error_end"}) {
      EXPECT_EQ(std::isnan(measure(recorder, name)), contact) << name;
      EXPECT_EQ(recorder.measures().notes.contains(name), contact) << name;
    }
    // Curves of errors are drawn where there are errors, by the same scale: both bars have 0.5 J.
    EXPECT_EQ(recorder.measures().energy_scales.size(), contact ? 0u : 2u);
    EXPECT_NEAR(recorder.measures().total_energy_scale, 1.0, roundoff);
    EXPECT_NEAR(measure(recorder, "energy.total.relative_drift_max"), 0.0, roundoff);
  }
}

TEST(Measures, MomentumDeviationIsRelativeToWhatTheBodiesCarry) {
  HandMadeRun run;
  MeasureRecorder recorder(nullptr);
  run.momentum = [](int side, double time) {
    if (side == 1) return -3.0;
    return time > 1.0 && time < 1.2 ? 1.4 : 1.0;
  };
  run.play(recorder);
  EXPECT_NEAR(measure(recorder, "momentum.total"), 0.4 / (1.4 + 3.0), roundoff);
  EXPECT_NEAR(measure(recorder, "momentum.right.end"), -3.0, roundoff);
}

TEST(Measures, WhatGoesAwayFromAnAxisOnAllSidesIsNoMomentum) {
  HandMadeRun run;
  run.bodies[0].ports[0].geometry.round = true;
  MeasureRecorder recorder(nullptr);
  run.momentum = [](int side, double time) { return side == 1 ? -3.0 : 1.0 + time; };  // radial
  run.play(recorder);
  EXPECT_EQ(measure(recorder, "momentum.total"), 0.0);
  EXPECT_NEAR(measure(recorder, "momentum.right.end"), -3.0, roundoff);
}

TEST(Measures, ImmovableBodyLeavesTotalMomentumWithoutValue) {
  HandMadeRun run;
  run.bodies[1].mass = std::numeric_limits<double>::infinity();
  MeasureRecorder recorder(nullptr);
  run.play(recorder);
  EXPECT_TRUE(recorder.measures().notes.contains("momentum.total"));
  EXPECT_EQ(measure(recorder, "mean_velocity.right.end"), 0.0);
}

TEST(Measures, NumberThatIsNotFiniteIsNamedWithBodyAndTime) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  run.kinetic = [](int side, double time) { return side == 1 && time > 1.45 ? std::nan("") : 1.0; };
  run.play(recorder);
  EXPECT_EQ(recorder.non_finite(), "energy or momentum of right is not a finite number at 1.5 s");
}

TEST(Measures, ReadVelocityAgainstTheJumpOfTheContactPoint) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  run.v = [](int, double) { return 0.03; };
  run.play(recorder);
  EXPECT_NEAR(measure(recorder, "contact.impact.velocity_rms_error"), 0.03, roundoff);
  EXPECT_NEAR(measure(recorder, "contact.impact.velocity_rms"), 0.03, roundoff);
}

}  // namespace
}  // namespace abut::test_record_measures
