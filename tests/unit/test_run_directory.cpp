// Goal: a run never overwrites what it was not told to. Oracle: the files themselves.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.hpp"
#include "coordinator/run_directory.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

class RunDirectory : public testing::Test {
 protected:
  RunDirectory() { fs::remove_all(root); }
  ~RunDirectory() override { fs::remove_all(root); }
  static void put(const fs::path& path) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << "mine";
  }
  std::string refusal(const fs::path& directory, bool force) {
    try {
      make_run_directory(directory, force);
    } catch (const InputError& error) {
      return error.what_is_wrong;
    }
    return "accepted";
  }

  fs::path root = fs::path(testing::TempDir()) /
                  (std::string("abut_run_directory_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(RunDirectory, IsMadeWithItsParents) {
  EXPECT_EQ(refusal(root / "a" / "b", false), "accepted");
  EXPECT_TRUE(fs::is_directory(root / "a" / "b"));
}

TEST_F(RunDirectory, ThatHoldsARunIsRefusedAndKept) {
  for (const char* name : {"scene.resolved.yaml", "summary.json"}) {
    put(root / name / name);
    put(root / name / "history.csv");
    EXPECT_EQ(refusal(root / name, false), "holds a run already");
    EXPECT_TRUE(fs::exists(root / name / name));
    EXPECT_TRUE(fs::exists(root / name / "history.csv"));
  }
}

TEST_F(RunDirectory, ForcedLosesTheFilesOfTheRunAndNoOther) {
  for (const char* name : {"summary.json", "history.csv", "report.html", "notes.txt", "fields.pvd",
                           "fields/bar_000010.vtu", "fields/notes.txt"})
    put(root / name);
  EXPECT_EQ(refusal(root, true), "accepted");
  EXPECT_TRUE(fs::exists(root / "summary.json")) << "until the new run has its bodies";
  clear_run_directory(root);
  EXPECT_FALSE(fs::exists(root / "summary.json") || fs::exists(root / "history.csv") ||
               fs::exists(root / "report.html"));
  EXPECT_FALSE(fs::exists(root / "fields.pvd") || fs::exists(root / "fields" / "bar_000010.vtu"));
  EXPECT_TRUE(fs::exists(root / "notes.txt") && fs::exists(root / "fields" / "notes.txt"));
  fs::remove(root / "fields" / "notes.txt");
  clear_run_directory(root);
  EXPECT_FALSE(fs::exists(root / "fields"));
}

TEST_F(RunDirectory, WithOtherFilesIsNobodysRun) {
  put(root / "notes.txt");
  EXPECT_EQ(refusal(root, false), "accepted");
}

TEST_F(RunDirectory, BelowAFileIsRefused) {
  put(root / "file");
  EXPECT_EQ(refusal(root / "file" / "run", true),
            "cannot be a run directory: " + (root / "file").string() + " is a file");
}

TEST_F(RunDirectory, WhereNobodyMayWriteIsRefused) {
  // Not even root makes directories in /proc.
  EXPECT_NE(refusal("/proc/abut/run", true), "accepted");
}

TEST(DefaultRunDirectory, IsNamedAfterTheScene) {
  EXPECT_EQ(default_run_directory("configs/two_bars.yaml"), fs::path("runs/two_bars"));
}

}  // namespace
}  // namespace abut
