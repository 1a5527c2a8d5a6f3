// Goal: what a run writes can be read back by anybody. Oracle: the numbers that were put in, read
// back as text and as JSON.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/record/csv_history.hpp"
#include "coordinator/record/event_log.hpp"
#include "coordinator/record/expectations.hpp"
#include "coordinator/record/summary.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/record_run.hpp"

namespace abut::test_record_files {
namespace {

class RecordFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
    directory_ =
        std::filesystem::path(::testing::TempDir()) / (std::string("abut_") + info->name());
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::string read(const char* name) const {
    std::ifstream file(directory_ / name, std::ios::binary);
    EXPECT_TRUE(file.good()) << name;
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::vector<std::vector<std::string>> table(const char* name) const {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(read(name));
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> row;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
      if (line.ends_with(',')) row.emplace_back();
      rows.push_back(row);
    }
    return rows;
  }
  static std::size_t column(const std::vector<std::vector<std::string>>& rows,
                            const std::string& name) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(at, rows[0].end()) << name;
    return index(at - rows[0].begin()) % rows[0].size();
  }
  nlohmann::json summary() const { return nlohmann::json::parse(read("summary.json")); }

  std::filesystem::path directory_;
};

TEST_F(RecordFiles, HistoryHasUnitsInItsHeaderAndOneRowPerRecord) {
  HandMadeRun run;
  CsvHistory history(directory_, nullptr);
  run.play(history);
  const std::vector<std::vector<std::string>> rows = table("history.csv");
  ASSERT_EQ(rows.size(), 31u);
  const std::vector<std::string> header = {"time [s]",
                                           "left.tip.u [m]",
                                           "left.tip.v [m/s]",
                                           "left.tip.force [N]",
                                           "left.kinetic [J]",
                                           "left.stored [J]",
                                           "left.total [J]",
                                           "left.momentum [kg m/s]",
                                           "left.mean_velocity [m/s]",
                                           "left.dissipated [J]",
                                           "left.external_work [J]",
                                           "right.tip.u [m]",
                                           "right.tip.v [m/s]",
                                           "right.tip.force [N]",
                                           "right.kinetic [J]",
                                           "right.stored [J]",
                                           "right.total [J]",
                                           "right.momentum [kg m/s]",
                                           "right.mean_velocity [m/s]",
                                           "right.dissipated [J]",
                                           "right.external_work [J]",
                                           "impact.gap [m]",
                                           "impact.closed",
                                           "impact.iterations"};
  EXPECT_EQ(rows[0], header);
  for (const std::vector<std::string>& row : rows) EXPECT_EQ(row.size(), header.size());
  EXPECT_FALSE(std::filesystem::exists(directory_ / "closed_form.csv"));
}

TEST_F(RecordFiles, HistoryHasTheColumnsThatABodyTellsAfterItsOwn) {
  HandMadeRun run;
  run.bodies[0].columns = {"clamp.reaction [N]", "wall.reaction [N]"};
  run.told = [](int, double time) { return 7.0 * time; };
  CsvHistory history(directory_, nullptr);
  run.play(history);
  const std::vector<std::vector<std::string>> rows = table("history.csv");
  EXPECT_EQ(rows[0][10], "left.external_work [J]");
  EXPECT_EQ(rows[0][11], "left.clamp.reaction [N]");
  EXPECT_EQ(rows[0][12], "left.wall.reaction [N]");
  EXPECT_EQ(rows[0][13], "right.tip.u [m]");
  for (std::size_t r = 1; r < rows.size(); ++r) {
    EXPECT_EQ(rows[r].size(), rows[0].size());
    EXPECT_EQ(std::stod(rows[r][12]), 7.0 * std::stod(rows[r][0]));
  }
}

TEST_F(RecordFiles, HistoryNumbersReadBackExactly) {
  HandMadeRun run;
  run.u = [](int side, double time) { return (side + 1) / 3.0 * time; };
  CsvHistory history(directory_, nullptr);
  run.play(history);
  const std::vector<std::vector<std::string>> rows = table("history.csv");
  for (int k = 0; k < 30; ++k) {
    const double time = 0.1 * (k + 1);
    EXPECT_EQ(std::stod(rows[k + 1][0]), time);
    EXPECT_EQ(std::stod(rows[k + 1][1]), 1.0 / 3.0 * time);
    // The left port moves against the gap and the right one with it.
    EXPECT_EQ(std::stod(rows[k + 1][21]), 0.2 - 1.0 / 3.0 * time + 2.0 / 3.0 * time);
    EXPECT_EQ(rows[k + 1][22], k >= 1 && k < 21 ? "1" : "0");
    EXPECT_EQ(rows[k + 1][23], k >= 1 && k < 21 ? "2" : "0");
  }
}

/// Two steps in a row, of a force that grows: that of the last step alone is no mean.
TEST_F(RecordFiles, HistoryTellsTheMeanOfForcesThatAreConstantInSteps) {
  HandMadeRun run;
  run.f = [](int, double time) { return time; };
  CsvHistory history(directory_, nullptr);
  run.play(history);
  const std::vector<std::vector<std::string>> rows = table("history.csv");
  const std::size_t force = column(rows, "left.tip.force [N]");
  for (int k = 0; k < 30; ++k)
    EXPECT_NEAR(std::stod(rows[k + 1][force]), 0.1 * (k + 0.5), roundoff(100.0, 0.1 * (k + 1)));
}

TEST_F(RecordFiles, ClosedFormHasTheSameTimesAndTheColumnsOfTheHistory) {
  HandMadeRun run;
  CsvHistory history(directory_, &run.form);
  run.play(history);
  const std::vector<std::vector<std::string>> computed = table("history.csv");
  const std::vector<std::vector<std::string>> exact = table("closed_form.csv");
  ASSERT_EQ(exact.size(), computed.size());
  // The history also holds iterations and balances. Since the run is exact, numbers are the same
  // but for round-off.
  for (const char* name : {"left.tip.u [m]", "right.mean_velocity [m/s]", "impact.gap [m]"}) {
    const std::size_t there = column(exact, name), here = column(computed, name);
    for (std::size_t r = 1; r < exact.size(); ++r) {
      EXPECT_EQ(exact[r][0], computed[r][0]);
      EXPECT_NEAR(std::stod(exact[r][there]), std::stod(computed[r][here]), roundoff(10.0, 1.0))
          << name;
    }
  }
  for (const std::string& name : exact[0]) column(computed, name);
}

TEST_F(RecordFiles, HistoryLeavesACellEmptyWhereANumberIsNotFinite) {
  HandMadeRun run;
  run.kinetic = [](int side, double time) { return side == 0 && time > 2.95 ? std::nan("") : 1.0; };
  CsvHistory history(directory_, nullptr);
  run.play(history);
  const std::vector<std::vector<std::string>> rows = table("history.csv");
  EXPECT_EQ(rows[30][4], "");
  EXPECT_EQ(rows[29][4], "1");
  EXPECT_EQ(read("history.csv").find("nan"), std::string::npos);
}

TEST_F(RecordFiles, EventIsInTheFileAsSoonAsItHasHappened) {
  EventLog log(directory_);
  log.on_event(
      {RunEvent::Kind::contact_closed, 0.1, "impact", "touched \"hard\"\n", {{"speed", 2.5}}});
  const std::string text = read("events.jsonl");
  ASSERT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  const nlohmann::json event = nlohmann::json::parse(text);
  EXPECT_EQ(event["time"], 0.1);
  EXPECT_EQ(event["kind"], "contact_closed");
  EXPECT_EQ(event["subject"], "impact");
  EXPECT_EQ(event["text"], "touched \"hard\"\n");
  EXPECT_EQ(event["values"]["speed"], 2.5);
}

TEST_F(RecordFiles, EventSurvivesNumbersAndBytesThatJsonCannotHold) {
  EventLog log(directory_);
  log.on_event(
      {RunEvent::Kind::failure, std::nan(""), "left", "bad \xff byte", {{"value", HUGE_VAL}}});
  const nlohmann::json event = nlohmann::json::parse(read("events.jsonl"));
  EXPECT_TRUE(event["time"].is_null());
  EXPECT_TRUE(event["values"]["value"].is_null());
}

Expectation at_most(const std::string& measure, double value) {
  Expectation expectation;
  expectation.measure = measure;
  expectation.at_most = value;
  expectation.because = "a reason";
  return expectation;
}

TEST_F(RecordFiles, SummaryHoldsMeasuresTimingHashAndClosedForm) {
  HandMadeRun run;
  MeasureRecorder recorder(&run.form);
  Summary summary_file(directory_,
                       {"two bars", {{"abut", "1.2.3"}}, {at_most("schwarz.iterations_max", 2.0)}},
                       recorder, &run.form);
  run.play(recorder);
  run.index = 0;
  run.play(summary_file);
  const nlohmann::json json = summary();
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(summary_file.status(), "completed");
  EXPECT_EQ(json["title"], "two bars");
  EXPECT_EQ(json["state_hash"], "0000000000000abc");
  EXPECT_EQ(json["body_hashes"]["right"], "0000000000000002");
  EXPECT_EQ(json["measures"]["schwarz.iterations_max"], 2.0);
  EXPECT_EQ(json["measures"].size(), recorder.measures().values.size());
  EXPECT_EQ(json["timing"]["compute_s"]["right"], 0.25);
  EXPECT_EQ(json["timing"]["wall_s"], 0.5);
  EXPECT_NEAR(json["timing"]["overhead_per_exchange_us_median"], 20.0, roundoff(4.0, 20.0));
  EXPECT_EQ(json["closed_form"]["interface"], "impact");
  EXPECT_EQ(json["closed_form"]["force"], 1.0);
  EXPECT_EQ(json["versions"]["abut"], "1.2.3");
  EXPECT_EQ(json["exchanges"], 142);
  EXPECT_EQ(json["ports"]["left.tip"]["position"], -0.1);
  EXPECT_EQ(json["interfaces"]["impact"]["sides"][1], "right.tip");
  EXPECT_EQ(json["interfaces"]["impact"]["tied"], false);
  EXPECT_EQ(json["expectations"][0]["pass"], true);
  EXPECT_EQ(json["expectations"][0]["expected"], "at most 2");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "summary.json.tmp"));
}

TEST_F(RecordFiles, SummarySaysWhichInterfacesAreTies) {
  HandMadeRun run;
  run.start.interfaces[0].tied = true;
  MeasureRecorder recorder(nullptr);
  Summary summary_file(directory_, {"", {}, {}}, recorder, nullptr);
  run.play(recorder);
  run.index = 0;
  run.play(summary_file);
  EXPECT_EQ(summary()["interfaces"]["impact"]["tied"], true);
}

TEST_F(RecordFiles, SummaryHoldsTheFrequenciesOfBodiesThatMoveInModes) {
  HandMadeRun run;
  run.bodies[1].frequencies = {0.0, 12.5, 1.0 / 3.0};
  MeasureRecorder recorder(nullptr);
  Summary summary_file(directory_, {"", {}, {}}, recorder, nullptr);
  run.play(recorder);
  run.index = 0;
  run.play(summary_file);
  const nlohmann::json bodies = summary()["bodies"];
  EXPECT_FALSE(bodies[0].contains("frequencies_hz"));
  EXPECT_EQ(bodies[1]["frequencies_hz"].get<std::vector<double>>(), run.bodies[1].frequencies);
}

TEST_F(RecordFiles, SummaryTurnsMissingValuesIntoNullsWithNotes) {
  HandMadeRun run;
  MeasureRecorder recorder(nullptr);
  Summary summary_file(directory_, {"", {}, {at_most("contact.impact.end", 1.0)}}, recorder,
                       nullptr);
  for (Observer* observer :
       {static_cast<Observer*>(&recorder), static_cast<Observer*>(&summary_file)}) {
    observer->on_start(run.start);
    run.window(*observer, 0.0, 0.1, false);
    observer->on_end(run.end());
  }
  const nlohmann::json json = summary();
  EXPECT_TRUE(json["measures"]["contact.impact.end"].is_null());
  EXPECT_NE(json["notes"].dump().find("contact.impact.end: the interface never closed"),
            std::string::npos);
  EXPECT_EQ(json["expectations"][0]["pass"], false);
  EXPECT_TRUE(json["expectations"][0]["got"].is_null());
  EXPECT_FALSE(json.contains("closed_form"));
}

TEST_F(RecordFiles, SummaryOfARunWithNumbersThatAreNotFiniteSaysFailed) {
  HandMadeRun run;
  run.momentum = [](int, double) { return std::nan(""); };
  MeasureRecorder recorder(nullptr);
  Summary summary_file(directory_, {}, recorder, nullptr);
  run.play(recorder);
  run.play(summary_file);
  const nlohmann::json json = summary();
  EXPECT_EQ(json["status"], "failed");
  EXPECT_EQ(json["notes"][0], "energy or momentum of left is not a finite number at 0.1 s");
}

TEST_F(RecordFiles, UnknownMeasureDoesNotCostTheSummary) {
  HandMadeRun run;
  MeasureRecorder recorder(nullptr);
  Summary summary_file(directory_, {"", {}, {at_most("schwarz.iteration_max", 1.0)}}, recorder,
                       nullptr);
  run.play(recorder);
  run.play(summary_file);
  EXPECT_NE(summary()["notes"].dump().find("there is no measure 'schwarz.iteration_max'"),
            std::string::npos);
}

TEST_F(RecordFiles, FolderThatDoesNotExistIsTheWorldsError) {
  const std::filesystem::path missing = directory_ / "missing";
  EXPECT_THROW(EventLog{missing}, RunError);
  EXPECT_THROW(write_whole(missing / "summary.json", "{}"), RunError);
}

TEST_F(RecordFiles, NothingIsWrittenThroughASymbolicLinkOrOverAFile) {
  const std::filesystem::path mine = directory_ / "mine.txt";
  std::ofstream(mine) << "mine";
  std::filesystem::create_symlink(mine, directory_ / "events.jsonl");
  EXPECT_THROW(EventLog{directory_}, RunError);
  EXPECT_THROW(TextFile{mine}, RunError);
  for (const char* name : {"summary.json.tmp", "summary.json"}) {
    std::filesystem::remove(directory_ / name);
    std::filesystem::create_symlink(mine, directory_ / name);
    write_whole(directory_ / "summary.json", "{}");  // takes the link's place
  }
  EXPECT_TRUE(std::filesystem::is_regular_file(
      std::filesystem::symlink_status(directory_ / "summary.json")));
  std::ifstream file(mine);
  std::string text;
  EXPECT_TRUE(std::getline(file, text) && text == "mine") << text;
}

}  // namespace
}  // namespace abut::test_record_files
