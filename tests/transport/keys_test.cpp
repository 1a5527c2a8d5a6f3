// Goal: who comes in without the key of a body is nobody, whatever he says he is, and costs those
// who have keys nothing; key files that others may read or change are refused. Oracle: the frames
// that come out of the hub, by body and by their bytes; the words of the errors.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "messaging/key_files.hpp"
#include "messaging/zmq_channel.hpp"
#include "messaging/zmq_dealer.hpp"

namespace abut::keys_test {
namespace {

namespace fs = std::filesystem;

class Keys : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "abut-keys-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    keys_ = name + "/keys";
  }
  void TearDown() override { fs::remove_all(folder_); }

  void make(const std::vector<std::string>& bodies) const { write_keys(keys_, bodies); }
  std::string file(const std::string& name) const { return keys_ + "/" + name; }

  static std::string text_of(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void write(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
  }
  static std::string refusal(const std::function<void()>& act) {
    try {
      act();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  fs::path folder_;
  std::string keys_;
};

class KeyFiles : public Keys {
 protected:
  std::string coordinator_says(const std::vector<std::string>& bodies = {"left", "right"}) const {
    return refusal([&] { read_coordinator_keys(keys_, bodies); });
  }
  std::string left_says() const {
    return refusal([&] { read_body_keys(keys_, "left"); });
  }
};

TEST_F(KeyFiles, BothEndsReadWhatWasWritten) {
  make({"left", "right"});
  const CoordinatorKeys all = read_coordinator_keys(keys_, std::vector<std::string>{"left"});
  const BodyKeys left = read_body_keys(keys_, "left");
  EXPECT_EQ(left.coordinator, all.own.public_key);
  ASSERT_EQ(all.bodies.size(), 1u) << "those that are asked for";
  EXPECT_EQ(all.bodies.at(left.own.public_key), "left");
  EXPECT_NE(left.own.secret_key, all.own.secret_key);
  for (const char* name : {"coordinator", "left", "right"}) {
    struct stat about {};
    ASSERT_EQ(stat(file(std::string(name) + ".key_secret").c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777, 0600u) << name;
    EXPECT_EQ(text_of(file(std::string(name) + ".key")).find("secret"), std::string::npos);
  }
}

TEST_F(KeyFiles, NothingIsOverwritten) {
  make({"left"});
  const std::string before = text_of(file("left.key_secret"));
  EXPECT_NE(refusal([this] {
              make({"right", "left"});
            }).find("is there already"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(file("right.key"))) << "all or none";
  EXPECT_NE(refusal([this] { make({}); }).find("coordinator.key_secret: is there already"),
            std::string::npos);
  make({"right"});  // beside the others
  EXPECT_EQ(text_of(file("left.key_secret")), before);
  EXPECT_EQ(coordinator_says(), "accepted");
}

TEST_F(KeyFiles, NamesThatLeaveTheFolderAreRefused) {
  for (const char* name : {"../left", "a/b", "", ".left", "coordinator"})
    EXPECT_NE(refusal([&] { make({name}); }).find("can be no body with a key"), std::string::npos)
        << name;
  EXPECT_FALSE(fs::exists(keys_));
}

TEST_F(KeyFiles, WhatOthersMayReadOrChangeIsRefusedWithTheRemedy) {
  make({"left", "right"});
  const auto opened = [this](const std::string& path, mode_t mode, bool by_body) {
    struct stat about {};
    EXPECT_EQ(stat(path.c_str(), &about), 0);
    EXPECT_EQ(chmod(path.c_str(), mode), 0);
    const std::string said = by_body ? left_says() : coordinator_says();
    EXPECT_EQ(chmod(path.c_str(), about.st_mode & 0777), 0);
    return said;
  };
  const std::string secret = file("left.key_secret"), open = file("left.key");
  EXPECT_EQ(opened(secret, 0640, true),
            secret +
                ": may be read or written by other users: its permissions are 640. Close it: "
                "chmod go-rwx " +
                secret + ".");
  EXPECT_EQ(opened(open, 0664, false),
            open +
                ": may be written by other users: its permissions are 664. Close it: chmod go-w " +
                open + ".");
  EXPECT_EQ(opened(keys_, 0777, true),
            keys_ +
                ": may be written by other users: its permissions are 777. Close it: chmod go-w " +
                keys_ + ".");
  EXPECT_EQ(left_says() + coordinator_says(), "acceptedaccepted");
}

TEST_F(KeyFiles, WhatIsNoKeyIsRefused) {
  EXPECT_NE(left_says().find("abut keygen"), std::string::npos);
  make({"left", "right"});
  EXPECT_NE(coordinator_says({"left", "middle"}).find("middle.key: cannot be read"),
            std::string::npos);
  const std::string own = text_of(file("left.key_secret")),
                    other = text_of(file("right.key_secret"));
  write(file("left.key_secret"), own.substr(0, own.size() / 2));
  EXPECT_NE(left_says().find("left.key_secret: has no "), std::string::npos);
  const std::size_t at = own.find("    secret-key");
  write(file("left.key_secret"), own.substr(0, at) + other.substr(other.find("    secret-key")));
  EXPECT_NE(left_says().find("does not belong to its secret one"), std::string::npos);
  write(file("right.key"), text_of(file("left.key")));
  EXPECT_NE(coordinator_says().find("right.key: holds the key of left as well"), std::string::npos);
  write(file("right.key"), text_of(file("coordinator.key")));
  EXPECT_NE(coordinator_says().find("right.key: holds the key of coordinator as well"),
            std::string::npos);
}

/// A hub that waits for left and right, both with keys; spare has one as well, and is no body.
class KeyedHub : public Keys {
 protected:
  void SetUp() override {
    Keys::SetUp();
    make({"left", "right", "spare"});
    left_ = hub_.add_peer("left");
    right_ = hub_.add_peer("right");
    endpoint_ = hub_.bind("tcp://127.0.0.1:*",
                          read_coordinator_keys(keys_, std::vector<std::string>{"left", "right"}));
  }

  std::unique_ptr<ZmqDealer> dealer(const std::string& body) const {
    return std::make_unique<ZmqDealer>(endpoint_, body, Limits{}, 1, Access{keys_, false});
  }
  /// Somebody's own program: any name with any key.
  zmq::socket_t program(const std::string& name, const std::string& key) {
    zmq::socket_t socket(context_, zmq::socket_type::dealer);
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::routing_id, name);
    if (!key.empty()) {
      const BodyKeys keys = read_body_keys(keys_, key);
      socket.set(zmq::sockopt::curve_serverkey, keys.coordinator);
      socket.set(zmq::sockopt::curve_publickey, keys.own.public_key);
      socket.set(zmq::sockopt::curve_secretkey, keys.own.secret_key);
    }
    socket.connect(endpoint_);
    return socket;
  }
  static void send(zmq::socket_t& socket, const std::string& text) {
    socket.send(zmq::buffer(text), zmq::send_flags::dontwait);
  }
  static void send(ZmqDealer& from, const std::string& text) { from.send(bytes(text)); }
  static Bytes bytes(const std::string& text) { return std::as_bytes(std::span(text)); }
  static std::string text(const std::optional<Bytes>& frame) {
    if (!frame) return "nothing";
    return {reinterpret_cast<const char*>(frame->data()), frame->size()};
  }
  std::string hears(int peer, int milliseconds = 5000) {
    return text(hub_.channel(peer).receive(Milliseconds(milliseconds)));
  }
  /// What the hub sends to the peer arrives there.
  bool reaches(int peer, ZmqDealer& there, const std::string& word) {
    for (int k = 0; k < 100; ++k) {
      hub_.channel(peer).send(bytes(word));
      if (text(there.receive(Milliseconds(50))) == word) return true;
      hub_.pump(Milliseconds(0));
    }
    return false;
  }

  zmq::context_t context_;
  ZmqHub hub_{Limits{}};
  int left_ = -1, right_ = -1;
  std::string endpoint_;
};

TEST_F(KeyedHub, BodiesWithTheirKeysAreHeardAndReached) {
  const auto left = dealer("left"), right = dealer("right");
  send(*left, "from left");
  send(*right, "from right");
  EXPECT_EQ(hears(left_), "from left");
  EXPECT_EQ(hears(right_), "from right");
  EXPECT_TRUE(reaches(left_, *left, "to left"));
  EXPECT_TRUE(reaches(right_, *right, "to right"));
  EXPECT_EQ(hub_.refused(), 0);
}

TEST_F(KeyedHub, WithoutAListedKeyNobodyIsHeard) {
  zmq::socket_t open = program("left", ""), spare = program("left", "spare");
  send(open, "from nobody");
  send(spare, "from spare");
  EXPECT_EQ(hears(left_, 500), "nothing");
  EXPECT_FALSE(hub_.take_stranger());
  EXPECT_GE(hub_.refused(), 1) << "the key that is not listed";
  const auto left = dealer("left");
  send(*left, "from left");
  EXPECT_EQ(hears(left_), "from left");
}

TEST_F(KeyedHub, AnotherBodysKeyTakesNoNameAndNoMessage) {
  // Before left is there, and while it is; right's frames could be anything, sessions included.
  zmq::socket_t early = program("left", "right");
  send(early, "forged");
  EXPECT_EQ(hears(left_, 300), "nothing");
  const auto left = dealer("left");
  send(*left, "from left");
  EXPECT_EQ(hears(left_), "from left");
  zmq::socket_t late = program("left", "right");
  send(late, "forged");
  send(early, "forged");
  EXPECT_EQ(hears(left_, 300), "nothing");
  EXPECT_EQ(hears(right_, 0), "nothing") << "who says that he is another body is none";
  EXPECT_TRUE(reaches(left_, *left, "to left"));
  zmq::message_t stolen;
  EXPECT_FALSE(early.recv(stolen, zmq::recv_flags::dontwait));
  EXPECT_FALSE(late.recv(stolen, zmq::recv_flags::dontwait));
}

/// libzmq aborts the process by its second heartbeat to whoever has filled a bounded queue and has
/// hung up: nothing must be left of them then.
TEST_F(KeyedHub, WhoFillsAQueueThatNobodyReadsAndHangsUpEndsNothing) {
  const auto left = dealer("left");
  send(*left, "from left");
  ASSERT_EQ(hears(left_), "from left");
  // Twice each: the name is taken, and nobody reads what comes from another one that says it.
  for (const char* name : {"right", "right", "left", "left", "spare"}) {
    zmq::socket_t peer = program(name, "right");
    for (int k = 0; k < 200; ++k) send(peer, std::string(100, 'x'));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(4'500));  // two heartbeats, 2 s each
  send(*left, "again");
  EXPECT_EQ(hears(left_), "again");
}

TEST_F(KeyedHub, WhoComesBackWithTheKeyIsReachedAgain) {
  for (int round = 0; round < 3; ++round) {
    const auto left = dealer("left");
    send(*left, "round " + std::to_string(round));
    EXPECT_EQ(hears(left_), "round " + std::to_string(round));
    EXPECT_TRUE(reaches(left_, *left, "to left")) << round;
    hub_.gone_since(left_);  // may still tell of the one before
    EXPECT_TRUE(reaches(left_, *left, "again")) << round;
    EXPECT_FALSE(hub_.gone_since(left_)) << round;
  }
}

/// Where one end has keys and the other has none, libzmq may end the connection before it has told
/// why: no test of words.
TEST_F(KeyedHub, ASolverIsToldThatItsKeyIsRefused) {
  const auto said = [](ZmqDealer& dealer) {
    return refusal([&dealer] {
      for (int k = 0; k < 50; ++k) dealer.receive(Milliseconds(100));
    });
  };
  EXPECT_NE(said(*dealer("spare")).find("does not let this key in"), std::string::npos);
}

TEST(Access, WithoutKeysASolverGoesToNoOtherMachineUnlessTold) {
  const auto connect = [](const std::string& endpoint, bool insecure) {
    ZmqDealer(endpoint, "left", Limits{}, 1, Access{"", insecure});
  };
  for (const char* endpoint : {"tcp://192.0.2.1:5555", "tcp://127.example.org:5555",
                               "tcp://127.0.0.1.example.org:5555", "tcp://machine:5555",
                               "tcp://0127.0.0.1:5555"}) {
    EXPECT_THROW(connect(endpoint, false), InputError) << endpoint;
  }
  EXPECT_NO_THROW(connect("tcp://192.0.2.1:5555", true));
  for (const char* endpoint : {"tcp://127.0.0.1:5555", "tcp://127.3.2.1:5555",
                               "tcp://localhost:5555", "ipc:///nowhere/here"})
    EXPECT_NO_THROW(connect(endpoint, false)) << endpoint;
}

}  // namespace
}  // namespace abut::keys_test
