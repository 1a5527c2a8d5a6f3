// One body in a process of its own: connects, is told what it is, and serves until it is told to
// finish. Exit codes: 0 after Finish, 2 for a command line that cannot be, 3 when the coordinator
// is gone.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

#include "base/denormals.hpp"
#include "base/error.hpp"
#include "messaging/descriptors.hpp"
#include "messaging/liveness.hpp"
#include "messaging/serve.hpp"
#include "messaging/zmq_channel.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace {

constexpr int descriptors = 20;  // measured: 12; files of meshes come on top

std::unique_ptr<abut::Subdomain> make(const abut::Specification& specification,
                                      const abut::ProgressHook& progress) {
  const abut::Document document = abut::Document::from_text(
      specification.document, specification.text, specification.overrides);
  return abut::make_body(document, specification.path, progress);
}

void serve_body(const std::string& endpoint, const std::string& name, double patience) {
  const abut::Limits limits;
  const abut::Deadlines deadlines;
  abut::require_descriptors(descriptors);
  abut::ZmqDealer dealer(endpoint, name, limits);
  abut::CoordinatorLiveness coordinator(dealer, endpoint, deadlines);
  abut::Server server(name, &make, dealer, coordinator, limits, deadlines);
  const double milliseconds = 1000.0 * patience;
  abut::serve(server, abut::Milliseconds(static_cast<abut::Milliseconds::rep>(milliseconds)));
}

}  // namespace

int main(int argc, char** argv) {
  const abut::FlushedDenormals flushed;  // also of threads that bodies start
  CLI::App app("One body of an abut scene; started by abut, or by hand for `launch: connect`.",
               "abut-solver");
  std::string endpoint;
  std::string name;
  double patience = 60.0;
  app.add_option("--connect", endpoint, "the coordinator's endpoint, e.g. tcp://127.0.0.1:5555")
      ->required();
  app.add_option("--body", name, "name of the body in the scene")->required();
  app.add_option("--patience", patience, "how long to wait for a coordinator [s]")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 86'400.0));
  app.set_version_flag("--version", fmt::format("abut-solver {}, protocol {}",
                                                abut::build_version(), abut::protocol_version));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    serve_body(endpoint, name, patience);
    return 0;
  } catch (const abut::InputError& error) {
    std::fputs(fmt::format("abut-solver: {}\n", error.what()).c_str(), stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fputs(fmt::format("abut-solver at {}: {}\n", endpoint, error.what()).c_str(), stderr);
    return 3;
  }
}
