#include "coordinator/scene_changes.hpp"

#include <algorithm>
#include <regex>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_differences.hpp"
#include "base/yaml_document.hpp"

namespace abut {
namespace {

/// What no state depends on: stages are those to come. Measures are of the whole run: their filters
/// stay.
const std::regex& always_free() {
  static const std::regex keys(
      R"((meta|network|stages)(\..*)?|time\.end|)"
      R"(output\.(records_per_window|fields|checkpoint)(\..*)?|)"
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

const std::regex& free_in_stages() {
  static const std::regex keys(
      R"(time\.(end|window)|time\.until(\..*)?|bodies\.[^.]+\.initial\.velocity|)"
      R"(bodies\.[^.]+\.(model|integrator|equations|contact_layer)(\..*)?|)"
      R"(schwarz(\..*)?|output\.(records_per_window|fields|checkpoint)(\..*)?)");
  return keys;
}

/// Whether a key that a stage may have lies below this one.
const std::regex& on_the_way() {
  static const std::regex keys(R"(time|bodies(\.[^.]+(\.initial)?)?|output)");
  return keys;
}

/// Of one stage: `path` from the document's root, `key` as the scene has it.
void check_stage(const Document& document, const std::string& path, const std::string& key,
                 InputErrors& errors) {
  for (const std::string& name : document.keys(path)) {
    const std::string below = join_path(path, name), own = join_path(key, name);
    if (std::regex_match(own, free_in_stages())) continue;
    if (key == "bodies" && !document.has(own)) {
      errors.add({"is no body of the scene", document.where(below), "Name one of its bodies."});
    } else if (std::regex_match(own, on_the_way()) && !document.keys(below).empty()) {
      check_stage(document, below, own, errors);
    } else {
      errors.add(
          {"cannot be another in a stage", document.where(below),
           "Give time.end, time.window, time.until, schwarz, output, or of bodies model, "
           "integrator, equations, contact_layer and initial.velocity; all else is the scene's, "
           "and may be functions of time."});
    }
  }
}

/// Of a body that has another model in the stage.
void check_swap(const Document& document, const std::string& path, const std::string& body,
                InputErrors& errors) {
  const std::string own = join_path("bodies", body), model = join_path(own, "model");
  const std::string below = join_path(path, model);
  if (!document.has(below)) return;
  for (const std::string& at : {model, below})
    for (const std::string& name : document.keys(at))
      if (name != "fe" && name != "modal" && name != "rigid")
        errors.add({fmt::format("is {}, and of another model no other one takes over", name),
                    document.where(at), "Give a body fe, modal or rigid in all stages."});
  if (document.chooses(join_path(own, "integrator"), "quasi_static"))
    errors.add({"is another after statics, in which the body would not be in balance",
                document.where(below),
                "Let the body move in one stage, and change its model in the next."});
}

/// Where bodies move on from what they do, nothing takes a velocity of their own.
void check_velocity(const Document& document, const std::string& path, const std::string& body,
                    InputErrors& errors) {
  const std::string own = join_path("bodies", body);
  const std::string velocity = join_path(join_path(path, own), "initial.velocity");
  if (!document.has(velocity) || document.chooses(join_path(own, "integrator"), "quasi_static"))
    return;
  errors.add(
      {"has no effect: the body has not stood in statics in the stage before, and goes on as "
       "it moves",
       document.where(velocity),
       "Leave it out; or let the body stand before (integrator: quasi_static), or begin the "
       "scene with it."});
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

void check_stages(const Document& document) {
  InputErrors errors;
  if (document.has("stages") && document.keys("stages").empty())
    errors.add({"has no stage", document.where("stages"), "Leave it out, or give name: {keys}."});
  for (const std::string& name : document.keys("stages")) {
    const std::string path = join_path("stages", name);
    if (!document.has(path + ".time.end"))
      errors.add({"does not say when it ends", document.where(path),
                  "Give time: {end: ...}, after the end of the stage before."});
    check_stage(document, path, "", errors);
    if (name == document.keys("stages").front())  // later ones are looked at in their turn
      for (const std::string& body : document.keys(join_path(path, "bodies"))) {
        check_swap(document, path, body, errors);
        check_velocity(document, path, body, errors);
      }
  }
  errors.raise();
}

}  // namespace abut
