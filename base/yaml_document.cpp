#include "base/yaml_document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/yaml_like.hpp"
#include "base/yaml_text.hpp"

namespace abut {
namespace {

constexpr std::size_t max_bytes = 16'000'000;
constexpr const char* scene_file = "Give the path of a scene file.";

/// Position in a list from "[3]"; nothing when the step is a key.
std::optional<std::size_t> list_index(std::string_view step) {
  if (step.size() < 3 || step.front() != '[' || step.back() != ']') return std::nullopt;
  std::size_t index = 0;
  const char* end = step.data() + step.size() - 1;
  const std::from_chars_result result = std::from_chars(step.data() + 1, end, index);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return index;
}

struct Found {
  YAML::Node node;
  int line = 0;  // counted from 1; 0: not from a file
};

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

/// A map or list of the same entries, but for the one that is replaced or added.
YAML::Node replaced(const YAML::Node& node, const std::string& step, const YAML::Node& value) {
  YAML::Node copy(node.Type());
  bool placed = false;
  for (std::size_t i = 0; node.IsSequence() && i < node.size(); ++i)
    copy.push_back(list_index(step) == i ? value : node[i]);
  if (!node.IsMap()) return copy;
  for (const auto& pair : node) {
    const bool here = pair.first.Scalar() == step;
    copy.force_insert(pair.first, here ? value : pair.second);
    placed = placed || here;
  }
  if (!placed) copy.force_insert(step, value);
  return copy;
}

/// The map without one of its keys.
YAML::Node without(const YAML::Node& map, const std::string& key) {
  YAML::Node rest(YAML::NodeType::Map);
  for (const auto& pair : map)
    if (pair.first.Scalar() != key) rest[pair.first] = pair.second;
  return rest;
}

/// A map with one more entry, or with the entry replaced. Copies, because a YAML alias shares its
/// map with the anchor and only one of the two is meant.
YAML::Node with_value(const YAML::Node& node, const std::vector<std::string>& steps, std::size_t at,
                      const YAML::Node& value, const std::string& where) {
  if (at == steps.size()) return value;
  const std::optional<std::size_t> index = list_index(steps[at]);
  const std::optional<Found> found = child(node, steps[at]);
  if (index ? !found : !node.IsMap())
    throw InputError("has no place in the scene", where,
                     index ? "Name an item that the list has, counted from 0."
                           : "Name a key of a map; all but the last key must lead to maps.");
  if (value.IsNull() && at + 1 == steps.size() && node.IsMap()) return without(node, steps[at]);
  const YAML::Node next = found ? found->node : YAML::Node(YAML::NodeType::Map);
  return replaced(node, steps[at], with_value(next, steps, at + 1, value, where));
}

std::string override_path(const std::string& text) { return text.substr(0, text.find('=')); }

bool is_at_or_below(const std::string& path, const std::string& ancestor) {
  const std::vector<std::string> a = split_path(path), b = split_path(ancestor);
  return b.size() <= a.size() && std::equal(b.begin(), b.end(), a.begin());
}

}  // namespace

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> steps;
  std::string step;
  const auto flush = [&steps, &step]() {
    if (!step.empty()) steps.push_back(std::exchange(step, {}));
  };
  for (const char letter : path) {
    if (letter == '.' || letter == '[') flush();
    if (letter != '.') step += letter;
  }
  flush();
  return steps;
}

std::string join_path(std::string_view parent, std::string_view child) {
  if (parent.empty()) return std::string(child);
  return fmt::format("{}{}{}", parent, child.starts_with('[') ? "" : ".", child);
}

Document Document::load(const std::string& path, std::vector<std::string> overrides) {
  return Document(path, read_input_file(path, max_bytes, scene_file), std::move(overrides));
}

Document Document::from_text(std::string name, std::string text,
                             std::vector<std::string> overrides) {
  return Document(std::move(name), std::move(text), std::move(overrides));
}

Document::Document(Document&& other) noexcept = default;
Document& Document::operator=(Document&& other) noexcept = default;
Document::~Document() = default;

Document::Document(std::string name, std::string text, std::vector<std::string> overrides)
    : name_(std::move(name)), text_(std::move(text)), overrides_(std::move(overrides)) {
  if (text_.size() > max_bytes)
    throw InputError(fmt::format("is larger than {} MB", max_bytes / 1'000'000), name_, scene_file);
  root_ = std::make_unique<YAML::Node>(
      parse_yaml(text_, name_, "",
                 "Correct the line; most often it is an indentation, a bracket or a colon."));
  if (!root_->IsMap())
    throw InputError(root_->IsNull() ? "is empty" : "is not a map of keys", name_,
                     "Write a scene as key: value lines, beginning with meta:, time:, bodies:.");
  write_out();
}

/// Overrides change the text, so that bodies have what was changed in those that they are like.
/// What has no place there, or takes out what was not there, is of a body that is written out.
void Document::write_out() {
  std::vector<std::string> later;
  for (std::size_t i = 0; i < overrides_.size(); ++i) {
    const std::string& text = overrides_[i];
    const bool changed_again =
        std::any_of(overrides_.begin() + static_cast<std::ptrdiff_t>(i) + 1, overrides_.end(),
                    [&text](const std::string& other) {
                      return is_at_or_below(override_path(other), override_path(text));
                    });
    try {
      if (put(text) || changed_again) continue;
    } catch (const InputError&) {  // told below, where it still has no place
    }
    later.push_back(text);
  }
  if (has_likes(*root_)) {
    written_ = std::move(root_);
    const Where where = [this](const std::string& path) { return place_of(path, path); };
    root_ = std::make_unique<YAML::Node>(with_likes(*written_, where));
  }
  for (const std::string& text : later) put(text);
}

bool Document::put(const std::string& override_text) {
  const std::string where = "--set " + override_text;
  const std::vector<std::string> steps = split_path(override_path(override_text));
  if (override_text.find('=') == std::string::npos || steps.empty())
    throw InputError("is not of the form key.path=value", where,
                     "Write for example --set time.window=1e-6.");
  const YAML::Node value =
      parse_yaml(override_text.substr(override_text.find('=') + 1), where,
                 override_path(override_text), "Give the value as in a scene file.");
  root_ = std::make_unique<YAML::Node>(with_value(*root_, steps, 0, value, where));
  return !value.IsNull();
}

bool Document::has(std::string_view path) const {
  YAML::Node node(*root_);
  for (const std::string& step : split_path(path)) {
    const std::optional<Found> found = child(node, step);
    if (!found) return false;
    node.reset(found->node);
  }
  return true;
}

std::vector<std::string> Document::keys(std::string_view path) const {
  YAML::Node node(*root_);
  for (const std::string& step : split_path(path)) {
    const std::optional<Found> found = child(node, step);
    if (!found) return {};
    node.reset(found->node);
  }
  std::vector<std::string> names;
  if (node.IsMap())
    for (const auto& pair : node) names.push_back(pair.first.Scalar());
  return names;
}

bool Document::chooses(std::string_view path, std::string_view name) const {
  YAML::Node node(*root_);
  for (const std::string& step : split_path(path)) {
    const std::optional<Found> found = child(node, step);
    if (!found) return false;
    node.reset(found->node);
  }
  if (node.IsScalar()) return node.Scalar() == name;
  return node.IsMap() && child(node, std::string(name)).has_value();
}

std::string Document::where(std::string_view path) const {
  std::vector<std::string> steps = split_path(path);
  const std::string origin = written_ != nullptr ? origin_of(*written_, path) : std::string();
  if (origin.empty() || steps[1] == origin) return place_of(path, path);
  steps[1] = origin;
  std::string there;
  for (const std::string& step : steps) there = join_path(there, step);
  for (const std::string& override_text : overrides_)
    if (is_at_or_below(std::string(path), override_path(override_text)))
      return place_of(path, path);
  return place_of(there, fmt::format("{} (like {})", path, origin));
}

/// Where a path of the text stands, shown as another one.
std::string Document::place_of(std::string_view path, std::string_view shown) const {
  const std::string text(path);
  for (auto it = overrides_.rbegin(); it != overrides_.rend(); ++it)
    if (is_at_or_below(text, override_path(*it)))
      return fmt::format("{}, from --set {}: {}", name_, *it, shown);
  YAML::Node node(written_ != nullptr ? *written_ : *root_);
  std::string there;  // the part of the path that the document has
  int line = 0;
  for (const std::string& step : split_path(path)) {
    const std::optional<Found> found = child(node, step);
    if (!found) break;
    there = join_path(there, step);
    if (found->line > 0) line = found->line;
    if (found->line == 0 && !list_index(step)) {  // an override made it on the way to its own key
      for (const std::string& override_text : overrides_)
        if (is_at_or_below(override_path(override_text), there))
          return fmt::format("{}, from --set {}{}: {}", name_, override_text,
                             there == path ? "" : ", which adds " + there, shown);
    }
    node.reset(found->node);
  }
  const std::string file = line > 0 ? fmt::format("{}:{}", name_, line) : name_;
  return path.empty() ? file : fmt::format("{}: {}", file, shown);
}

}  // namespace abut
