// Goal: what a run's time went into is told in a file that programs of others open, whatever ends
// the run, and that never grows beyond its limit. Oracle: the file read back as JSON; spans that
// the test made.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/span.hpp"
#include "coordinator/record/span_file.hpp"
#include "tests/support/test_folder.hpp"

namespace abut::test_span_file {
namespace {

using Json = nlohmann::json;

class SpansOfARun : public TestFolder {
 protected:
  Json events() const {
    std::ifstream file(folder / "trace.json");
    return Json::parse(file);
  }
  /// A window of one iteration, in which a body is asked once.
  static void window(SpanFile& file, std::int64_t number) {
    const SpanSink sink = [&file](const Span& span) { file.tell(span); };
    const SpanScope window(sink, "window", number);
    const SpanScope iteration(sink, "iteration", 1);
    file.asked(0);
    file.answered(0, "advance", 0.0);
  }
  std::map<std::string, int> counts() const {
    std::map<std::string, int> found;
    for (const Json& event : events()) ++found[event.at("name").get<std::string>()];
    return found;
  }
};

/// As a run that is killed leaves it.
TEST_F(SpansOfARun, AreWholeJsonWhileTheRunGoesOn) {
  SpanFile file(folder / "trace.json");
  EXPECT_EQ(events().size(), 1u);
  file.begin({"left", "right \"one\""}, {0, 1});
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  window(file, 0);  // the first one is written at once
  const Json told = events();
  EXPECT_EQ(counts()["window"], 1);
  EXPECT_EQ(counts()["advance"], 1);
  EXPECT_EQ(counts()["waits"], 1);
  std::vector<std::string> tracks;
  for (const Json& event : told)
    if (event.at("name") == "thread_name") tracks.push_back(event.at("args").at("name"));
  EXPECT_EQ(tracks, (std::vector<std::string>{"coordinator", "left", "right \"one\""}));
}

/// Of a process of its own computing begins with the request; one process does one thing at a time;
/// what computes here has just ended.
TEST_F(SpansOfARun, SayWhenABodyComputedAsFarAsItIsKnown) {
  {
    SpanFile file(folder / "trace.json");
    file.begin({"a", "b", "here"}, {0, 0, -1});
    for (const std::size_t body : {0u, 1u, 2u}) file.asked(body);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (const std::size_t body : {0u, 1u, 2u}) file.answered(body, "advance", 0.004);
  }
  std::map<int, Json> asked, computes;
  for (const Json& event : events()) {
    if (event.at("name") == "advance") asked[event.at("tid")] = event;
    if (event.at("name") == "computes") computes[event.at("tid")] = event;
  }
  const auto begin = [](const Json& event) { return event.at("ts").get<double>(); };
  const auto end = [](const Json& event) {
    return event.at("ts").get<double>() + event.at("dur").get<double>();
  };
  constexpr double rounding = 2e-3;  // [us] of times in the file, which have three digits of them
  for (const int track : {2, 3, 4}) {
    EXPECT_NEAR(computes[track].at("dur").get<double>(), 4000.0, rounding);
    EXPECT_GE(begin(computes[track]), begin(asked[track]) - rounding);
    EXPECT_LE(end(computes[track]), end(asked[track]) + rounding);
  }
  EXPECT_NEAR(begin(computes[2]), begin(asked[2]), rounding);
  EXPECT_GE(begin(computes[3]), end(computes[2]) - rounding);
  EXPECT_NEAR(end(computes[4]), end(asked[4]), rounding);
}

TEST_F(SpansOfARun, AreThinnedSoThatTheFileKeepsItsLimitAndReachesTheEnd) {
  constexpr std::int64_t limit = 200'000;
  constexpr int windows = 20'000;  // a window takes some 400 bytes: forty times the limit
  std::int64_t every = 0;
  {
    SpanFile file(folder / "trace.json", limit);
    file.begin({"a"}, {0});
    for (int k = 0; k < windows; ++k) window(file, k);
    every = file.every();
    file.on_end({});
  }
  EXPECT_LE(std::filesystem::file_size(folder / "trace.json"), static_cast<std::size_t>(limit));
  EXPECT_GT(every, 4);
  std::int64_t first = windows, last = 0;
  for (const Json& event : events()) {
    if (event.at("name") != "window") continue;
    first = std::min(first, event.at("args").at("number").get<std::int64_t>());
    last = std::max(last, event.at("args").at("number").get<std::int64_t>());
  }
  EXPECT_EQ(first, 0);
  EXPECT_GT(last, windows - 2 * every);
  // A window is told with all that is in it, or not at all.
  EXPECT_EQ(counts()["window"], counts()["iteration"]);
  EXPECT_EQ(counts()["window"], counts()["advance"]);
}

/// A body was lost: nothing that was asked stays out.
TEST_F(SpansOfARun, TellOfARequestWithoutAnAnswer) {
  SpanFile file(folder / "trace.json");
  file.begin({"a"}, {0});
  file.asked(0);
  file.on_event({RunEvent::Kind::failure, 0.5, "a", "body 'a' is \"gone\"", {}});
  file.on_end({});
  EXPECT_EQ(counts()["no answer"], 1);
  EXPECT_EQ(counts()["failure a"], 1);
}

TEST(Spans, CostNoLookAtAClockWhereNobodyListens) {
  const SpanSink nobody;
  const SpanScope span(nobody, "window", 1);
  EXPECT_FALSE(span.heard());
}

}  // namespace
}  // namespace abut::test_span_file
