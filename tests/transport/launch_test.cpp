// Goal: bodies in processes of their own behave as bodies in this one; whatever goes wrong is named
// within its deadline; no process is left behind. Oracle: state hashes of local bodies, the words
// of the errors, and kill(pid, 0).
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "coordinator/launch.hpp"
#include "messaging/child_process.hpp"
#include "messaging/zmq_channel.hpp"
#include "tests/transport/launched.hpp"

namespace abut::launch_test {
namespace {

TEST_F(LaunchTest, SpawnedBodiesReachTheStateOfLocalOnes) {
  add_body("left");
  add_body("right");
  start();
  FakeSubdomain left, right;
  EXPECT_EQ(play_both(*bodies_[0], *bodies_[1]), play_both(left, right));
  EXPECT_EQ(bodies_[0]->describe().name, "left");
  EXPECT_EQ(bodies_[1]->describe().name, "right");
  EXPECT_EQ(ids_.size(), 2U);
  launch_->finish();
}

TEST_F(LaunchTest, AConnectedBodyReachesTheStateOfALocalOneAndEndsWithCodeZero) {
  scene_.network.endpoint = "tcp://127.0.0.1:27613";
  add_body("left");
  add_body("right");
  scene_.bodies[1].second.launch = ConnectLaunch{5.0};
  // Started before anybody listens: the order does not matter.
  ChildProcess solver(ABUT_FAKE_SOLVER, {"--connect", scene_.network.endpoint, "--body", "right"});
  start();
  FakeSubdomain left, right;
  EXPECT_EQ(play_both(*bodies_[0], *bodies_[1]), play_both(left, right));
  launch_->finish();
  EXPECT_TRUE(solver.ended(Milliseconds(2'000)));
  EXPECT_TRUE(solver.exited_with(0)) << solver.ending();
}

TEST_F(LaunchTest, AKilledSolverIsNamedWithSignalAndRequest) {
  add_body("left");
  start();
  advance_first();
  kill(static_cast<pid_t>(ids_[0]), SIGKILL);
  const std::string error = error_within(2.0, [this] { advance_first(); });
  EXPECT_TRUE(
      contains(error, "body 'left' was killed by signal 9 (Killed) while at advance (request 3)"))
      << error;
}

TEST_F(LaunchTest, ASolverThatDiesInTheMiddleOfASolveIsNamed) {
  add_body("left", "crash");
  start();
  const std::string error = error_within(2.0, [this] { advance_first(); });
  EXPECT_TRUE(
      contains(error, "body 'left' was killed by signal 9 (Killed) while at advance (request 2)"))
      << error;
}

TEST_F(LaunchTest, ASpawnedSolverThatNeverConnectsIsGivenUpAtTheStartupDeadline) {
  scene_.network.startup_deadline = 0.3;
  add_body("left", "never");
  add_body("right");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(contains(error, "body 'left' did not connect to ipc://")) << error;
  EXPECT_TRUE(contains(error, "within 0.3 s | raise network.startup_deadline")) << error;
}

TEST_F(LaunchTest, ABodyThatNobodyStartsIsNamedWithTheCommandThatIsMissing) {
  add_body("left");
  scene_.network.endpoint = "tcp://127.0.0.1:27614";
  scene_.bodies[0].second.launch = ConnectLaunch{0.3};
  EXPECT_EQ(
      error_within(2.0, [this] { start(); }),
      "body 'left' did not connect to tcp://127.0.0.1:27614 within 0.3 s | start `abut-solver "
      "--connect tcp://127.0.0.1:27614 --body left`");
}

TEST_F(LaunchTest, ASolverThatExitsAtOnceIsNamedWithItsCode) {
  add_body("left", "exit");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(
      contains(error, "the solver of body 'left' exited with code 7 before it had connected"))
      << error;
}

TEST_F(LaunchTest, AProgramThatDoesNotExistIsNamed) {
  options_.solver = "/nowhere/abut-solver";
  add_body("left");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(contains(error, "cannot start /nowhere/abut-solver: No such file or directory"))
      << error;
}

TEST_F(LaunchTest, AnotherProtocolVersionIsRefusedWithBothVersions) {
  add_body("left", "old_version");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(contains(error, "the solver of body 'left' (build 9.9.9) speaks protocol 3"))
      << error;
  EXPECT_TRUE(contains(error, "speaks protocol 4")) << error;
}

TEST_F(LaunchTest, AStrangeFirstFrameIsNamedWithItsSize) {
  add_body("left", "babble");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(contains(error,
                       "body 'left' did not say hello: its first frame, of 99 bytes (limit "
                       "1000000), is corrupt"))
      << error;
}

TEST_F(LaunchTest, CorruptRepliesAreNamedWithSizeAndLimit) {
  add_body("left", "corrupt");
  start();
  const std::string error = error_within(2.0, [this] { advance_first(); });
  EXPECT_TRUE(contains(error, "body 'left' sent 16 corrupt frames while at advance (request 2)"))
      << error;
  EXPECT_TRUE(contains(error, "(limit 1000000 bytes)")) << error;
}

TEST_F(LaunchTest, AnOversizedReplyIsNamedWithSizeAndLimit) {
  add_body("left", "oversized");
  start();
  const std::string error = error_within(2.0, [this] { advance_first(); });
  EXPECT_TRUE(contains(error,
                       "body 'left' sent a frame of 1500000 bytes while at advance (request 2); "
                       "the limit is 1000000 bytes"))
      << error;
}

TEST_F(LaunchTest, AFrameThatEndsTheConnectionIsNamedWithTheLimit) {
  add_body("left", "huge");
  start();
  const std::string error = error_within(6.0, [this] { advance_first(); });
  EXPECT_TRUE(contains(error, "body 'left' ") && contains(error, "limit of 1000000 bytes") &&
              contains(error, "while at advance (request 2)"))
      << error;
}

TEST_F(LaunchTest, AFrameThatEndsATcpConnectionAgainAndAgainIsNamedWithTheLimit) {
  scene_.network.endpoint = "tcp://127.0.0.1:27616";
  add_body("left", "huge");
  scene_.bodies[0].second.launch = ConnectLaunch{5.0};
  ChildProcess solver(ABUT_FAKE_SOLVER, {"--connect", scene_.network.endpoint, "--body", "left"});
  start();
  const std::string error = error_within(6.0, [this] { advance_first(); });
  EXPECT_TRUE(contains(error,
                       "body 'left' lost its connection 3 times (a frame far above the limit "
                       "of 1000000 bytes ends a connection) while at advance (request 2)"))
      << error;
}

TEST_F(LaunchTest, AConnectedSolverThatIsKilledIsGivenUpWhenItDoesNotComeBack) {
  scene_.network.endpoint = "tcp://127.0.0.1:27617";
  options_.deadlines.reconnect = Milliseconds(300);
  add_body("left");
  scene_.bodies[0].second.launch = ConnectLaunch{5.0};
  ChildProcess solver(ABUT_FAKE_SOLVER, {"--connect", scene_.network.endpoint, "--body", "left"});
  start();
  advance_first();
  solver.send_signal(SIGKILL);
  const std::string error = error_within(3.0, [this] { advance_first(); });
  EXPECT_TRUE(contains(error,
                       "body 'left' closed its connection and did not come back within 0.3 s "
                       "while at advance (request 3)"))
      << error;
}

TEST_F(LaunchTest, ASolverLeavesWhenItsCoordinatorEndsEarly) {
  scene_.network.endpoint = "tcp://127.0.0.1:27618";
  add_body("left");
  scene_.bodies[0].second.launch = ConnectLaunch{5.0};
  ChildProcess solver(ABUT_FAKE_SOLVER, {"--connect", scene_.network.endpoint, "--body", "left"});
  start();
  advance_first();
  bodies_.clear();
  launch_.reset();
  EXPECT_TRUE(solver.ended(Milliseconds(2'000)));
  EXPECT_EQ(solver.ending(), "exited with code 3");
}

TEST_F(LaunchTest, ASolverLeavesWhenItsCoordinatorVanishesInTheMiddleOfASolve) {
  // The socket of the hub alone goes away: no refusal, no signal, as when a machine dies.
  const Limits limits;
  std::unique_ptr<ZmqHub> hub = std::make_unique<ZmqHub>(limits);
  const int peer = hub->add_peer("left");
  add_body("left", "slow");
  std::string directory = "/tmp/abut-test-XXXXXX";
  ASSERT_NE(mkdtemp(directory.data()), nullptr);
  const std::string endpoint = hub->bind("ipc://" + directory + "/hub");
  ChildProcess solver(ABUT_FAKE_SOLVER, {"--connect", endpoint, "--body", "left"});
  const std::optional<Bytes> greeting = hub->channel(peer).receive(Milliseconds(5'000));
  v1::Reply hello;
  ASSERT_TRUE(greeting && parse_into(hello, *open_frame(*greeting)));
  AlwaysAlive alive;
  Caller caller("left", CallContext{hub->channel(peer), alive, nullptr, limits, Deadlines{}});
  caller.accept_session(hello.hello().session());
  RemoteSubdomain body(caller);
  body.start_configure(Specification{});
  body.finish_configure();
  const Advance advance = request_for(0);
  body.start(advance);
  hub.reset();
  // The solve alone takes 2.5 s; the next sign of progress finds nobody.
  EXPECT_TRUE(solver.ended(Milliseconds(1'500)));
  EXPECT_EQ(solver.ending(), "exited with code 3");
  std::filesystem::remove_all(directory);
}

TEST_F(LaunchTest, ASolverThatLivesButNeverAnswersIsGivenUpAtTheDeadline) {
  scene_.network.request_deadline = 0.5;
  add_body("left", "mute");
  start();
  const std::string error = error_within(2.0, [this] { advance_first(); });
  EXPECT_TRUE(contains(error, "body 'left' has not answered advance (request 2) within 0.5 s"))
      << error;
}

TEST_F(LaunchTest, ALongSolveThatShowsProgressIsNoDeath) {
  scene_.network.request_deadline = 0.8;  // ten substeps of 0.25 s take 2.5 s
  add_body("left", "slow");
  start();
  EXPECT_EQ(error_within(5.0, [this] { advance_first(); }), "no error");
  launch_->finish();
}

TEST_F(LaunchTest, AStubbornSolverIsEndedAllTheSame) {
  add_body("left", "stubborn");
  start();
  advance_first();
  EXPECT_EQ(error_within(5.0, [this] { launch_->finish(); }), "no error");
}

TEST_F(LaunchTest, TheBodysInputErrorComesThroughTheWire) {
  text_ = "no such key";
  add_body("left");
  add_body("right");
  try {
    start();
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what_is_wrong, "unknown key");
    EXPECT_EQ(error.where, "bodies.left");
  }
}

TEST_F(LaunchTest, TheErrorsOfAllBodiesComeAtOnceInTheOrderOfTheScene) {
  text_ = "no such key";
  for (const char* name : {"left", "middle", "right"}) add_body(name);
  try {
    start();
    FAIL() << "no error";
  } catch (const InputErrorList& errors) {
    ASSERT_EQ(errors.all.size(), 3u);
    EXPECT_EQ(errors.all[0].where, "bodies.left");
    EXPECT_EQ(errors.all[1].where, "bodies.middle");
    EXPECT_EQ(errors.all[2].where, "bodies.right");
  }
}

TEST_F(LaunchTest, ABodyThatIsRefusedDoesNotWaitForOneThatSomebodyElseStarts) {
  text_ = "no such key";
  add_body("right");
  add_body("left");
  scene_.bodies[0].second.launch = ConnectLaunch{30.0};
  const TimePoint begin = std::chrono::steady_clock::now();
  EXPECT_THROW(start(), InputError);
  // A process starts and answers; the other is never there.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST_F(LaunchTest, ASolverWithANameThatTheSceneDoesNotHaveIsRefused) {
  scene_.network.endpoint = "tcp://127.0.0.1:27615";
  add_body("left");
  scene_.bodies[0].second.launch = ConnectLaunch{0.5};
  ChildProcess stranger(ABUT_FAKE_SOLVER,
                        {"--connect", scene_.network.endpoint, "--body", "middle"});
  error_within(2.0, [this] { start(); });
  EXPECT_TRUE(stranger.ended(Milliseconds(2'000)));
  EXPECT_EQ(stranger.ending(), "exited with code 3");
}

TEST_F(LaunchTest, AnAddressThatIsTakenIsTheUsersError) {
  scene_.network.endpoint = "tcp://192.0.2.1:5555";  // reserved for documentation: no machine's own
  add_body("left");
  scene_.bodies[0].second.launch = ConnectLaunch{0.5};
  EXPECT_THROW(start(), InputError);
}

TEST_F(LaunchTest, AnInterruptEndsTheWaitAndTheProcesses) {
  const std::atomic<bool> interrupted{true};
  options_.interrupted = &interrupted;
  add_body("left", "never");
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(contains(error, "interrupted before body 'left' had connected")) << error;
}

TEST(LaunchedProcess, DiesWithTheCoordinatorThatWasKilled) {
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const pid_t coordinator = fork();
  if (coordinator == 0) {
    Scene scene;
    BodyEntry entry;
    entry.name = "left";
    scene.bodies.emplace_back("left", entry);
    LaunchOptions options;
    options.solver = ABUT_FAKE_SOLVER;
    Launch launch(scene, Specification{"scene.yaml", "scene", {}, ""}, options);
    const pid_t solver = static_cast<pid_t>(launch.process_ids().at(0));
    if (write(report[1], &solver, sizeof solver) != sizeof solver) _exit(1);
    pause();
  }
  pid_t solver = 0;
  ASSERT_EQ(::read(report[0], &solver, sizeof solver), static_cast<ssize_t>(sizeof solver));
  kill(coordinator, SIGKILL);
  bool gone = false;
  for (int i = 0; i < 200 && !gone; ++i) {
    usleep(10'000);
    // An orphan is reaped by init; where there is none it stays a zombie, which runs nothing.
    gone = kill(solver, 0) != 0;
    if (!gone) {
      std::FILE* stat = std::fopen(("/proc/" + std::to_string(solver) + "/stat").c_str(), "r");
      char state = 'Z';
      if (stat != nullptr) {
        if (std::fscanf(stat, "%*d %*s %c", &state) != 1) state = 'Z';
        std::fclose(stat);
      }
      gone = state == 'Z';
    }
  }
  EXPECT_TRUE(gone);
  close(report[0]);
  close(report[1]);
}

}  // namespace
}  // namespace abut::launch_test
