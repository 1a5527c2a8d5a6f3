// abut_serve(): the program of a user's body.
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "abut.h"
#include "base/denormals.hpp"
#include "base/yaml_fields.hpp"
#include "messaging/descriptors.hpp"
#include "messaging/serve.hpp"
#include "messaging/zmq_dealer.hpp"
#include "sdk/served/keys.hpp"
#include "sdk/served/served_body.hpp"

namespace abut {

namespace {

constexpr Milliseconds user_patience{60'000};  // for a coordinator to answer
constexpr int user_descriptors = 20;           // as abut-solver; files of the user's come on top

std::unique_ptr<Subdomain> make_user_body(const Specification& given, const ProgressHook& alive,
                                          abut_make* make, void* with) {
  const Document scene = Document::from_text(given.document, given.text, given.overrides);
  const std::string path = given.path + ".model.external";
  auto parts = std::make_unique<abut_parts>();
  abut_body body{};
  body.parts = parts.get();
  body.dim = 1;
  body.mass = std::numeric_limits<double>::quiet_NaN();
  body.stable_step = std::numeric_limits<double>::infinity();
  try {
    read_fields(scene, path, [&](Fields& fields) {
      abut_keys keys{fields, scene, path};
      make(&keys, &body, with);
      if (keys.refused) fields.ignore_rest();  // it may not have come to them
    });
  } catch (const InputError&) {
    if (body.release != nullptr && body.self != nullptr) body.release(body.self);
    throw;
  }
  return std::make_unique<ServedBody>(body, std::move(parts), alive);
}

struct UserOptions {
  std::string endpoint, name;
  Access access;
};

/// None where they are not as abut_serve() takes them.
std::optional<UserOptions> options_of(int argc, char** argv) {
  UserOptions options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    std::string* value = option == "--connect" ? &options.endpoint
                         : option == "--body"  ? &options.name
                         : option == "--keys"  ? &options.access.keys
                                               : nullptr;
    if (option == "--insecure") {
      options.access.insecure = true;
    } else if (value == nullptr || ++i == argc) {
      return std::nullopt;
    } else {
      *value = argv[i];
    }
  }
  if (options.endpoint.empty() || options.name.empty()) return std::nullopt;
  return options;
}

}  // namespace

}  // namespace abut

int abut_serve(int argc, char** argv, abut_make* make, void* with) {
  const std::optional<abut::UserOptions> options = abut::options_of(argc, argv);
  if (!options) {
    std::fputs(fmt::format("usage: {} --connect ENDPOINT --body NAME [--keys DIR] [--insecure]\n",
                           argc > 0 ? argv[0] : "body")
                   .c_str(),
               stderr);
    return 2;
  }
  const std::string &endpoint = options->endpoint, &name = options->name;
  const auto make_body = [make, with](const abut::Specification& given,
                                      const abut::ProgressHook& alive) {
    return abut::make_user_body(given, alive, make, with);
  };
  try {
    const abut::FlushedDenormals flushed;
    const abut::Limits limits;
    const abut::Deadlines deadlines;
    abut::require_descriptors(abut::user_descriptors);
    abut::warn_of_insecure(endpoint, options->access);
    abut::ZmqDealer dealer(endpoint, name, limits, 1, options->access);
    abut::CoordinatorLiveness coordinator(dealer, endpoint, deadlines);
    abut::Server server(name, make_body, dealer, coordinator, limits, deadlines);
    abut::serve(server, abut::user_patience);
    return 0;
  } catch (const abut::InputError& error) {
    std::fputs(fmt::format("body {}: {}\n", name, error.what()).c_str(), stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fputs(fmt::format("body {} at {}: {}\n", name, endpoint, error.what()).c_str(), stderr);
    return 3;
  }
}
