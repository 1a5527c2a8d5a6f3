// Goal: what a run left is read back whole, or refused with the reason. Oracle: the bytes written.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/record/checkpoint_file.hpp"
#include "tests/support/test_folder.hpp"

namespace abut::test_checkpoint_file {
namespace {

namespace fs = std::filesystem;

class CheckpointFiles : public TestFolder {
 protected:
  static Checkpoint sample(double time) {
    Checkpoint kept;
    kept.version = "1.2.3";
    kept.scene = "time: {end: 1}\n";
    kept.time = time;
    kept.windows = 17;
    kept.run = std::string("a\0b", 3);
    kept.bodies = {{"left", "state of left", -5}, {"right", "", 7}};
    kept.records = {{"history", "42", 0}};
    return kept;
  }
  void write(double time) const {
    Checkpoint kept = sample(time);
    write_checkpoint(folder, kept);
  }
  std::string refusal() const {
    std::vector<std::string> warnings;
    try {
      read_checkpoint(folder, warnings);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  const fs::path latest = folder / latest_checkpoint, earlier = folder / earlier_checkpoint;
};

TEST_F(CheckpointFiles, HoldWhatWasWritten) {
  write(0.25);
  std::vector<std::string> warnings;
  const Checkpoint read = read_checkpoint(folder, warnings);
  const Checkpoint kept = sample(0.25);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(read.version, kept.version);
  EXPECT_EQ(read.scene, kept.scene);
  EXPECT_EQ(read.time, kept.time);
  EXPECT_EQ(read.windows, kept.windows);
  EXPECT_EQ(read.run, kept.run);
  ASSERT_EQ(read.bodies.size(), 2u);
  EXPECT_EQ(read.bodies[0].name, "left");
  EXPECT_EQ(read.bodies[0].state, "state of left");
  EXPECT_EQ(read.bodies[0].fingerprint, -5);
  ASSERT_NE(read.record("history"), nullptr);
  EXPECT_EQ(read.record("history")->state, "42");
  EXPECT_EQ(read.record("fields"), nullptr);
}

TEST_F(CheckpointFiles, KeepTheLatestTwo) {
  for (const double time : {1.0, 2.0, 3.0}) write(time);
  EXPECT_EQ(parse_checkpoint(bytes_of(latest), "").time, 3.0);
  EXPECT_EQ(parse_checkpoint(bytes_of(earlier), "").time, 2.0);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2);
}

TEST_F(CheckpointFiles, OverwriteWhatAKilledRunLeftUnfinishedAndFollowNoLink) {
  put(folder / "mine", "mine");
  fs::create_symlink(folder / "mine", folder / unfinished_checkpoint);
  write(1.0);
  EXPECT_EQ(bytes_of(folder / "mine"), "mine");
  EXPECT_EQ(parse_checkpoint(bytes_of(latest), "").time, 1.0);
}

/// Of a file that any byte of was changed, or that was cut anywhere, nothing is used.
TEST_F(CheckpointFiles, LeaveNothingBehindWhereTheirNameIsTaken) {
  fs::create_directory(latest);
  EXPECT_THROW(write(1.0), RunError);
  EXPECT_FALSE(fs::exists(folder / unfinished_checkpoint));
}

TEST_F(CheckpointFiles, AreRefusedWhereAByteIsAnother) {
  write(1.0);
  const std::string whole = bytes_of(latest);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    std::string damaged = whole;
    damaged[k] = static_cast<char>(damaged[k] ^ 0x40);
    EXPECT_THROW(parse_checkpoint(damaged, "f"), InputError) << k;
    EXPECT_THROW(parse_checkpoint(whole.substr(0, k), "f"), InputError) << k;
  }
  EXPECT_THROW(parse_checkpoint(whole + "x", "f"), InputError);
}

TEST_F(CheckpointFiles, OfTwoTheEarlierIsUsedWhereTheLatestIsDamaged) {
  write(1.0);
  write(2.0);
  put(latest, "abut checkpoint, form 1\nxxxxxxxxxx");
  std::vector<std::string> warnings;
  EXPECT_EQ(read_checkpoint(folder, warnings).time, 1.0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("is damaged"), std::string::npos) << warnings[0];
  put(earlier, "of another form");
  EXPECT_NE(refusal().find("is damaged"), std::string::npos) << refusal();
  fs::remove(latest);
  EXPECT_NE(refusal().find("is no checkpoint that this version can read"), std::string::npos);
  fs::remove(earlier);
  EXPECT_NE(refusal().find("holds no checkpoint"), std::string::npos) << refusal();
}

TEST_F(CheckpointFiles, FingerprintsDifferWithWhatAStateDependsOn) {
  Description body;
  body.mass = 1.0;
  body.dofs = 6;
  body.ports = {{"tip", {}, false}};
  body.ports[0].geometry.points = {0.0, 1.0};
  const std::int64_t print = fingerprint(body);
  body.step = 3.0;  // may change
  body.mass = 2.0;  // a sum
  EXPECT_EQ(fingerprint(body), print);
  std::vector<Description> others(4, body);
  others[0].dofs = 7;
  others[1].ports[0].geometry.points[1] = 1.5;
  others[2].columns = {"clamp.reaction [N]"};
  others[3].ports[0].name = "top";
  for (const Description& other : others) EXPECT_NE(fingerprint(other), print);
}

}  // namespace
}  // namespace abut::test_checkpoint_file
