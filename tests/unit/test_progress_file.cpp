// Goal: whoever looks at a run sees how far it is, and the run pays nothing for it. Oracle: the
// file read back as JSON while the test turns the clock; this process, as the kernel tells of it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "coordinator/record/body_meter.hpp"
#include "coordinator/record/progress_file.hpp"
#include "tests/support/test_folder.hpp"

namespace abut::test_progress_file {
namespace {

using Json = nlohmann::json;

class ProgressOfARun : public TestFolder {
 protected:
  ProgressOfARun() {
    start.begin = 0.0;
    start.end = 2.0;
    left.name = "left";
    right.name = "right";
    start.bodies = {&left, &right};
  }
  bool is_there() const { return std::filesystem::exists(folder / "progress.json"); }
  Json told() const {
    std::ifstream file(folder / "progress.json");
    return Json::parse(file);
  }
  void window(ProgressFile& file, double from, double to) {
    file.on_window({{0, from, to}, responses, interfaces, ++windows});
  }
  ProgressFile made(bool more = false) {
    return {folder, {"Two bars", {}, false, {{getpid(), {0, 1}}}, more}, meter, clock};
  }

  ManualClock clock;
  RunStart start;
  Description left, right;
  BodyMeter meter{2};
  std::vector<Response> responses{2};
  std::vector<InterfaceReport> interfaces{2};
  std::int64_t windows = 0;
};

TEST_F(ProgressOfARun, SaysHowFarItIsAndWhatIsLeft) {
  ProgressFile file = made();
  file.on_start(start);
  EXPECT_EQ(told()["time"]["reached"], 0.0);
  EXPECT_TRUE(told()["left_s"].is_null());
  meter.start();
  meter.finish(1, 0.0);
  interfaces[0].closed = true;
  interfaces[1].iterations = 3;
  clock.advance(std::chrono::seconds(10));
  window(file, 0.0, 0.5);
  EXPECT_EQ(told()["time"]["reached"], 0.5);
  EXPECT_EQ(told()["left_s"], 30.0);
  EXPECT_EQ(told()["wall_s"], 10.0);
  EXPECT_EQ(told()["windows"], 1);
  EXPECT_EQ(told()["in_contact"], 1);
  EXPECT_EQ(told()["iterations"], 3);
  EXPECT_EQ(told()["exchanges"], 1);
  EXPECT_EQ(told()["of_bodies"]["right"]["exchanges"], 1);
  EXPECT_EQ(told()["processes"][0]["bodies"], (Json{"left", "right"}));
}

/// A run that is resumed at half of its way has not come there in its first seconds.
TEST_F(ProgressOfARun, OfAResumedRunCountsFromWhereItWentOn) {
  ProgressFile file = made();
  file.on_start(start);
  clock.advance(std::chrono::seconds(10));
  window(file, 1.0, 1.5);
  EXPECT_EQ(told()["left_s"], 10.0);
}

TEST_F(ProgressOfARun, IsWrittenOnceASecondAtMost) {
  ProgressFile file = made();
  file.on_start(start);
  clock.advance(std::chrono::milliseconds(999));
  window(file, 0.0, 0.1);
  EXPECT_EQ(told()["windows"], 0);
  clock.advance(std::chrono::milliseconds(1));
  window(file, 0.1, 0.2);
  EXPECT_EQ(told()["windows"], 2);
}

TEST_F(ProgressOfARun, IsGoneWhenTheRunHasToldItsEnd) {
  ProgressFile file = made();
  file.on_start(start);
  EXPECT_TRUE(is_there());
  file.on_end({.status = "completed"});
  EXPECT_FALSE(is_there());
  ProgressFile stage = made(true);
  stage.on_start(start);
  stage.on_end({.status = "completed"});
  EXPECT_TRUE(is_there()) << "another stage follows";
  stage.on_end({.status = "failed"});
  EXPECT_FALSE(is_there());
}

/// Whether it is still there, whoever has its id by now.
TEST_F(ProgressOfARun, NamesItsProcessForGood) {
  made().on_start(start);
  const Json program = told()["program"];
  EXPECT_EQ(program["id"], getpid());
  std::ifstream stat("/proc/self/stat");
  std::string field;
  for (int k = 0; k < 22; ++k) stat >> field;  // of a name without spaces
  EXPECT_EQ(program["began"], field);
}

TEST_F(ProgressOfARun, ThatCannotBeWrittenCostsAWarning) {
  std::filesystem::create_directory(folder / "progress.json");
  std::ofstream(folder / "progress.json" / "in_the_way") << "x";
  ProgressFile file = made();
  testing::internal::CaptureStderr();
  EXPECT_NO_THROW(file.on_start(start));
  clock.advance(std::chrono::seconds(2));
  EXPECT_NO_THROW(window(file, 0.0, 0.5));
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("abut monitor sees nothing new"), std::string::npos) << said;
  EXPECT_EQ(said.find("abut monitor", said.find("abut monitor") + 1), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(folder / "progress.json.tmp"));
}

}  // namespace
}  // namespace abut::test_progress_file
