#include "coordinator/scene_changes.hpp"

#include <algorithm>
#include <regex>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_differences.hpp"

namespace abut {
namespace {

/// What no state depends on. Measures are of the whole run: their filters stay.
const std::regex& always_free() {
  static const std::regex keys(
      R"((meta|network)(\..*)?|time\.end|output\.(records_per_window|fields|checkpoint)(\..*)?|)"
      R"(output|bodies\.[^.]+\.launch(\..*)?)");
  return keys;
}

/// What a state can go on with in another size.
const std::regex& free_by_command() {
  static const std::regex keys(
      R"(time\.window|bodies\.[^.]+\.integrator\.[^.]+\.step|)"
      R"(schwarz\.(tolerance|max_iterations|on_nonconvergence|energy_guard))");
  return keys;
}

bool named(const std::string& key, std::span<const std::string> overrides) {
  return std::ranges::any_of(
      overrides, [&key](const std::string& text) { return text.substr(0, text.find('=')) == key; });
}

std::string shown(const std::string& value) { return value.empty() ? "absent" : value; }

}  // namespace

void check_changes(const std::string& before, const std::string& now,
                   std::span<const std::string> overrides) {
  InputErrors errors;
  for (const Difference& change : differences(before, now)) {
    if (std::regex_match(change.key, always_free())) continue;
    const bool by_command = named(change.key, overrides);
    if (by_command && std::regex_match(change.key, free_by_command())) continue;
    const char* remedy = std::regex_match(change.key, free_by_command())
                             ? "Say so with --set, or give the run's own value."
                             : "Give the run's own value, or run the scene anew.";
    errors.add({fmt::format("was {} when the checkpoint was written, and is {}",
                            shown(change.before), shown(change.now)),
                change.key, remedy});
  }
  errors.raise();
}

}  // namespace abut
