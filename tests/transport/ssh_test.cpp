// Goal: bodies over ssh, and those whose processes somebody else starts, behave as bodies of this
// machine; nothing that a scene says becomes an option of ssh or text of a shell. Oracle: state
// hashes of local bodies, the words of the command and of the errors. ssh is a script that runs the
// command here (tests/system/test_ssh.py has a real one).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/shell_word.hpp"
#include "base/yaml_fields.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/ssh_launch.hpp"
#include "messaging/child_process.hpp"
#include "tests/transport/launched.hpp"

namespace abut::ssh_test {
namespace {

namespace fs = std::filesystem;

/// Does what ssh is asked for on this machine: a link instead of a socket, a shell of its own.
constexpr const char* stand_in = R"(#!/bin/sh
before=
for word; do
  [ "$before" = -R ] && there=${word%%:*} here=${word#*:}
  before=$word
done
ln -s "$here" "$there"
exec sh -c "$word"
)";

class SshTest : public LaunchTest {
 protected:
  void SetUp() override {
    LaunchTest::SetUp();
    std::string name = (fs::temp_directory_path() / "abut-ssh-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    let_ssh_be(stand_in);
  }
  void TearDown() override {
    LaunchTest::TearDown();
    unsetenv("ABUT_SSH");
    // A shell that is killed removes no link; sshd would have closed its connection instead.
    for (const fs::directory_entry& entry : fs::directory_iterator("/tmp"))
      if (entry.is_symlink() && !fs::exists(entry.path()) &&
          entry.path().filename().string().starts_with("abut-"))
        fs::remove(entry.path());
    fs::remove_all(folder_);
  }
  void let_ssh_be(const std::string& script) const {
    const std::string program = folder_ + "/ssh";
    std::ofstream(program) << script;
    fs::permissions(program, fs::perms::owner_all);
    setenv("ABUT_SSH", program.c_str(), 1);
  }
  void add_far_body(const std::string& name, const std::string& group = "",
                    const std::string& manners = "") {
    add_body(name, manners);
    scene_.bodies.back().second.launch = SshLaunch{"node7", "", ABUT_FAKE_SOLVER, group};
  }

  std::string folder_;
};

TEST_F(SshTest, BodiesOverSshReachTheStateOfLocalOnes) {
  FakeSubdomain left, right;
  const std::vector<std::uint64_t> here = play_both(left, right);
  for (const std::string group : {"", "both"}) {
    scene_.bodies.clear();
    add_far_body("left", group);
    add_far_body("right", group);
    start();
    EXPECT_EQ(ids_.size(), group.empty() ? 2U : 1U);
    EXPECT_EQ(play_both(*bodies_[0], *bodies_[1]), here);
    launch_->finish();
  }
}

TEST_F(SshTest, OneHostIsAskedForNoMoreThanEightLoginsAtOnce) {
  // Each stays on its way for a while and counts those that are there beside it.
  let_ssh_be(
      "#!/bin/sh\n: > \"$0.$$\"\nls \"$0\".* | wc -l >> \"${0%ssh}counts\"\nsleep 0.2\n"
      "mv \"$0.$$\" \"${0%ssh}done.$$\"\nbefore=\n" +
      std::string(stand_in).substr(std::string(stand_in).find("for word")));
  for (int k = 0; k < 20; ++k) add_far_body("b" + std::to_string(k));
  start();
  EXPECT_EQ(ids_.size(), 20U);
  std::ifstream counts(folder_ + "/counts");
  int most = 0, lines = 0;
  for (int count = 0; counts >> count; ++lines) most = std::max(most, count);
  EXPECT_EQ(lines, 20);
  EXPECT_LE(most, 8);
  EXPECT_GT(most, 1) << "they log in side by side";
  launch_->finish();
}

TEST_F(SshTest, ABodyOfThisMachineStandsBesideOneOfAnother) {
  add_far_body("left");
  add_body("right");
  start();
  FakeSubdomain left, right;
  EXPECT_EQ(play_both(*bodies_[0], *bodies_[1]), play_both(left, right));
}

TEST_F(SshTest, WhoDiesThereIsNamedWithThePlace) {
  add_far_body("left", "", "crash");
  start();
  const std::string error = error_within(3.0, [this] { advance_first(); });
  EXPECT_TRUE(contains(error, "body 'left' was killed by signal 9 (Killed) at node7")) << error;
}

TEST_F(SshTest, WhatKeepsABodyFromComingIsSaidWithWhatToDo) {
  struct Case {
    const char *script, *words;
  };
  const Case cases[] = {
      {"#!/bin/sh\nexit 255\n",
       "lost its ssh to node7 (code 255) before it had connected | look at "
       "the words of ssh above; `ssh -o BatchMode=yes node7 true`"},
      {"#!/bin/sh\nexit 127\n",
       "exited with code 127 at node7 before it had connected | install "
       "abut there: `ssh node7 "},
      {"#!/bin/sh\nexit 3\n", "exited with code 3 at node7 before it had connected | look at"}};
  add_far_body("left");
  for (const Case& one : cases) {
    let_ssh_be(one.script);
    const std::string error = error_within(2.0, [this] { start(); });
    EXPECT_TRUE(contains(error, one.words)) << error;
  }
  setenv("ABUT_SSH", "/nowhere/ssh", 1);
  const std::string error = error_within(2.0, [this] { start(); });
  EXPECT_TRUE(contains(error, "cannot start /nowhere/ssh")) << error;
  EXPECT_TRUE(contains(error, "install ssh (openssh-client)")) << error;
}

TEST(SshCommand, AsksForNothingAndLendsOneSocket) {
  unsetenv("ABUT_SSH");
  const SshCommand command =
      ssh_command({"node7", "me", "", ""}, "/tmp/here/hub", "/tmp/there", {"--body", "it's"});
  EXPECT_EQ(command.program, "ssh");
  const std::vector<std::string> words{
      "-T",
      "-a",
      "-x",
      "-o",
      "BatchMode=yes",
      "-o",
      "ControlPath=none",
      "-o",
      "PermitLocalCommand=no",
      "-o",
      "ExitOnForwardFailure=yes",
      "-R",
      "/tmp/there:/tmp/here/hub",
      "-l",
      "me",
      "--",
      "node7",
      "exec sh -c 'trap \"rm -f $0\" EXIT; \"$@\"' '/tmp/there' 'abut-solver' --connect "
      "'ipc:///tmp/there' '--body' 'it'\\''s'"};
  EXPECT_EQ(command.arguments, words);
}

TEST(SshCommand, AWordStaysAWordWhateverItHolds) {
  for (const std::string word : {"plain", "", "two words", "it's", "$HOME `id` \"\\", "a\nb", "~",
                                 "a;b", "*", "{a,b}", "runs/two_bars-1", "Größe"}) {
    setenv("WORD", word.c_str(), 1);
    for (const std::string& written : {quoted_word(word), shell_word(word)}) {
      const std::string line = "test " + written + " = \"$WORD\"";
      EXPECT_EQ(std::system(line.c_str()), 0) << written;
    }
  }
  unsetenv("WORD");
  EXPECT_EQ(shell_word("runs/two_bars-1"), "runs/two_bars-1");
}

TEST(SshCommand, SocketsElsewhereAreDrawn) {
  const std::string one = far_socket(), other = far_socket();
  EXPECT_NE(one, other);
  EXPECT_EQ(one.size(), std::string("/tmp/abut-").size() + 32);  // 128 bits
}

/// What is wrong with launch: {ssh: {...}}; empty: nothing.
std::string wrong_with(const std::string& keys) {
  const Document document = Document::from_text("scene.yaml", "ssh: {" + keys + "}\n");
  try {
    read<SshLaunch>(document, "ssh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SshLaunch, TakesNamesAndNothingElse) {
  for (const char* keys : {"host: node7", "host: n", "host: node-7.cluster_a.example",
                           "host: 10.0.0.7", "host: a, user: me_2, program: /opt/abut-1.0/bin/x+y"})
    EXPECT_EQ(wrong_with(keys), "") << keys;
  for (const char* host : {"-oProxyCommand=id", "-", "''", "'a b'", "a;id", "'a$(id)'", "me@node7",
                           "'ssh://node7'", "'a/b'", "\"a\\nb\"", "'a%h'", ".a"})
    EXPECT_NE(wrong_with("host: " + std::string(host)).find("can be no machine's name"),
              std::string::npos)
        << host;
  EXPECT_NE(wrong_with("host: " + std::string(254, 'a')), "");
  for (const char* user : {"-l", "'a b'", "a@b", "'$(id)'"})
    EXPECT_NE(wrong_with("host: a, user: " + std::string(user)).find("can be no user's name"),
              std::string::npos)
        << user;
  for (const char* program :
       {"solver", "'/bin/sh -c id'", "'/a;id'", "'~/solver'", "-x", "\"/a'\""})
    EXPECT_NE(wrong_with("host: a, program: " + std::string(program)).find("is no whole path"),
              std::string::npos)
        << program;
}

class AwaitTest : public LaunchTest {
 protected:
  void await_at(const std::string& endpoint, double patience = 5.0) {
    options_.awaited = Awaited{endpoint, "", patience};
  }
};

TEST_F(AwaitTest, ProcessesThatSomebodyElseStartsReachTheStateOfLocalBodies) {
  FakeSubdomain left, right;
  const std::vector<std::uint64_t> here = play_both(left, right);
  const std::string endpoint = "tcp://127.0.0.1:27633";
  await_at(endpoint);
  for (const bool shared : {false, true}) {
    scene_.bodies.clear();
    add_body("left");
    add_body("right");
    std::vector<std::vector<std::string>> solvers{{"--body", "left"}, {"--body", "right"}};
    if (shared) {
      scene_.network.processes = 1;
      solvers = {{"--process", "process-0", "--body", "left", "--body", "right"}};
    }
    std::vector<std::unique_ptr<ChildProcess>> processes;
    for (std::vector<std::string>& words : solvers) {
      words.insert(words.begin(), {"--connect", endpoint});
      processes.push_back(std::make_unique<ChildProcess>(ABUT_FAKE_SOLVER, words));
    }
    start();
    EXPECT_TRUE(ids_.empty());
    EXPECT_EQ(play_both(*bodies_[0], *bodies_[1]), here);
    launch_->finish();
    for (const auto& process : processes) {
      EXPECT_TRUE(process->ended(Milliseconds(2'000)));
      EXPECT_TRUE(process->exited_with(0)) << process->ending();
    }
    launch_.reset();
  }
}

TEST_F(AwaitTest, AProcessThatNobodyStartsIsNamedWithItsCommand) {
  await_at("tcp://127.0.0.1:27634", 0.3);
  scene_.network.processes = 1;
  add_body("left");
  add_body("right");
  EXPECT_EQ(error_within(2.0, [this] { start(); }),
            "body 'left' did not connect to tcp://127.0.0.1:27634 within 0.3 s | start "
            "`abut-solver --connect tcp://127.0.0.1:27634 --process process-0 --body left --body "
            "right`");
}

TEST_F(AwaitTest, ABodyWithTheNameOfASharedProcessIsRefused) {
  await_at("tcp://127.0.0.1:27635");
  scene_.network.processes = 1;
  add_body("process-0");
  add_body("right");
  EXPECT_THROW(start(), InputError);
}

}  // namespace
}  // namespace abut::ssh_test
