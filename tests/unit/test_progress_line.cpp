// Goal: people see how a run goes, and a run is not slowed by telling them. Oracle: the text that
// reaches standard error while the test turns the clock.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "base/log.hpp"
#include "coordinator/record/progress_line.hpp"

namespace abut::test_progress_line {
namespace {

class ProgressLineText : public testing::Test {
 protected:
  ProgressLineText() {
    clock.advance(std::chrono::hours(1));
    start.begin = -1.0;
    start.end = 1.0;
    start.interfaces.push_back({.name = "impact"});
    for (Description* body : {&left, &right}) start.bodies.push_back(body);
    left.name = "left";
    right.name = "right";
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
  Description left, right;
  std::vector<double> waited{0.0, 0.0};  // [s] by body
};

TEST_F(ProgressLineText, SaysHowFarTheRunIsWhatIsLeftAndWhatTakesTheTime) {
  ProgressLine line(clock, true, waited);
  line.on_start(start);
  clock.advance(std::chrono::seconds(10));
  waited = {5.0, 2.0};
  EXPECT_EQ(shown(line, 0.0),
            "\r\x1b[K 50.0 %  time 0.0000e+00 s  10 s left  free  left 50 %, right 20 %, "
            "coupling 30 %");
  testing::internal::CaptureStderr();
  line.on_event({RunEvent::Kind::contact_closed, 0.1, "impact", "contact 'impact' closes", {}});
  line.on_event({RunEvent::Kind::contact_closed, 0.1, "other", "contact 'other' closes", {}});
  line.on_event({RunEvent::Kind::contact_opened, 0.2, "other", "contact 'other' opens", {}});
  testing::internal::GetCapturedStderr();
  // As fast as since half of the time: a quarter of the way in ten seconds.
  clock.advance(std::chrono::seconds(10));
  EXPECT_EQ(shown(line, 0.5),
            "\r\x1b[K 75.0 %  time 5.0000e-01 s  10 s left  1 contact  left 25 %, right 10 %, "
            "coupling 65 %");
}

TEST_F(ProgressLineText, IsWrittenTenTimesASecondAtMost) {
  ProgressLine line(clock, true, waited);
  line.on_start(start);
  EXPECT_NE(shown(line, 0.0), "");
  clock.advance(std::chrono::milliseconds(99));
  EXPECT_EQ(shown(line, 0.1), "");
  clock.advance(std::chrono::milliseconds(1));
  EXPECT_NE(shown(line, 0.2), "");
}

/// After ten seconds, and then after a twentieth of the time so far.
TEST_F(ProgressLineText, IsALogLineNowAndThenElsewhere) {
  start_log("test", LogLevel::info);
  ProgressLine line(clock, false, waited);
  line.on_start(start);
  EXPECT_EQ(shown(line, 0.0), "");
  clock.advance(std::chrono::seconds(9));
  EXPECT_EQ(shown(line, 0.1), "");
  clock.advance(std::chrono::seconds(1));
  const std::string text = shown(line, 0.2);
  EXPECT_NE(text.find("test info:  60.0 %  time 2.0000e-01 s  6.7 s left  free"), std::string::npos)
      << text;
  EXPECT_EQ(text.find('\r'), std::string::npos);
  clock.advance(std::chrono::seconds(390));
  EXPECT_NE(shown(line, 0.3), "");
  clock.advance(std::chrono::seconds(19));
  EXPECT_EQ(shown(line, 0.4), "");
  clock.advance(std::chrono::seconds(1));
  EXPECT_NE(shown(line, 0.5), "");
}

TEST_F(ProgressLineText, SaysAtWhichInterfaceAnEventIs) {
  start_log("test", LogLevel::info);
  ProgressLine line(clock, false, waited);
  testing::internal::CaptureStderr();
  line.on_event({RunEvent::Kind::contact_opened, 0.5, "impact", "contact opens", {}});
  line.on_event({RunEvent::Kind::warning, 0.5, "left", "body 'left' is slow", {}});
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("5.000000e-01 s: impact: contact opens"), std::string::npos) << text;
  EXPECT_NE(text.find("5.000000e-01 s: body 'left' is slow"), std::string::npos) << text;
}

TEST_F(ProgressLineText, LeavesNoTraceAtTheEnd) {
  ProgressLine line(clock, true, waited);
  line.on_start(start);
  shown(line, 0.0);
  testing::internal::CaptureStderr();
  line.on_end({});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "\r\x1b[K");
}

}  // namespace
}  // namespace abut::test_progress_line
