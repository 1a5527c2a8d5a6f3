#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace abut {

/// Position in a list from a step "[3]" of a key path; nothing when the step is a key.
std::optional<std::size_t> list_index(std::string_view step);

/// A value of a tree, and the line of its key.
struct Found {
  YAML::Node node;
  int line = 0;  // counted from 1; 0: not from a file
};

/// The value one step below a node.
std::optional<Found> child(const YAML::Node& node, std::string_view step);

/// A tree whose values are found by their key paths: two steps deep, as bodies and interfaces are,
/// without a search through all that have the same parent.
class YamlTree {
 public:
  explicit YamlTree(const YAML::Node& root);

  const YAML::Node& root() const { return root_; }
  /// What lies on the way, the first step first; ends where the tree does.
  std::vector<Found> walk(std::span<const std::string> steps) const;
  std::optional<YAML::Node> find(std::string_view path) const;

 private:
  using Entries = std::map<std::string, Found, std::less<>>;
  YAML::Node root_;
  Entries top_;
  std::map<std::string, Entries, std::less<>> below_;  // of the maps at the top
};

}  // namespace abut
