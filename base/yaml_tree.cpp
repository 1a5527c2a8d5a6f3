#include "base/yaml_tree.hpp"

#include <charconv>
#include <utility>

#include "base/yaml_document.hpp"

namespace abut {

std::optional<std::size_t> list_index(std::string_view step) {
  if (step.size() < 3 || step.front() != '[' || step.back() != ']') return std::nullopt;
  std::size_t index = 0;
  const char* end = step.data() + step.size() - 1;
  const std::from_chars_result result = std::from_chars(step.data() + 1, end, index);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return index;
}

std::optional<Found> child(const YAML::Node& node, std::string_view step) {
  const std::optional<std::size_t> index = list_index(step);
  if (index) {
    if (!node.IsSequence() || *index >= node.size()) return std::nullopt;
    const YAML::Node item = node[*index];
    return Found{item, item.Mark().line + 1};
  }
  if (!node.IsMap()) return std::nullopt;
  for (const auto& pair : node)
    if (pair.first.Scalar() == step) return Found{pair.second, pair.first.Mark().line + 1};
  return std::nullopt;
}

YamlTree::YamlTree(const YAML::Node& root) : root_(root) {
  const auto entries_of = [](const YAML::Node& map) {
    Entries entries;
    for (const auto& pair : map)
      entries.emplace(pair.first.Scalar(), Found{pair.second, pair.first.Mark().line + 1});
    return entries;
  };
  if (root_.IsMap()) top_ = entries_of(root_);
  for (const auto& [name, found] : top_)
    if (found.node.IsMap()) below_.emplace(name, entries_of(found.node));
}

std::vector<Found> YamlTree::walk(std::span<const std::string> steps) const {
  std::vector<Found> way;
  const Entries* entries = &top_;
  for (const std::string& step : steps) {
    if (way.size() == 1) {
      const auto below = below_.find(steps[0]);
      entries = below == below_.end() ? nullptr : &below->second;
    }
    std::optional<Found> next;
    if (way.size() < 2 && entries != nullptr) {
      const auto found = entries->find(step);
      if (found != entries->end()) next = found->second;
    } else if (!way.empty()) {
      next = child(way.back().node, step);
    }
    if (!next) break;
    way.push_back(std::move(*next));
  }
  return way;
}

std::optional<YAML::Node> YamlTree::find(std::string_view path) const {
  const std::vector<std::string> steps = split_path(path);
  if (steps.empty()) return root_;
  const std::vector<Found> way = walk(steps);
  if (way.size() < steps.size()) return std::nullopt;
  return way.back().node;
}

}  // namespace abut
