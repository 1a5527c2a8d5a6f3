// Goal: errors of an interface are held against every stretch of the exact contact.
// Oracle: rows whose exact forces are known (tables A5 and A7), fed with forces whose error is
// known.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/exact/bar_row.hpp"
#include "coordinator/record/contact_errors.hpp"

namespace abut::test_contact_errors {
namespace {

// Sums of some thousand products.
constexpr double roundoff = 1e-12;

/// A bar of length, impedance, wave speed and velocity 1 that touches one at rest.
BarRow pair(double length, double impedance, bool clamped, double end, double velocity = 1.0) {
  RowBar first;
  first.name = "first";
  first.youngs_modulus = first.density = first.area = first.length = 1.0;
  first.position = -1.0;
  first.velocity = velocity;
  RowBar second = first;
  second.name = "second";
  second.youngs_modulus = second.density = impedance;
  second.length = length;
  second.position = second.velocity = 0.0;
  second.fixed[1] = clamped;
  return BarRow({first, second}, {{BarEnd{0, 1}, BarEnd{1, 0}}}, 0.0, end);
}

using Function = std::function<double(double time)>;

/// The measures of a run that shows `force` and `velocity` in substeps of 1/1000, in which both
/// hold their value of the middle.
Measures measures_of(const BarRow& row, const SeenContact& seen, const Function& force,
                     const Function& velocity) {
  ContactErrors errors(row, row.contacts()[0]);
  for (int k = 0; k < static_cast<int>(std::lround(1000.0 * row.end())); ++k) {
    const double from = k / 1000.0, to = (k + 1) / 1000.0, middle = (k + 0.5) / 1000.0;
    errors.add_force(from, to, force(middle), force(middle));
    errors.add_velocity(0, from, to, velocity(middle), velocity(middle));
    errors.follow(middle, force(middle));
  }
  Measures measures;
  errors.write("impact", seen, row.end(), measures);
  return measures;
}

double measure(const Measures& measures, const std::string& name) {
  return measures.values.at("contact.impact." + name);
}

TEST(ContactErrors, ExactStaircaseHasNone) {
  const BarRow row = pair(3.0, 0.5, false, 8.0);  // 1/3, 1/9, 1/27, each for 2
  const RowContact& exact = row.contacts()[0];
  const Measures m = measures_of(
      row, {0.0, 6.0, 1, true, exact.impulse()},
      [&exact](double time) { return exact.force_at(time); },
      [&row](double time) {
        return row.velocity({0, 1}, time);
      });
  for (const char* name :
       {"begin_error", "release_error", "force_rms_error", "force_max_error",
        "force_rms_error_tail", "velocity_rms_error", "count_error", "impulse_error"})
    EXPECT_NEAR(measure(m, name), 0.0, roundoff) << name;
  // The middles of two substeps, of 1/1000, are to both sides of the release; 6 is the duration.
  EXPECT_NEAR(measure(m, "release_error_half_force"), 0.0, 0.5e-3 / 6.0 + roundoff);
}

TEST(ContactErrors, StepThatIsMissedCountsWithItsShareOfTheLargestForce) {
  const BarRow row = pair(2.0, 0.5, false, 6.0);  // 1/3, 1/9, each for 2
  const Measures m = measures_of(
      row, {0.0, 4.0, 1, true, 4.0 / 3.0}, [](double time) { return time < 4.0 ? 1.0 / 3.0 : 0.0; },
      [&row](double time) {
        return row.velocity({0, 1}, time);
      });
  EXPECT_NEAR(measure(m, "force_max_error"), 2.0 / 3.0, roundoff);
  EXPECT_NEAR(measure(m, "force_rms_error"), std::sqrt(0.5) * 2.0 / 3.0, roundoff);
  EXPECT_NEAR(measure(m, "impulse_error"), 0.5, roundoff);  // 4/3 for 8/9
}

TEST(ContactErrors, ForceBetweenTwoContactsIsAnError) {
  const BarRow row = pair(2.0, 1.0, true, 8.0);  // 1/2 on [0, 2] and on [4, 6]
  const Measures m = measures_of(
      row, {0.0, 6.0, 1, true, 3.0}, [](double time) { return time < 6.0 ? 0.5 : 0.0; },
      [&row](double time) {
        return row.velocity({0, 1}, time);
      });
  EXPECT_NEAR(measure(m, "force_max_error"), 1.0, roundoff);
  EXPECT_NEAR(measure(m, "force_rms_error"), std::sqrt(1.0 / 3.0), roundoff);  // one of three
  EXPECT_NEAR(measure(m, "velocity_rms_error"), 0.0, roundoff);
  EXPECT_EQ(measure(m, "count_error"), -1.0);
  EXPECT_NEAR(measure(m, "impulse_error"), 0.5, roundoff);
}

TEST(ContactErrors, ContactWithoutAnExactOneIsCountedAndNothingElse) {
  const BarRow row = pair(1.0, 1.0, false, 2.0, -1.0);
  const Measures m = measures_of(
      row, {0.5, 0.6, 2, true, 0.1}, [](double) { return 1.0; }, [](double) { return 0.0; });
  EXPECT_EQ(measure(m, "count_error"), 2.0);
  EXPECT_TRUE(std::isnan(measure(m, "begin_error")));
  EXPECT_EQ(m.notes.at("contact.impact.force_rms_error"), "the exact solution has no contact here");
  EXPECT_FALSE(m.notes.contains("contact.impact.count_error"));
}

TEST(ContactErrors, ExactContactThatGoesOnHasNoRelease) {
  const BarRow row = pair(1.0, 1.0, false, 1.5);
  const Measures m = measures_of(
      row, {0.0, 0.0, 1, false, 0.75}, [](double) { return 0.5; },
      [&row](double time) {
        return row.velocity({0, 1}, time);
      });
  EXPECT_EQ(m.notes.at("contact.impact.release_error"),
            "the exact contact goes on when the run ends");
  EXPECT_NEAR(measure(m, "force_rms_error"), 0.0, roundoff);
  EXPECT_NEAR(measure(m, "impulse_error"), 0.0, roundoff);
}

}  // namespace
}  // namespace abut::test_contact_errors
