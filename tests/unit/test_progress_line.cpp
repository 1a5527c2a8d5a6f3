// Goal: people see how a run goes, and a run is not slowed by telling them. Oracle: the text that
// reaches standard error while the test turns the clock.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "base/log.hpp"
#include "coordinator/record/progress_line.hpp"

namespace abut {
namespace {

class ProgressLineText : public testing::Test {
 protected:
  ProgressLineText() {
    clock.advance(std::chrono::hours(1));
    start.begin = -1.0;
    start.end = 1.0;
    start.interfaces.push_back({.name = "impact"});
  }
  std::string shown(ProgressLine& line, double end) {
    testing::internal::CaptureStderr();
    line.on_window({{0, -1.0, end}, responses, interfaces});
    return testing::internal::GetCapturedStderr();
  }

  ManualClock clock;
  RunStart start;
  std::vector<Response> responses{2};
  std::vector<InterfaceReport> interfaces{1};
};

TEST_F(ProgressLineText, SaysHowFarTheRunIsAndWhetherBodiesTouch) {
  ProgressLine line(clock, true);
  line.on_start(start);
  EXPECT_EQ(shown(line, 0.0), "\r\x1b[K 50.0 %  time 0.0000e+00 s  free  2 solves");
  interfaces[0] = {.closed = true, .kinematic = 0, .iterations = 3, .residual = 0.0};
  clock.advance(std::chrono::milliseconds(100));
  EXPECT_EQ(shown(line, 0.5), "\r\x1b[K 75.0 %  time 5.0000e-01 s  contact at impact  8 solves");
}

TEST_F(ProgressLineText, IsWrittenTenTimesASecondAtMost) {
  ProgressLine line(clock, true);
  line.on_start(start);
  EXPECT_NE(shown(line, 0.0), "");
  clock.advance(std::chrono::milliseconds(99));
  EXPECT_EQ(shown(line, 0.1), "");
  clock.advance(std::chrono::milliseconds(1));
  EXPECT_NE(shown(line, 0.2), "");
}

TEST_F(ProgressLineText, StaysAwayFromFiles) {
  ProgressLine line(clock, false);
  line.on_start(start);
  EXPECT_EQ(shown(line, 0.0), "");
}

TEST_F(ProgressLineText, SaysAtWhichInterfaceAnEventIs) {
  start_log("test", LogLevel::info);
  ProgressLine line(clock, false);
  testing::internal::CaptureStderr();
  line.on_event({RunEvent::Kind::contact_opened, 0.5, "impact", "contact opens", {}});
  line.on_event({RunEvent::Kind::warning, 0.5, "left", "body 'left' is slow", {}});
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("5.000000e-01 s: impact: contact opens"), std::string::npos) << text;
  EXPECT_NE(text.find("5.000000e-01 s: body 'left' is slow"), std::string::npos) << text;
}

TEST_F(ProgressLineText, LeavesNoTraceAtTheEnd) {
  ProgressLine line(clock, true);
  line.on_start(start);
  shown(line, 0.0);
  testing::internal::CaptureStderr();
  line.on_end({});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "\r\x1b[K");
}

}  // namespace
}  // namespace abut
