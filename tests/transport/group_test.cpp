// Goal: bodies that share a process behave as bodies in processes of their own; one that waits for
// its turn is not lost, and one process that is lost is told of with all its bodies. Oracle: state
// hashes of local bodies, the words of the errors, and the number of processes.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "tests/transport/launched.hpp"

namespace abut::group_test {
namespace {

class GroupTest : public LaunchTest {
 protected:
  void add_to(const std::string& group, const std::string& name, const std::string& manners = "") {
    add_body(name, manners);
    scene_.bodies.back().second.launch = GroupLaunch{group, ""};
  }
  /// A window of every body, all begun before the first is waited for; the last one first.
  void advance_all(int window) {
    const Advance advance = request_for(window);
    for (const std::unique_ptr<Subdomain>& body : bodies_) body->start(advance);
    Response response;
    for (auto body = bodies_.rbegin(); body != bodies_.rend(); ++body)
      EXPECT_TRUE(std::holds_alternative<Advanced>((*body)->finish(response)));
  }
  std::uint64_t hash_of_local(int windows) {
    FakeSubdomain local;
    Response response;
    for (int window = 0; window < windows; ++window)
      EXPECT_TRUE(std::holds_alternative<Advanced>(local.advance(request_for(window), response)));
    return local.state_hash();
  }
};

TEST_F(GroupTest, BodiesReachTheStateOfLocalOnesWhereverTheyLive) {
  struct Placement {
    std::vector<std::string> groups;  // of the bodies a, b, c; empty: none
    int dealt_to;
    std::size_t processes;
  };
  const Placement placements[] = {{{"", "", ""}, 0, 3},          {{"g", "g", "g"}, 0, 1},
                                  {{"g", "", "g"}, 0, 2},        {{"g", "h", "g"}, 0, 2},
                                  {{"left half", "", ""}, 0, 3}, {{"", "", ""}, 2, 2},
                                  {{"", "g", ""}, 1, 2},         {{"", "", ""}, 64, 3}};
  const std::uint64_t local = hash_of_local(20);
  for (const Placement& placement : placements) {
    scene_.bodies.clear();
    scene_.network.processes = placement.dealt_to;
    for (std::size_t b = 0; b < 3; ++b) {
      const std::string name(1, static_cast<char>('a' + b));
      placement.groups[b].empty() ? add_body(name) : add_to(placement.groups[b], name);
    }
    start();
    EXPECT_EQ(ids_.size(), placement.processes);
    for (int window = 0; window < 20; ++window) advance_all(window);
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_EQ(bodies_[b]->describe().name, scene_.bodies[b].first);
      EXPECT_EQ(bodies_[b]->state_hash(), local);
    }
    EXPECT_EQ(error_within(2.0, [this] { launch_->finish(); }), "no error");
  }
}

TEST_F(GroupTest, RewindsOfOneBodyAreNotThoseOfAnother) {
  add_to("g", "left");
  add_to("g", "right");
  start();
  FakeSubdomain left, right;
  EXPECT_EQ(play_both(*bodies_[0], *bodies_[1]), play_both(left, right));
}

TEST_F(GroupTest, OneTextOfTheSceneServesAllBodiesOfAProcess) {
  for (const char* name : {"a", "b", "c"}) add_to("g", name, "wants_scene");
  try {
    start();
    FAIL() << "the second body had the text as well";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where, "bodies.b");
  }
}

// Ten substeps of 0.25 s: the others wait three times as long as a reply may take, and nothing is
// sent again, because no repeat is due within the test.
TEST_F(GroupTest, BodiesThatWaitForALongSolveOfAnotherAreNotLost) {
  scene_.network.request_deadline = 0.8;
  options_.deadlines.repeat = Milliseconds(60'000);
  add_to("g", "slow", "slow");
  for (int b = 0; b < 400; ++b) add_to("g", "quick" + std::to_string(b));
  start();
  EXPECT_EQ(error_within(6.0, [this] { advance_all(0); }), "no error");
  EXPECT_EQ(bodies_.back()->state_hash(), hash_of_local(1));
  EXPECT_EQ(error_within(3.0, [this] { launch_->finish(); }), "no error");
}

TEST_F(GroupTest, BodiesThatWaitForOneThatNeverAnswersAreGivenUpAtTheDeadline) {
  scene_.network.request_deadline = 0.5;
  add_to("g", "mute", "mute");
  add_to("g", "quick");
  start();
  const std::string error = error_within(2.0, [this] { advance_all(0); });
  EXPECT_TRUE(contains(error, "body 'quick' has not answered advance (request 2) within 0.5 s"))
      << error;
}

TEST_F(GroupTest, ALostProcessIsNamedWithAllItsBodies) {
  for (const char* name : {"a", "b", "c"}) add_to("g", name);
  add_body("alone");
  start();
  advance_all(0);
  kill(static_cast<pid_t>(ids_[0]), SIGKILL);
  const std::string error = error_within(2.0, [this] { advance_all(1); });
  EXPECT_TRUE(contains(error,
                       "body 'c' shares a process with a, b, which was killed by signal 9 (Killed) "
                       "while at advance (request 3)"))
      << error;
}

TEST_F(GroupTest, AnotherBodyThatEndsTheProcessInTheMiddleOfItsSolveIsAmongThoseNamed) {
  add_to("g", "quick");
  add_to("g", "wild", "crash");
  add_to("g", "last");
  start();
  const std::string error = error_within(2.0, [this] { advance_all(0); });
  EXPECT_TRUE(contains(error, "body 'last' shares a process with quick, wild, which was killed by"))
      << error;
}

TEST_F(GroupTest, OfManyBodiesInALostProcessTwentyAreNamed) {
  for (int b = 0; b < 31; ++b) add_to("g", "b" + std::to_string(b), b == 30 ? "crash" : "");
  start();
  const std::string error = error_within(2.0, [this] { advance_all(0); });
  EXPECT_TRUE(contains(error, "body 'b30' shares a process with b0, b1, ") &&
              contains(error, "b19 and 10 more bodies, which was killed"))
      << error;
}

TEST_F(GroupTest, AProcessThatExitsAtOnceIsNamedWithItsBodies) {
  add_to("g", "left", "exit");
  add_to("g", "right");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(
      contains(error, "the solver of body 'left' and of right exited with code 7 before it had"))
      << error;
}

TEST_F(GroupTest, AnInterruptEndsTheWaitAndTheProcess) {
  const std::atomic<bool> interrupted{true};
  options_.interrupted = &interrupted;
  add_to("g", "left", "never");
  add_to("g", "right");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(contains(error, "interrupted before body 'left' had connected")) << error;
}

}  // namespace
}  // namespace abut::group_test
