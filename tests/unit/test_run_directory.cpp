// Goal: a run never overwrites what it was not told to. Oracle: the files themselves.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "base/error.hpp"
#include "coordinator/run_directory.hpp"
#include "tests/support/test_folder.hpp"

namespace abut::test_run_directory {
namespace {

namespace fs = std::filesystem;

class RunFolder : public TestFolder {
 protected:
  std::string refusal(const fs::path& directory, bool force) {
    try {
      RunDirectory(directory, force);
    } catch (const InputError& error) {
      return error.what_is_wrong;
    }
    return "accepted";
  }
};

TEST_F(RunFolder, IsMadeWithItsParents) {
  EXPECT_EQ(refusal(folder / "a" / "b", false), "accepted");
  EXPECT_TRUE(fs::is_directory(folder / "a" / "b"));
}

TEST_F(RunFolder, ThatHoldsARunIsRefusedAndKept) {
  for (const char* name : {"scene.resolved.yaml", "summary.json"}) {
    put(folder / name / name);
    put(folder / name / "history.csv");
    EXPECT_EQ(refusal(folder / name, false), "holds a run already");
    EXPECT_TRUE(fs::exists(folder / name / name));
    EXPECT_TRUE(fs::exists(folder / name / "history.csv"));
  }
}

TEST_F(RunFolder, ForcedLosesTheFilesOfTheRunAndNoOther) {
  for (const char* name : {"summary.json", "history.csv", "report.html", "film.gif", "fields.pvsm",
                           "picture.png", "picture_of_mine.png", "notes.txt",
                           "fields/bar_000010.vtu", "fields/mine_000010.vtu", "notes.vtu"})
    put(folder / name);
  // What a run has written is what its list names, and a list that was tampered with names no more.
  put(folder / "fields.pvd",
      "<DataSet file=\"fields/bar_000010.vtu\"/><DataSet file=\"fields/../notes.vtu\"/>"
      "<DataSet file=\"notes.txt\"/>");
  EXPECT_EQ(refusal(folder, true), "accepted");
  EXPECT_TRUE(fs::exists(folder / "summary.json")) << "until the new run has its bodies";
  RunDirectory(folder, true).clear();
  EXPECT_FALSE(fs::exists(folder / "summary.json") || fs::exists(folder / "history.csv") ||
               fs::exists(folder / "report.html"));
  EXPECT_FALSE(fs::exists(folder / "film.gif") || fs::exists(folder / "picture.png") ||
               fs::exists(folder / "fields.pvsm"));
  EXPECT_TRUE(fs::exists(folder / "picture_of_mine.png"));
  EXPECT_FALSE(fs::exists(folder / "fields.pvd") ||
               fs::exists(folder / "fields" / "bar_000010.vtu"));
  EXPECT_TRUE(fs::exists(folder / "notes.txt") && fs::exists(folder / "notes.vtu"));
  EXPECT_TRUE(fs::exists(folder / "fields" / "mine_000010.vtu"));
  fs::remove(folder / "fields" / "mine_000010.vtu");
  RunDirectory(folder, true).clear();
  EXPECT_FALSE(fs::exists(folder / "fields"));
}

TEST_F(RunFolder, WithFilesOfARunsNamesAndNoRunIsRefusedAndKept) {
  for (const char* name : {"history.csv", "report.html", "events.jsonl"}) {
    put(folder / name / name);
    for (const bool force : {false, true})
      EXPECT_EQ(refusal(folder / name, force),
                std::string("holds ") + name + ", and no run that could own it");
    EXPECT_EQ(bytes_of(folder / name / name), "mine");
  }
}

TEST_F(RunFolder, SymbolicLinksAreNeverFollowed) {
  put(folder / "mine.csv");
  put(folder / "elsewhere" / "bar_000010.vtu");
  put(folder / "run" / "summary.json");
  fs::create_symlink(folder / "mine.csv", folder / "run" / "history.csv");
  EXPECT_EQ(refusal(folder / "run", true),
            "holds history.csv, which is no file of a run but a symbolic link");
  EXPECT_TRUE(fs::is_symlink(folder / "run" / "history.csv"));
  fs::remove(folder / "run" / "history.csv");
  put(folder / "run" / "fields.pvd", "<DataSet file=\"fields/bar_000010.vtu\"/>");
  fs::create_directory_symlink(folder / "elsewhere", folder / "run" / "fields");
  EXPECT_EQ(refusal(folder / "run", true),
            "holds fields, which is no folder of a run but a symbolic link");
  EXPECT_EQ(bytes_of(folder / "elsewhere" / "bar_000010.vtu"), "mine");
  EXPECT_TRUE(fs::is_symlink(folder / "run" / "fields")) << "no run has made it";
}

TEST_F(RunFolder, IsOfOneRunAtATime) {
  for (const bool force : {false, true}) {
    const RunDirectory first(folder, true);
    EXPECT_EQ(refusal(folder, force), "is in use by another run");
  }
  EXPECT_EQ(refusal(folder, false), "accepted") << "as soon as the first one is over";
}

TEST_F(RunFolder, OfAKilledRunIsFree) {
  fs::create_directories(folder);
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const RunDirectory mine(folder, true);
    (void)!write(ready[1], "x", 1);
    pause();
  }
  char word = 0;
  ASSERT_EQ(read(ready[0], &word, 1), 1);
  EXPECT_EQ(refusal(folder, true), "is in use by another run");
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(refusal(folder, true), "accepted");
}

TEST_F(RunFolder, OfARunThatNeverBeginsGoesAwayUnlessItWasThere) {
  RunDirectory(folder / "new", false).abandon();
  EXPECT_FALSE(fs::exists(folder / "new"));
  fs::create_directories(folder / "old");
  RunDirectory(folder / "old", false).abandon();
  EXPECT_TRUE(fs::exists(folder / "old"));
}

TEST_F(RunFolder, WithOtherFilesIsNobodysRun) {
  put(folder / "notes.txt");
  EXPECT_EQ(refusal(folder, false), "accepted");
}

TEST_F(RunFolder, BelowAFileIsRefused) {
  put(folder / "file");
  EXPECT_EQ(refusal(folder / "file" / "run", true),
            "cannot be a run directory: " + (folder / "file").string() + " is a file");
}

TEST_F(RunFolder, WhereNobodyMayWriteIsRefused) {
  // Not even folder makes directories in /proc.
  EXPECT_NE(refusal("/proc/abut/run", true), "accepted");
}

TEST(DefaultRunDirectory, IsNamedAfterTheScene) {
  EXPECT_EQ(default_run_directory("configs/two_bars.yaml"), fs::path("runs/two_bars"));
}

}  // namespace
}  // namespace abut::test_run_directory
