// A solver process for the transport tests. The variable ABUT_FAKE_<body> chooses its manners;
// without it the process serves a point mass as abut-solver serves a bar.
#include <unistd.h>

#include <chrono>
#include <cinttypes>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "messaging/linked_bodies.hpp"
#include "messaging/serve.hpp"
#include "messaging/serve_group.hpp"
#include "messaging/zmq_dealer.hpp"
#include "messaging/zmq_group.hpp"
#include "tests/support/fakes.hpp"

namespace {

using namespace abut;

/// Overwrites what it shares with the coordinator.
void scribble() {
  std::FILE* const maps = std::fopen("/proc/self/maps", "r");
  char line[512];
  while (maps != nullptr && std::fgets(line, sizeof line, maps) != nullptr) {
    std::uintptr_t begin = 0, end = 0;
    if (std::strstr(line, "/memfd:abut") == nullptr ||
        std::sscanf(line, "%" SCNxPTR "-%" SCNxPTR, &begin, &end) != 2)
      continue;
    std::memset(reinterpret_cast<void*>(begin), 0x5a, end - begin);
  }
  if (maps != nullptr) std::fclose(maps);
}

/// Sends properly until the body is configured, then something else instead of every reply.
class Spoiler : public Channel {
 public:
  Spoiler(Channel& inner, std::string manners) : inner_(inner), manners_(std::move(manners)) {}
  using Channel::send;
  bool send(Bytes frame) override {
    if (!spoiling) return inner_.send(frame);
    std::vector<std::byte> bytes(frame.begin(), frame.end());
    if (manners_ == "corrupt") bytes.back() ^= std::byte{1};
    if (manners_ == "oversized")
      bytes.resize(1'500'000);                        // above the test's limit of 1,000,000 bytes
    if (manners_ == "huge") bytes.resize(3'000'000);  // where libzmq ends the connection
    return inner_.send(bytes);
  }
  std::optional<Bytes> receive(Milliseconds wait) override { return inner_.receive(wait); }
  bool spoiling = false;

 private:
  Channel& inner_;
  std::string manners_;
};

std::unique_ptr<Subdomain> make(const std::string& manners, const std::string& name,
                                const Specification& specification, const ProgressHook& progress,
                                bool& spoiling) {
  if (specification.text.find("no such key") != std::string::npos) {
    throw InputError("unknown key", specification.path, "remove it");
  }
  if (manners == "wants_scene" && specification.text.empty())
    throw InputError("no scene", specification.path, "send it");
  FakeSubdomain::Options options;
  options.name = name;
  std::unique_ptr<FakeSubdomain> body = std::make_unique<FakeSubdomain>(options);
  body->during_substep = [manners, progress, &spoiling] {
    progress();
    if (manners == "crash") raise(SIGKILL);
    if (manners == "stop") raise(SIGSTOP);
    if (manners == "scribble") scribble();
    if (manners == "mute") std::this_thread::sleep_for(std::chrono::hours(1));
    if (manners == "slow") std::this_thread::sleep_for(std::chrono::milliseconds(250));
    if (manners == "corrupt" || manners == "oversized" || manners == "huge") spoiling = true;
  };
  return body;
}

int run(const std::string& endpoint, int memory, const std::string& name,
        const std::string& manners) {
  Limits limits;
  Deadlines deadlines;
  deadlines.progress = Milliseconds(100);
  ZmqDealer dealer(endpoint, name, limits);
  if (manners == "old_version") {
    v1::Reply greeting;
    greeting.mutable_hello()->set_protocol(protocol_version - 1);
    greeting.mutable_hello()->set_build("9.9.9");
    Frame frame;
    frame.seal(greeting);
    dealer.send(frame.bytes());
    pause();
  }
  if (manners == "babble") {
    const std::vector<std::byte> noise(99, std::byte{7});
    dealer.send(noise);
    pause();
  }
  const auto linked = LinkedBodies::join(memory, {&dealer}, limits);
  Spoiler channel(linked ? linked->channel(0) : dealer, manners);
  CoordinatorLiveness coordinator(dealer, endpoint, deadlines, linked.get());
  Server server(
      name,
      [&](const Specification& specification, const ProgressHook& progress) {
        return make(manners, name, specification, progress, channel.spoiling);
      },
      channel, coordinator, limits, deadlines);
  serve(server, Milliseconds(10'000));
  if (manners == "stubborn") {
    std::signal(SIGTERM, SIG_IGN);
    std::this_thread::sleep_for(std::chrono::hours(1));
  }
  return 0;
}

std::string manners_of(const std::string& body) {
  const char* chosen = std::getenv(("ABUT_FAKE_" + body).c_str());
  return chosen != nullptr ? chosen : "";
}

/// Several bodies, each with its manners of solving.
int run_group(const std::string& endpoint, int memory, const std::string& process,
              const std::vector<std::string>& bodies) {
  const Limits limits;
  Deadlines deadlines;
  deadlines.progress = Milliseconds(100);
  ZmqDealer dealer(endpoint, process, limits, bodies.size());
  ZmqGroup by_socket(dealer, bodies);
  std::vector<Channel*> sockets;
  for (std::size_t b = 0; b < bodies.size(); ++b) sockets.push_back(&by_socket.channel(b));
  const auto linked = LinkedBodies::join(memory, sockets, limits);
  BodyGroup& group = linked ? static_cast<BodyGroup&>(*linked) : by_socket;
  CoordinatorLiveness coordinator(dealer, endpoint, deadlines, linked.get());
  std::vector<std::unique_ptr<Server>> servers;
  bool spoiling = false;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::string& name = bodies[b];
    servers.push_back(std::make_unique<Server>(
        name,
        [&name, &spoiling](const Specification& specification, const ProgressHook& progress) {
          return make(manners_of(name), name, specification, progress, spoiling);
        },
        group.channel(b), coordinator, limits, deadlines));
  }
  serve_group(servers, group, Milliseconds(10'000));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string endpoint, process;
  int memory = -1;
  std::vector<std::string> bodies;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--connect") endpoint = argv[i + 1];
    if (option == "--process") process = argv[i + 1];
    if (option == "--memory") memory = std::atoi(argv[i + 1]);
    if (option == "--body") bodies.emplace_back(argv[i + 1]);
  }
  for (const std::string& body : bodies) {
    if (manners_of(body) == "exit") return 7;
    if (manners_of(body) == "never") pause();
  }
  try {
    return process.empty() ? run(endpoint, memory, bodies.front(), manners_of(bodies.front()))
                           : run_group(endpoint, memory, process, bodies);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
