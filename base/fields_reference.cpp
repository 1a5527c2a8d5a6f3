#include "base/fields_reference.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "base/assert.hpp"
#include "base/fields_rows.hpp"
#include "base/yaml_document.hpp"

namespace abut {
namespace {

using Kind = KeyNode::Kind;

Kind kind_of(const double*) { return Kind::number; }
Kind kind_of(const int*) { return Kind::whole; }
Kind kind_of(const std::int64_t*) { return Kind::whole; }
Kind kind_of(const bool*) { return Kind::flag; }
Kind kind_of(const std::string*) { return Kind::text; }
Kind kind_of(const std::optional<double>*) { return Kind::number; }
Kind kind_of(const std::optional<int>*) { return Kind::whole; }
Kind kind_of(const std::vector<double>*) { return Kind::numbers; }
Kind kind_of(const std::vector<std::string>*) { return Kind::words; }
Kind kind_of(const std::array<std::string, 2>*) { return Kind::two_words; }

std::string_view words_of(Kind kind) {
  switch (kind) {
    case Kind::number:
      return "number";
    case Kind::whole:
      return "whole number";
    case Kind::flag:
      return "true or false";
    case Kind::text:
      return "text";
    case Kind::numbers:
      return "list of numbers";
    case Kind::words:
      return "list of words";
    case Kind::two_words:
      return "list of two words";
    case Kind::word:
      return "one of";
    case Kind::map:
      return "map";
    case Kind::list:
      return "list of maps";
    case Kind::names:
      return "map from names to maps";
    case Kind::choice:
      return "choice of";
  }
  return "";
}

std::string shown(double value) { return fmt::format("{}", value); }
std::string shown(int value) { return fmt::format("{}", value); }
std::string shown(std::int64_t value) { return fmt::format("{}", value); }
std::string shown(bool value) { return value ? "true" : "false"; }
std::string shown(const std::string& value) { return value.empty() ? "\"\"" : value; }
template <class T>
std::string shown(const std::optional<T>& value) {
  return value ? shown(*value) : "absent";
}
template <class Values>
std::string shown(const Values& values) {
  std::vector<std::string> items;
  for (const auto& value : values) items.push_back(shown(value));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

/// Builds the tree of the keys that a struct declares.
class Documenter final : public Fields {
 public:
  explicit Documenter(KeyNode& root) : Fields(Purpose::document), stack_{&root} {}

  void ignore(std::string_view) override {}
  void ignore_rest() override { stack_.back()->open = true; }
  void idle(bool, std::string_view, std::string_view) override {}
  void leave() override {
    ABUT_ASSERT(stack_.size() > 1);
    stack_.pop_back();
  }

 protected:
  void leaf(const Key& key, Slot slot, const Rule& rule) override {
    std::visit(
        [this, &key, &rule](const auto* value) {
          KeyNode& node = add(key, kind_of(value), shown(*value));
          node.rule = rule;
        },
        slot);
  }
  void word_leaf(const Key& key, std::string& value,
                 std::span<const std::string_view> words) override {
    add(key, Kind::word, value).words.assign(words.begin(), words.end());
  }
  bool enter(const Key& key, bool) override {
    stack_.push_back(&add(key, Kind::map, "optional"));
    return true;
  }
  std::size_t enter_list(const Key& key, std::size_t) override {
    stack_.push_back(&add(key, Kind::list, "[]"));
    return 0;
  }
  void enter_map(const Key& key, std::vector<std::string>&) override {
    stack_.push_back(&add(key, Kind::names, "{}"));
  }
  std::string enter_choice(const Key& key, std::span<const std::string_view>,
                           std::string_view current, std::span<const Preset> presets) override {
    KeyNode& node = add(key, Kind::choice, current.empty() ? "absent" : std::string(current));
    node.presets.assign(presets.begin(), presets.end());
    stack_.push_back(&node);
    return std::string(current);
  }
  /// Items of lists and maps have their keys in the list's own node, alternatives in one each.
  void descend(std::string_view name, std::string_view shorthand,
               std::span<const Preset> presets) override {
    KeyNode* node = stack_.back();
    if (node->kind == Kind::choice)
      node = &add({name, "", "", Presence::optional}, Kind::map, "optional");
    node->shorthand = shorthand;
    node->presets.assign(presets.begin(), presets.end());
    stack_.push_back(node);
  }
  void broken(std::string_view, const std::string&, const std::string&) override {}

 private:
  KeyNode& add(const Key& key, Kind kind, const std::string& fallback) {
    KeyNode node;
    node.name = key.name;
    node.unit = key.unit;
    node.help = key.help;
    node.required = key.presence == Presence::required;
    node.kind = kind;
    node.fallback = fallback;
    return stack_.back()->keys.emplace_back(std::move(node));
  }

  std::vector<KeyNode*> stack_;  // none of them gets a sibling while it is here
};

}  // namespace

std::string KeyNode::type() const {
  const std::string range = rule.range();
  std::string text(words_of(kind));
  if (kind == Kind::word) text += fmt::format(" {}", fmt::join(words, ", "));
  if (kind == Kind::choice) {
    std::vector<std::string> names;
    for (const KeyNode& key : keys) names.push_back(key.name);
    text += fmt::format(" {}", fmt::join(names, ", "));
    names.clear();
    for (const Preset& preset : presets) names.emplace_back(preset.name);
    if (!names.empty()) text += fmt::format("; or the name {}", fmt::join(names, ", "));
  }
  return range.empty() ? text : text + ", " + range;
}

namespace {

/// Choices below a node for whose keys names stand.
void find_presets(const KeyNode& node, std::vector<const KeyNode*>& found) {
  if (node.kind == Kind::choice && !node.presets.empty()) found.push_back(&node);
  for (const KeyNode& key : node.keys) find_presets(key, found);
}

std::string preset_table(const KeyNode& choice) {
  std::string out = fmt::format("## Names that stand for a {}\n\n", choice.name);
  out += "| name | stands for | source |\n|---|---|---|\n";
  for (const Preset& preset : choice.presets) {
    std::vector<std::string> values;
    for (const auto& [key, value] : preset.values)
      values.push_back(fmt::format("{}: {}", key, value));
    out += fmt::format("| {} | `{{{}: {{{}}}}}` | {} |\n", preset.name, preset.choice,
                       fmt::join(values, ", "), preset.source);
  }
  return out + '\n';
}

}  // namespace

std::unique_ptr<Fields> Reference::documenter_of(std::string_view heading, std::string_view path) {
  sections_.push_back({std::string(heading), std::string(path), {}});
  return std::make_unique<Documenter>(sections_.back().root);
}

std::string Reference::markdown() const {
  std::string out;
  for (const KeySection& section : sections_) {
    if (!section.heading.empty()) out += "## " + section.heading + "\n\n";
    out += "| key | type | unit | default | meaning |\n|---|---|---|---|---|\n";
    for (const KeyRow& row : key_rows(section.root, section.path))
      out += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.path, row.type, row.unit,
                         row.fallback, row.help);
    out += '\n';
  }
  std::vector<const KeyNode*> choices;
  for (const KeySection& section : sections_) find_presets(section.root, choices);
  for (const KeyNode* choice : choices) out += preset_table(*choice);
  return out;
}

std::string Reference::key_paths() const {
  std::string out;
  for (const KeySection& section : sections_)
    for (const std::string& path : paths_below(section.root, section.path)) out += path + '\n';
  return out;
}

}  // namespace abut
