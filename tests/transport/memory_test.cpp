// Goal: what spawned bodies say passes through memory that nothing is left of, with the same state
// at the end as through sockets; a solver that dies, stops or damages the memory is named. Oracle:
// state hashes of local bodies, the words of the errors, and /proc.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <variant>

#include "tests/transport/launched.hpp"

namespace abut::memory_test {
namespace {

class MemoryTest : public LaunchTest {
 protected:
  static constexpr std::int64_t here = 0;
  static std::string folder_of(std::int64_t process) {
    return "/proc/" + (process == here ? std::string("self") : std::to_string(process));
  }
  /// Mappings of shared memory in a process.
  static int mappings(std::int64_t process) {
    std::ifstream maps(folder_of(process) + "/maps");
    int count = 0;
    for (std::string line; std::getline(maps, line);)
      count += contains(line, "/memfd:abut") ? 1 : 0;
    return count;
  }
  /// Open files of that memory.
  static int files(std::int64_t process) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_of(process) + "/fd")) {
      std::error_code ignored;
      const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
      count += contains(target, "memfd:abut") ? 1 : 0;
    }
    return count;
  }
  void expect_state_of_local_ones() {
    FakeSubdomain left, right;
    EXPECT_EQ(play_both(*bodies_[0], *bodies_[1]), play_both(left, right));
  }
};

TEST_F(MemoryTest, EachProcessSharesItsOwnAndNoFileIsLeftOpen) {
  add_body("left");
  add_body("right");
  start();
  EXPECT_EQ(mappings(here), 2);
  EXPECT_EQ(files(here), 0);
  for (const std::int64_t id : ids_) {
    EXPECT_EQ(mappings(id), 1);
    EXPECT_EQ(files(id), 0);
  }
  expect_state_of_local_ones();
  EXPECT_EQ(error_within(2.0, [this] { launch_->finish(); }), "no error");
  bodies_.clear();
  launch_.reset();
  EXPECT_EQ(mappings(here), 0);
}

TEST_F(MemoryTest, WithSocketsNothingIsSharedAndTheStateIsTheSame) {
  scene_.network.transport = Transport::sockets;
  add_body("left");
  add_body("right");
  start();
  EXPECT_EQ(mappings(here), 0);
  EXPECT_EQ(mappings(ids_[0]), 0);
  expect_state_of_local_ones();
  EXPECT_EQ(error_within(2.0, [this] { launch_->finish(); }), "no error");
}

TEST_F(MemoryTest, ProgramsOfOthersAreTalkedToBySockets) {
  add_body("left");
  add_body("right");
  scene_.bodies[0].second.launch = SpawnLaunch{ABUT_FAKE_SOLVER};
  start();
  EXPECT_EQ(mappings(ids_[0]), 0);
  EXPECT_EQ(mappings(ids_[1]), 1);
  expect_state_of_local_ones();
}

TEST_F(MemoryTest, BodiesOfOneProcessShareOneMemory) {
  for (const char* name : {"left", "right"}) {
    add_body(name);
    scene_.bodies.back().second.launch = GroupLaunch{"both", ""};
  }
  start();
  EXPECT_EQ(mappings(here), 1);
  EXPECT_EQ(mappings(ids_[0]), 1);
  expect_state_of_local_ones();
}

TEST_F(MemoryTest, MessagesAboveItsSizePassInPieces) {
  text_ = std::string(9 * limit / 10, 'x');  // three times as long as the ring
  add_body("left");
  add_body("right");
  start();
  expect_state_of_local_ones();
}

TEST_F(MemoryTest, ASolverThatDamagesItIsNamed) {
  add_body("left", "scribble");
  start();
  const std::string error = error_within(2.0, [this] { advance_first(); });
  EXPECT_TRUE(
      contains(error, "body 'left' has left the memory that it shares with this process unsound") &&
      contains(error, "while at advance (request 2)"))
      << error;
}

TEST_F(MemoryTest, OneThatIsKilledWhileTheCoordinatorSleepsIsFoundAtOnce) {
  add_body("left", "stop");
  start();
  std::thread killer([this] {
    std::this_thread::sleep_for(Milliseconds(300));
    kill(static_cast<pid_t>(ids_[0]), SIGKILL);
  });
  // It is looked after ten times a second; the rest is for other programs on the cores.
  const std::string error = error_within(1.3, [this] { advance_first(); });
  killer.join();
  EXPECT_TRUE(
      contains(error, "body 'left' was killed by signal 9 (Killed) while at advance (request 2)"))
      << error;
}

TEST_F(MemoryTest, OneThatIsKilledWithHalfAMessageReadIsFoundAtOnce) {
  add_body("left");
  start();
  advance_first();
  kill(static_cast<pid_t>(ids_[0]), SIGSTOP);
  std::thread killer([this] {
    std::this_thread::sleep_for(Milliseconds(300));
    kill(static_cast<pid_t>(ids_[0]), SIGKILL);
  });
  const std::string error = error_within(1.3, [this] {
    const std::vector<std::byte> state(9 * limit / 10);
    bodies_[0]->resume(state);
  });
  killer.join();
  EXPECT_TRUE(contains(error, "body 'left' was killed by signal 9 (Killed) while at resume"))
      << error;
}

}  // namespace
}  // namespace abut::memory_test
