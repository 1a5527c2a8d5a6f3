// Goal: a run never overwrites what it was not told to. Oracle: the files themselves.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.hpp"
#include "coordinator/run_directory.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

class RunFolder : public testing::Test {
 protected:
  RunFolder() { fs::remove_all(root); }
  ~RunFolder() override { fs::remove_all(root); }
  static void put(const fs::path& path, const char* text = "mine") {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  static std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::string refusal(const fs::path& directory, bool force) {
    try {
      RunDirectory(directory, force);
    } catch (const InputError& error) {
      return error.what_is_wrong;
    }
    return "accepted";
  }

  fs::path root = fs::path(testing::TempDir()) /
                  (std::string("abut_run_directory_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(RunFolder, IsMadeWithItsParents) {
  EXPECT_EQ(refusal(root / "a" / "b", false), "accepted");
  EXPECT_TRUE(fs::is_directory(root / "a" / "b"));
}

TEST_F(RunFolder, ThatHoldsARunIsRefusedAndKept) {
  for (const char* name : {"scene.resolved.yaml", "summary.json"}) {
    put(root / name / name);
    put(root / name / "history.csv");
    EXPECT_EQ(refusal(root / name, false), "holds a run already");
    EXPECT_TRUE(fs::exists(root / name / name));
    EXPECT_TRUE(fs::exists(root / name / "history.csv"));
  }
}

TEST_F(RunFolder, ForcedLosesTheFilesOfTheRunAndNoOther) {
  for (const char* name : {"summary.json", "history.csv", "report.html", "film.gif", "fields.pvsm",
                           "picture.png", "picture_of_mine.png", "notes.txt",
                           "fields/bar_000010.vtu", "fields/mine_000010.vtu", "notes.vtu"})
    put(root / name);
  // What a run has written is what its list names, and a list that was tampered with names no more.
  put(root / "fields.pvd",
      "<DataSet file=\"fields/bar_000010.vtu\"/><DataSet file=\"fields/../notes.vtu\"/>"
      "<DataSet file=\"notes.txt\"/>");
  EXPECT_EQ(refusal(root, true), "accepted");
  EXPECT_TRUE(fs::exists(root / "summary.json")) << "until the new run has its bodies";
  RunDirectory(root, true).clear();
  EXPECT_FALSE(fs::exists(root / "summary.json") || fs::exists(root / "history.csv") ||
               fs::exists(root / "report.html"));
  EXPECT_FALSE(fs::exists(root / "film.gif") || fs::exists(root / "picture.png") ||
               fs::exists(root / "fields.pvsm"));
  EXPECT_TRUE(fs::exists(root / "picture_of_mine.png"));
  EXPECT_FALSE(fs::exists(root / "fields.pvd") || fs::exists(root / "fields" / "bar_000010.vtu"));
  EXPECT_TRUE(fs::exists(root / "notes.txt") && fs::exists(root / "notes.vtu"));
  EXPECT_TRUE(fs::exists(root / "fields" / "mine_000010.vtu"));
  fs::remove(root / "fields" / "mine_000010.vtu");
  RunDirectory(root, true).clear();
  EXPECT_FALSE(fs::exists(root / "fields"));
}

TEST_F(RunFolder, WithFilesOfARunsNamesAndNoRunIsRefusedAndKept) {
  for (const char* name : {"history.csv", "report.html", "events.jsonl"}) {
    put(root / name / name);
    for (const bool force : {false, true})
      EXPECT_EQ(refusal(root / name, force),
                std::string("holds ") + name + ", and no run that could own it");
    EXPECT_EQ(text_of(root / name / name), "mine");
  }
}

TEST_F(RunFolder, SymbolicLinksAreNeverFollowed) {
  put(root / "mine.csv");
  put(root / "elsewhere" / "bar_000010.vtu");
  put(root / "run" / "summary.json");
  fs::create_symlink(root / "mine.csv", root / "run" / "history.csv");
  EXPECT_EQ(refusal(root / "run", true),
            "holds history.csv, which is no file of a run but a symbolic link");
  EXPECT_TRUE(fs::is_symlink(root / "run" / "history.csv"));
  fs::remove(root / "run" / "history.csv");
  put(root / "run" / "fields.pvd", "<DataSet file=\"fields/bar_000010.vtu\"/>");
  fs::create_directory_symlink(root / "elsewhere", root / "run" / "fields");
  RunDirectory(root / "run", true).clear();
  EXPECT_EQ(text_of(root / "elsewhere" / "bar_000010.vtu"), "mine");
  EXPECT_TRUE(fs::is_symlink(root / "run" / "fields")) << "no run has made it";
}

TEST_F(RunFolder, IsOfOneRunAtATime) {
  for (const bool force : {false, true}) {
    const RunDirectory first(root, true);
    EXPECT_EQ(refusal(root, force), "is in use by another run");
  }
  EXPECT_EQ(refusal(root, false), "accepted") << "as soon as the first one is over";
}

TEST_F(RunFolder, OfAKilledRunIsFree) {
  fs::create_directories(root);
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const RunDirectory mine(root, true);
    (void)!write(ready[1], "x", 1);
    pause();
  }
  char word = 0;
  ASSERT_EQ(read(ready[0], &word, 1), 1);
  EXPECT_EQ(refusal(root, true), "is in use by another run");
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(refusal(root, true), "accepted");
}

TEST_F(RunFolder, OfARunThatNeverBeginsGoesAwayUnlessItWasThere) {
  RunDirectory(root / "new", false).abandon();
  EXPECT_FALSE(fs::exists(root / "new"));
  fs::create_directories(root / "old");
  RunDirectory(root / "old", false).abandon();
  EXPECT_TRUE(fs::exists(root / "old"));
}

TEST_F(RunFolder, WithOtherFilesIsNobodysRun) {
  put(root / "notes.txt");
  EXPECT_EQ(refusal(root, false), "accepted");
}

TEST_F(RunFolder, BelowAFileIsRefused) {
  put(root / "file");
  EXPECT_EQ(refusal(root / "file" / "run", true),
            "cannot be a run directory: " + (root / "file").string() + " is a file");
}

TEST_F(RunFolder, WhereNobodyMayWriteIsRefused) {
  // Not even root makes directories in /proc.
  EXPECT_NE(refusal("/proc/abut/run", true), "accepted");
}

TEST(DefaultRunDirectory, IsNamedAfterTheScene) {
  EXPECT_EQ(default_run_directory("configs/two_bars.yaml"), fs::path("runs/two_bars"));
}

}  // namespace
}  // namespace abut
