#include "base/yaml_document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/yaml_copies.hpp"
#include "base/yaml_like.hpp"
#include "base/yaml_stages.hpp"
#include "base/yaml_stars.hpp"
#include "base/yaml_text.hpp"
#include "base/yaml_tree.hpp"

namespace abut {
namespace {

constexpr std::size_t most_scene_bytes = 16'000'000;
constexpr const char* scene_file = "Give the path of a scene file.";

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

YAML::Node list_of_one(const YAML::Node& value) {
  YAML::Node list(YAML::NodeType::Sequence);
  list.push_back(value);
  return list;
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
YAML::Node with_value(const YAML::Node& old, const std::vector<std::string>& steps, std::size_t at,
                      const YAML::Node& value, const std::string& where) {
  if (at == steps.size()) return value;
  const bool chosen = old.IsScalar() && old.Scalar() == steps[at];
  const bool alone = old.IsScalar() && list_index(steps[at]) == 0;
  const YAML::Node node = chosen ? choice_as_map(old) : alone ? list_of_one(old) : old;
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

/// The value of what the command line says.
YAML::Node override_value(const std::string& override_text) {
  const std::string where = "--set " + override_text;
  if (override_text.find('=') == std::string::npos ||
      split_path(override_path(override_text)).empty())
    throw InputError("is not of the form key.path=value", where,
                     "Write for example --set time.window=1e-6.");
  return parse_yaml(override_text.substr(override_text.find('=') + 1), where,
                    override_path(override_text), "Give the value as in a scene file.");
}

/// Puts what the command line says in its place; whether it stays there: null takes a key out.
bool put(const std::string& override_text, YAML::Node& root) {
  const YAML::Node value = override_value(override_text);
  const std::vector<std::string> steps = split_path(override_path(override_text));
  root.reset(with_value(root, steps, 0, value, "--set " + override_text));
  return !value.IsNull();
}

/// The overrides with every `*` written out, each in the text that those before it have left.
std::vector<std::string> without_stars(const YAML::Node& text,
                                       const std::vector<std::string>& overrides) {
  const auto has_star = [](const std::string& override_text) {
    return override_path(override_text).find('*') != std::string::npos;
  };
  if (std::none_of(overrides.begin(), overrides.end(), has_star)) return overrides;
  std::vector<std::string> all;
  YAML::Node root(text);
  for (const std::string& override_text : overrides) {
    const std::string path = override_path(override_text),
                      value = override_text.substr(path.size());
    const bool takes_out = has_star(override_text) && override_value(override_text).IsNull();
    for (const std::string& own : paths_meant(root, path, takes_out, "--set " + override_text)) {
      all.push_back(own + value);
      try {
        put(all.back(), root);
      } catch (const InputError&) {  // of a body that is written out later, or told then
      }
    }
  }
  return all;
}

/// The body whose copy an override is of, before copies are written out; empty: none.
std::string copied_by(const std::string& override_text, const YAML::Node& root) {
  const std::vector<std::string> steps = split_path(override_path(override_text));
  if (steps.size() < 2 || steps[0] != "bodies") return "";
  const std::optional<Found> bodies = child(root, "bodies");
  return bodies && child(bodies->node, steps[1]) ? "" : possible_body_of(root, steps[1]);
}

/// Whatever a copy has from its body, it has when its own overrides come.
void check_copy(const std::string& override_text, const YAML::Node& root) {
  const std::vector<std::string> steps = split_path(override_path(override_text));
  const std::optional<Found> copy = child(child(root, "bodies")->node, steps[1]);
  for (const char* key : {"copies", "like"})
    if (copy && child(copy->node, key) && (steps.size() == 2 || steps[2] == key))
      throw InputError(fmt::format("has no effect: {} is a copy", steps[1]),
                       "--set " + override_text,
                       fmt::format("Leave {} out, or give it to the body.", key));
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
  return Document(path, read_input_file(path, most_scene_bytes, scene_file), std::move(overrides));
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
  if (text_.size() > most_scene_bytes)
    throw InputError(fmt::format("is larger than {} MB", most_scene_bytes / 1'000'000), name_,
                     scene_file);
  const YAML::Node root = parse_yaml(
      text_, name_, "", "Correct the line; most often it is an indentation, a bracket or a colon.");
  if (!root.IsMap())
    throw InputError(root.IsNull() ? "is empty" : "is not a map of keys", name_,
                     "Write a scene as key: value lines, beginning with time:, bodies:.");
  write_out(root);
}

/// Overrides change the text, so that bodies have what was changed in those that they are like or
/// copies of. What has no place there, or takes out what was not there, is of a body that is
/// written out.
void Document::write_out(const YAML::Node& text) {
  overrides_ = without_stars(text, overrides_);
  std::vector<std::string> later;
  YAML::Node root(text);
  for (std::size_t i = 0; i < overrides_.size(); ++i) {
    const std::string& override_text = overrides_[i];
    const bool changed_again =
        std::any_of(overrides_.begin() + static_cast<std::ptrdiff_t>(i) + 1, overrides_.end(),
                    [&override_text](const std::string& other) {
                      return is_at_or_below(override_path(other), override_path(override_text));
                    });
    try {
      if (copied_by(override_text, root).empty() && (put(override_text, root) || changed_again))
        continue;
    } catch (const InputError&) {  // told below, where it still has no place
    }
    later.push_back(override_text);
  }
  tree_ = std::make_unique<YamlTree>(root);
  if (has("stages")) {
    before_ = std::make_unique<YamlTree>(root);
    std::ranges::copy_if(later, std::back_inserter(later_), [](const std::string& each) {
      return !is_at_or_below(override_path(each), "stages");
    });
  }
  read_units();
  write_out_likes();
  write_out_copies();
  if (later.empty()) return;
  root.reset(tree_->root());
  for (const std::string& override_text : later) {
    const std::string body = copied_by(override_text, written_ ? written_->root() : root);
    if (!body.empty() && !has(join_path("bodies", split_path(override_path(override_text))[1])))
      throw InputError(fmt::format("is of no copy: {} has the copies {}", body, copies_of(body)),
                       "--set " + override_text, "Name one of them.");
    put(override_text, root);
    if (!body.empty()) check_copy(override_text, root);
  }
  tree_ = std::make_unique<YamlTree>(root);
}

void Document::read_units() {
  const std::optional<YAML::Node> node = tree_->find("units");
  if (!node || !node->IsScalar() || node->Scalar().empty()) return;  // another type: told later
  const std::optional<UnitSystem> system = UnitSystem::parse(node->Scalar());
  if (!system)
    throw InputError(fmt::format("is {}, which is no system of units", node->Scalar()),
                     place_of("units", "units"),
                     "Write SI, or a length, a mass and a time: m kg s (N, Pa), mm t s (N, MPa), "
                     "mm kg ms (kN, GPa).");
  units_ = *system;
  declares_units_ = true;
}

void Document::write_out_likes() {
  if (!has_likes(tree_->root())) return;
  written_ = std::move(tree_);
  const Where where = [this](const std::string& path) { return place_of(path, path); };
  tree_ = std::make_unique<YamlTree>(with_likes(written_->root(), where));
}

void Document::write_out_copies() {
  std::unique_ptr<Copies> copies = std::make_unique<Copies>(*this);
  if (copies->empty()) return;
  std::unique_ptr<YamlTree> all = std::make_unique<YamlTree>(copies->written_out(*this));
  if (written_ == nullptr) written_ = std::move(tree_);
  tree_ = std::move(all);
  copies_ = std::move(copies);
}

std::optional<Document> Document::next_stage() const {
  if (before_ == nullptr) return std::nullopt;
  std::optional<NextStage> next = abut::next_stage(before_->root());
  if (!next) return std::nullopt;
  Document stage =
      from_text(fmt::format("{}, stage {}", name_, next->name), std::move(next->text), later_);
  stage.origin_ = std::make_unique<StageOrigin>(
      origin_ != nullptr ? *origin_ : StageOrigin(before_->root(), name_));
  stage.origin_->add(next->name);
  return stage;
}

const YAML::Node& Document::root() const { return tree_->root(); }

bool Document::has(std::string_view path) const { return tree_->find(path).has_value(); }

bool Document::says(std::string_view path) const {
  if (has(path)) return true;
  const std::vector<std::string> steps = split_path(path);
  const std::vector<Found> way = tree_->walk(steps);
  return !way.empty() && !way.back().node.IsMap();
}

std::vector<std::string> Document::keys(std::string_view path) const {
  const std::optional<YAML::Node> node = tree_->find(path);
  std::vector<std::string> names;
  if (node && node->IsMap())
    for (const auto& pair : *node) names.push_back(pair.first.Scalar());
  return names;
}

bool Document::chooses(std::string_view path, std::string_view name) const {
  const std::optional<YAML::Node> node = tree_->find(path);
  if (!node) return false;
  if (node->IsScalar()) return node->Scalar() == name;
  return child(*node, name).has_value();
}

std::vector<std::string> Document::overrides_elsewhere() const {
  std::vector<std::string> all = overrides_;
  if (copies_ != nullptr)
    for (std::string& text : copies_->tables_as_lists()) all.push_back(std::move(text));
  return all;
}

std::string Document::body_of_copy(std::string_view name) const {
  return copies_ != nullptr ? copies_->body_of(name) : "";
}

std::string Document::copies_of(std::string_view body) const {
  return copies_ != nullptr ? copies_->names_of(body) : "";
}

bool Document::is_set_at(std::string_view path) const {
  return std::any_of(overrides_.begin(), overrides_.end(), [path](const std::string& text) {
    return is_at_or_below(std::string(path), override_path(text));
  });
}

std::string Document::where(std::string_view path) const {
  if (is_set_at(path) || written_ == nullptr) return place_of(path, path);
  const auto has = [this](const std::string& there) { return written_->find(there).has_value(); };
  const std::string own = copies_ != nullptr ? copies_->origin_of(path, has) : std::string(path);
  std::vector<std::string> steps = split_path(own);
  const std::string origin = origin_of(*written_, own);
  if (origin.empty() || steps[1] == origin) return place_of(own, own);
  steps[1] = origin;
  std::string there;
  for (const std::string& step : steps) there = join_path(there, step);
  return place_of(there, fmt::format("{} (like {})", own, origin));
}

/// Where a path of the text stands, shown as another one.
std::string Document::place_of(std::string_view path, std::string_view shown) const {
  const std::string text(path);
  for (auto it = overrides_.rbegin(); it != overrides_.rend(); ++it)
    if (is_at_or_below(text, override_path(*it)))
      return fmt::format("{}, from --set {}: {}", name_, *it, shown);
  const std::vector<std::string> steps = split_path(path);
  std::string there;  // the part of the path that the document has
  int line = 0;
  std::size_t depth = 0;
  for (const Found& found : (written_ != nullptr ? *written_ : *tree_).walk(steps)) {
    const std::string& step = steps[depth++];
    there = join_path(there, step);
    if (found.line > 0) line = found.line;
    if (found.line == 0 && !list_index(step)) {  // an override made it on the way to its own key
      for (const std::string& override_text : overrides_)
        if (is_at_or_below(override_path(override_text), there))
          return fmt::format("{}, from --set {}{}: {}", name_, override_text,
                             there == path ? "" : ", which adds " + there, shown);
    }
  }
  if (origin_ != nullptr && !path.empty()) return origin_->place_of(steps, shown);
  const std::string file = line > 0 ? fmt::format("{}:{}", name_, line) : name_;
  return path.empty() ? file : fmt::format("{}: {}", file, shown);
}

}  // namespace abut
