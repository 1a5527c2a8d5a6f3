#include "base/yaml_stars.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "base/error.hpp"
#include "base/key.hpp"
#include "base/yaml_document.hpp"
#include "base/yaml_tree.hpp"

namespace abut {
namespace {

constexpr const char* star = "*";
constexpr std::size_t most_names = 8;  // that a message lists

struct Reached {
  std::string path;
  YAML::Node node;
};

std::vector<std::string> names_in(const YAML::Node& node) {
  std::vector<std::string> names;
  if (node.IsMap())
    for (const auto& pair : node) names.push_back(pair.first.Scalar());
  return names;
}

[[noreturn]] void refuse(const std::vector<Reached>& at, const std::string& step,
                         const std::string& where) {
  std::vector<std::string> names;
  for (const Reached& place : at)
    for (std::string& name : names_in(choice_as_map(place.node)))
      if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  const std::string near = nearest(step, names);
  if (names.size() > most_names) names.resize(most_names);
  const std::string place = at.empty() || at.front().path.empty() ? "it" : at.front().path;
  throw InputError(fmt::format("matches no key of the scene: {}{} has no {}", place,
                               at.size() > 1 ? " and others" : "", step == star ? "keys" : step),
                   where,
                   !near.empty()   ? fmt::format("The nearest is {}", near)
                   : names.empty() ? "Name a map of keys"
                                   : fmt::format("Keys there are {}", fmt::join(names, ", ")));
}

}  // namespace

YAML::Node choice_as_map(const YAML::Node& node) {
  if (!node.IsScalar() || node.Scalar().empty()) return node;
  YAML::Node map(YAML::NodeType::Map);
  map.force_insert(node.Scalar(), YAML::Node(YAML::NodeType::Map));
  return map;
}

std::vector<std::string> paths_meant(const YAML::Node& root, const std::string& path,
                                     bool takes_out, const std::string& where) {
  const std::vector<std::string> steps = split_path(path);
  if (std::ranges::find(steps, star) == steps.end()) return {path};
  std::vector<Reached> at = {{"", root}};
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const bool new_key = k + 1 == steps.size() && !takes_out && !list_index(steps[k]);
    std::vector<Reached> next;
    for (const Reached& place : at) {
      const YAML::Node node = choice_as_map(place.node);
      const std::vector<std::string> names =
          steps[k] == star ? names_in(node) : std::vector<std::string>{steps[k]};
      for (const std::string& name : names) {
        const std::optional<Found> found = child(node, name);
        if (!found && !(new_key && node.IsMap())) continue;
        next.push_back({join_path(place.path, name), found ? found->node : YAML::Node()});
      }
    }
    if (next.empty()) refuse(at, steps[k], where);
    at = std::move(next);
  }
  std::vector<std::string> meant;
  for (Reached& place : at) meant.push_back(std::move(place.path));
  return meant;
}

}  // namespace abut
