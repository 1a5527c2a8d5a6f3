// One body in a process of its own, or several in one: connects, is told what it is, and serves
// until it is told to finish. Exit codes: 0 after Finish, 2 for a command line that cannot be, 3
// when the coordinator is gone.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "base/build_info.hpp"
#include "base/denormals.hpp"
#include "base/error.hpp"
#include "base/memory_end.hpp"
#include "messaging/descriptors.hpp"
#include "messaging/linked_bodies.hpp"
#include "messaging/liveness.hpp"
#include "messaging/serve.hpp"
#include "messaging/serve_group.hpp"
#include "messaging/zmq_dealer.hpp"
#include "messaging/zmq_group.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/solve/petsc_solver.hpp"

namespace {

constexpr int descriptors = 20;  // measured: 12; files of meshes come on top

/// Makes the bodies of this process from one scene. Its text comes with the first body; the others
/// bring none, and it is read once.
class Maker {
 public:
  std::unique_ptr<abut::Subdomain> operator()(const abut::Specification& specification,
                                              const abut::ProgressHook& progress) {
    if (!specification.text.empty() || !scene_) {
      scene_ = abut::Document::from_text(specification.document, specification.text,
                                         specification.overrides);
    }
    return abut::make_body(*scene_, specification.path, specification.context, progress);
  }

 private:
  std::optional<abut::Document> scene_;
};

/// What a command line says.
struct Command {
  std::string endpoint;
  std::string process;  // routing id of a process that several bodies may share
  std::vector<std::string> bodies;
  int memory = -1;         // descriptor; below 0: none
  double patience = 60.0;  // [s]
  abut::Access access;
};

void serve_bodies(const Command& command) {
  const abut::Limits limits;
  const abut::Deadlines deadlines;
  const abut::Milliseconds patience(
      static_cast<abut::Milliseconds::rep>(1000.0 * command.patience));
  abut::require_descriptors(descriptors);
  abut::warn_of_insecure(command.endpoint, command.access);
  const bool shared = !command.process.empty();
  abut::ZmqDealer dealer(command.endpoint, shared ? command.process : command.bodies.front(),
                         limits, command.bodies.size(), command.access);
  Maker maker;
  const abut::MakeBody make = std::ref(maker);
  if (!shared) {
    const auto linked = abut::LinkedBodies::join(command.memory, {&dealer}, limits);
    abut::CoordinatorLiveness coordinator(dealer, command.endpoint, deadlines, linked.get());
    abut::Channel& channel = linked ? linked->channel(0) : dealer;
    abut::Server server(command.bodies.front(), make, channel, coordinator, limits, deadlines);
    abut::serve(server, patience);
    return;
  }
  abut::ZmqGroup by_socket(dealer, command.bodies);
  std::vector<abut::Channel*> sockets;
  for (std::size_t b = 0; b < command.bodies.size(); ++b) sockets.push_back(&by_socket.channel(b));
  const auto linked = abut::LinkedBodies::join(command.memory, sockets, limits);
  abut::BodyGroup& group = linked ? static_cast<abut::BodyGroup&>(*linked) : by_socket;
  abut::CoordinatorLiveness coordinator(dealer, command.endpoint, deadlines, linked.get());
  std::vector<std::unique_ptr<abut::Server>> servers;
  for (std::size_t b = 0; b < command.bodies.size(); ++b) {
    servers.push_back(std::make_unique<abut::Server>(command.bodies[b], make, group.channel(b),
                                                     coordinator, limits, deadlines));
  }
  abut::serve_group(servers, group, patience);
}

/// What the command line says; where it says no more than that, the exit code.
std::optional<int> read_command_line(int argc, char** argv, Command& command) {
  CLI::App app("Bodies of an abut scene; started by abut, or by hand for `launch: connect`.",
               "abut-solver");
  const std::string protocol = fmt::format(", protocol {}", abut::protocol_version);
  app.add_option("--connect", command.endpoint,
                 "the coordinator's endpoint, e.g. tcp://127.0.0.1:5555")
      ->required()
      ->type_name("ENDPOINT");
  app.add_option("--body", command.bodies,
                 "name of the body in the scene; with --process of each of its bodies")
      ->required()
      ->type_name("NAME");
  app.add_option("--process", command.process,
                 "of several bodies: the name by which the coordinator that starts it knows it")
      ->type_name("NAME");
  app.add_option("--memory", command.memory,
                 "descriptor of memory that the coordinator which starts it shares with it")
      ->type_name("NUMBER");
  app.add_option("--patience", command.patience, "time to wait for a coordinator [s]; default 60")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.1, 86'400.0).description(""));
  app.add_option("--keys", command.access.keys,
                 "folder with the body's key and the coordinator's public one (abut keygen)")
      ->type_name("DIR");
  app.add_flag("--insecure", command.access.insecure,
               "connect to another machine without keys, on a network that you trust");
  app.set_version_flag("--version", abut::version_text("abut-solver", protocol),
                       "Print version, commit and options of the build, and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (command.process.empty() && command.bodies.size() > 1) {
    std::fputs("abut-solver: several bodies need --process\n", stderr);
    return 2;
  }
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  const abut::FlushedDenormals flushed;  // also of threads that bodies start
  abut::join_processes(argv[0]);
  abut::end_in_words_without_memory("abut-solver");
  Command command;
  try {
    if (const std::optional<int> code = read_command_line(argc, argv, command)) return *code;
    serve_bodies(command);
    return 0;
  } catch (const abut::InputError& error) {
    std::fputs(fmt::format("abut-solver: {}\n", error.what()).c_str(), stderr);
    return 2;
  } catch (const std::bad_alloc&) {
    std::fputs("abut-solver: the memory is used up\n", stderr);
    return 3;
  } catch (const std::exception& error) {
    std::fputs(fmt::format("abut-solver at {}: {}\n", command.endpoint, error.what()).c_str(),
               stderr);
    return 3;
  }
}
