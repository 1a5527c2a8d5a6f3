// Goal: an expectation passes exactly when the measure is inside what it allows. Oracle: values on
// both sides of the limits.
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/record/expectations.hpp"

namespace abut::test_record_expectations {
namespace {

Measures measures(double windows) {
  Measures out;
  out.scope.bodies = {"left"};
  out.scope.interfaces = {"impact"};
  out.set("windows", windows);
  out.none("contact.impact.end", "the interface never closed");
  return out;
}

Expectation expect(const std::string& measure) {
  Expectation expectation;
  expectation.measure = measure;
  return expectation;
}

bool passes(const Expectation& expectation, double windows) {
  return evaluate({expectation}, measures(windows)).front().pass;
}

TEST(Expectations, LimitsAreIncluded) {
  Expectation most = expect("windows");
  most.at_most = 3.0;
  EXPECT_TRUE(passes(most, 3.0));
  EXPECT_FALSE(passes(most, std::nextafter(3.0, 4.0)));
  Expectation least = expect("windows");
  least.at_least = 3.0;
  EXPECT_TRUE(passes(least, 3.0));
  EXPECT_FALSE(passes(least, std::nextafter(3.0, 2.0)));
}

TEST(Expectations, RelativeToleranceIsThatOfTheExpectedValue) {
  Expectation equals = expect("windows");
  equals.equals = -200.0;
  equals.relative = 0.01;
  EXPECT_TRUE(passes(equals, -201.9));
  EXPECT_FALSE(passes(equals, -202.1));
  EXPECT_FALSE(passes(equals, 200.0));
}

TEST(Expectations, AbsoluteToleranceHoldsAroundZero) {
  Expectation equals = expect("windows");
  equals.equals = 0.0;
  equals.absolute = 0.5;
  EXPECT_TRUE(passes(equals, -0.5));
  EXPECT_FALSE(passes(equals, 0.6));
}

TEST(Expectations, MeasureWithoutValueFailsAndSaysWhy) {
  Expectation most = expect("contact.impact.end");
  most.at_most = HUGE_VAL;
  const ExpectationResult result = evaluate({most}, measures(1.0)).front();
  EXPECT_FALSE(result.pass);
  EXPECT_EQ(result.note, "the interface never closed");
  EXPECT_NE(to_table({result}).find("no value"), std::string::npos);
}

std::string remedy(const std::string& measure) {
  try {
    (void)evaluate({expect(measure)}, measures(1.0));
  } catch (const InputError& error) {
    return error.what_is_wrong + " | " + error.remedy;
  }
  return "accepted";
}

TEST(Expectations, UnknownMeasureNamesTheNearest) {
  EXPECT_NE(remedy("contact.impact.duratoin").find("contact.impact.duration"), std::string::npos);
  EXPECT_NE(remedy("energy.lft.relative_error_max").find("energy.left.relative_error_max"),
            std::string::npos);
  EXPECT_EQ(remedy("contact.impact.duration"), "accepted");
}

TEST(Expectations, MeasureThatNeedsAClosedFormSaysSo) {
  EXPECT_NE(remedy("contact.impact.release_error").find("Name meta.closed_form"),
            std::string::npos);
}

TEST(Expectations, EveryMeasureIsExplainedInTheDocuments) {
  std::ifstream file(std::string(ABUT_SOURCE_DIR) + "/docs/OUTPUT.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  MeasureScope scope;
  scope.bodies = {"BODY"};
  scope.ports = {"BODY.PORT"};
  scope.interfaces = {"INTERFACE"};
  scope.exact = {"INTERFACE"};
  for (const std::string& name : known_measures(scope))
    EXPECT_NE(text.find("`" + name + "`"), std::string::npos) << name;
}

TEST(Expectations, TableShowsWhatFailedAndWhyItWasExpected) {
  Expectation most = expect("windows");
  most.at_most = 3.0;
  most.because = "a long window is enough";
  const std::string table = to_table(evaluate({most}, measures(4.0)));
  EXPECT_NE(table.find("at most 3"), std::string::npos);
  EXPECT_NE(table.find("FAILED"), std::string::npos);
  EXPECT_NE(table.find("a long window is enough"), std::string::npos);
}

}  // namespace
}  // namespace abut::test_record_expectations
