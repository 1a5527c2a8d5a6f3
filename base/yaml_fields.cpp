#include "base/yaml_fields.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/assert.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_quantity.hpp"
#include "base/yaml_tree.hpp"
#include "base/yaml_values.hpp"

namespace abut {
namespace {

class Reader final : public Fields {
 public:
  Reader(const Document& document, std::string path, const YAML::Node& node)
      : Fields(Purpose::read), document_(document) {
    push(std::move(path), node, false);
  }

  void ignore(std::string_view key) override { declare(key); }
  void ignore_rest() override { frames_.back().open = true; }
  void idle(bool is_idle, std::string_view key, std::string_view why) override;
  void leave() override;
  bool done() const { return frames_.empty(); }
  const InputErrors& errors() const { return errors_; }

 protected:
  void leaf(const Key& key, Slot slot, const Rule& rule) override;
  void word_leaf(const Key& key, std::string& value,
                 std::span<const std::string_view> words) override;
  bool enter(const Key& key, bool present) override;
  std::size_t enter_list(const Key& key, std::size_t count) override;
  void enter_map(const Key& key, std::vector<std::string>& names) override;
  std::string enter_choice(const Key& key, std::span<const std::string_view> names,
                           std::string_view current, std::span<const Preset> presets) override;
  void descend(std::string_view name, std::string_view shorthand,
               std::span<const Preset> presets) override;
  void broken(std::string_view key, const std::string& what, const std::string& remedy) override;

 private:
  struct Frame {
    std::string path;
    YAML::Node node;
    bool open = false;        // keys that are not declared belong to somebody else
    std::size_t earlier = 0;  // errors found before it was entered
    std::vector<std::string> declared;
    // Kept until all keys are known: a misspelt key is not missing as well, and rules across keys
    // say nothing of a map in which keys are wrong.
    std::vector<std::pair<std::string, InputError>> missing, broken;  // by key
  };

  void push(std::string path, const YAML::Node& node, bool open) {
    frames_.push_back(Frame{std::move(path), node, open, errors_.count(), {}, {}, {}});
  }
  std::vector<std::string> refuse_unknown_keys(const Frame& frame);
  void declare(std::string_view key) { frames_.back().declared.emplace_back(key); }
  std::string path_of(std::string_view key) const { return join_path(frames_.back().path, key); }
  std::optional<YAML::Node> find(const Key& key, const std::string& form, const Rule& rule = any);
  std::string chosen(const Key& key, const std::string& path, const YAML::Node& node,
                     std::span<const std::string_view> names,
                     std::span<const Preset> presets) const;
  [[noreturn]] void fail(const std::string& path, const std::string& what,
                         const std::string& remedy_text) const {
    throw InputError(what, document_.where(path), remedy_text);
  }
  [[noreturn]] void wrong_type(const std::string& path, std::string_view wanted,
                               const YAML::Node& node, const std::string& remedy_text) const {
    fail(path, fmt::format("must be {}, but is {}", wanted, describe(node)), remedy_text);
  }

  double number(const Key& key, const std::string& path, const YAML::Node& node,
                const Rule& rule) const;
  std::int64_t whole(const Key& key, const std::string& path, const YAML::Node& node,
                     const Rule& rule) const;
  std::string text(const Key& key, const std::string& path, const YAML::Node& node) const;
  void check_range(const Key& key, const std::string& path, const YAML::Node& node, double value,
                   std::string_view form, const Rule& rule) const;
  const YAML::Node& list_of(const Key& key, const std::string& path, const YAML::Node& node,
                            const char* form) const;

  void fill(double& value, const Key&, const std::string& path, const YAML::Node&, const Rule&);
  void fill(int& value, const Key&, const std::string& path, const YAML::Node&, const Rule&);
  void fill(std::int64_t& value, const Key&, const std::string& path, const YAML::Node&,
            const Rule&);
  void fill(bool& value, const Key&, const std::string& path, const YAML::Node&, const Rule&);
  void fill(std::string& value, const Key&, const std::string& path, const YAML::Node&,
            const Rule&);
  template <class T>
  void fill(std::optional<T>& value, const Key& key, const std::string& path,
            const YAML::Node& node, const Rule& rule) {
    fill(value.emplace(), key, path, node, rule);
  }
  void fill(std::vector<double>& value, const Key&, const std::string& path, const YAML::Node&,
            const Rule&);
  void fill(std::vector<std::string>& value, const Key&, const std::string& path, const YAML::Node&,
            const Rule&);
  void fill(std::array<std::string, 2>& value, const Key&, const std::string& path,
            const YAML::Node&, const Rule&);

  const Document& document_;
  std::vector<Frame> frames_;
  InputErrors errors_;
};

const char* form_of(const double*) { return ""; }
const char* form_of(const int*) { return "a whole number"; }
const char* form_of(const std::int64_t*) { return "a whole number"; }
const char* form_of(const bool*) { return "true or false"; }
const char* form_of(const std::string*) { return "text"; }
const char* form_of(const std::optional<double>*) { return ""; }
const char* form_of(const std::optional<int>*) { return "a whole number"; }
const char* form_of(const std::vector<double>*) { return "a list of numbers"; }
const char* form_of(const std::vector<std::string>*) { return "a list of words"; }
const char* form_of(const std::array<std::string, 2>*) { return "a list of two words"; }

/// The value of a declared key. When it is absent and required, that is noted for leave().
std::optional<YAML::Node> Reader::find(const Key& key, const std::string& form, const Rule& rule) {
  declare(key.name);
  Frame& frame = frames_.back();
  for (const auto& pair : frame.node)
    if (pair.first.Scalar() == key.name) return pair.second;
  if (key.presence == Presence::required) {
    const std::string where = document_.where(path_of(key.name));
    frame.missing.emplace_back(key.name, InputError("is missing", where, remedy(key, form, rule)));
  }
  return std::nullopt;
}

/// In the scene's units, in which messages speak as well.
void Reader::leaf(const Key& declared, Slot slot, const Rule& rule) {
  const std::string unit = document_.units().word(declared.unit);
  const Key key{declared.name, unit, declared.help, declared.presence};
  std::visit(
      [this, &key, &rule](auto* value) {
        const std::optional<YAML::Node> node = find(key, form_of(value), rule);
        if (!node) return;
        errors_.gather([&] { fill(*value, key, path_of(key.name), *node, rule); });
      },
      slot);
}

void Reader::word_leaf(const Key& key, std::string& value,
                       std::span<const std::string_view> words) {
  const std::optional<YAML::Node> node = find(key, "one of " + one_of(words));
  if (!node) return;
  const std::string path = path_of(key.name);
  errors_.gather([&] {
    if (!node->IsScalar())
      wrong_type(path, "a word", *node, remedy(key, "one of " + one_of(words)));
    if (std::find(words.begin(), words.end(), node->Scalar()) == words.end()) {
      const std::vector<std::string> known(words.begin(), words.end());
      fail(path, fmt::format("is {}, which is not a known choice", node->Scalar()),
           suggestion(node->Scalar(), known, "Choose one of"));
    }
    value = node->Scalar();
  });
}

bool Reader::enter(const Key& key, bool) {
  const std::optional<YAML::Node> node = find(key, "a map of keys");
  if (!node) return false;
  const std::string path = path_of(key.name);
  if (node->IsMap()) {
    push(path, *node, false);
    return true;
  }
  errors_.gather([&] {
    wrong_type(path, "a map of keys", *node,
               remedy(key, "a map of keys; {} stands for its defaults"));
  });
  return false;
}

std::size_t Reader::enter_list(const Key& key, std::size_t) {
  const std::optional<YAML::Node> node = find(key, "a list of maps");
  const std::string path = path_of(key.name);
  const bool is_list = node && node->IsSequence();
  if (node && !is_list) {
    errors_.gather(
        [&] { wrong_type(path, "a list of maps", *node, remedy(key, "a list of maps")); });
  }
  push(path, is_list ? *node : YAML::Node(YAML::NodeType::Sequence), true);
  return is_list ? node->size() : 0;
}

void Reader::enter_map(const Key& key, std::vector<std::string>& names) {
  names.clear();
  const std::optional<YAML::Node> node = find(key, "a map from names to maps");
  const std::string path = path_of(key.name);
  const bool is_map = node && node->IsMap();
  if (node && !is_map) {
    errors_.gather([&] {
      wrong_type(path, "a map from names to maps", *node, remedy(key, "a map from names to maps"));
    });
  }
  for (const auto& pair : is_map ? *node : YAML::Node(YAML::NodeType::Map)) {
    const std::string& name = pair.first.Scalar();
    errors_.gather([&] {
      if (!is_name(name))
        fail(join_path(path, name), "is not a name", "Use letters, digits, _ and - alone.");
      names.push_back(name);
    });
  }
  push(path, is_map ? *node : YAML::Node(YAML::NodeType::Map), true);
}

std::string Reader::enter_choice(const Key& key, std::span<const std::string_view> names,
                                 std::string_view, std::span<const Preset> presets) {
  const std::string choices = one_of(names);
  const std::optional<YAML::Node> node = find(key, "one of " + choices);
  if (!node) return {};
  std::string name;
  errors_.gather([&] { name = chosen(key, path_of(key.name), *node, names, presets); });
  if (name.empty()) return {};
  YAML::Node map(YAML::NodeType::Map);
  if (!node->IsMap()) {
    const bool preset = node->Scalar() != name;
    map[name] = preset ? YAML::Node(node->Scalar()) : YAML::Node(YAML::NodeType::Map);
  }
  push(path_of(key.name), node->IsMap() ? *node : map, true);
  return name;
}

std::string Reader::chosen(const Key& key, const std::string& path, const YAML::Node& node,
                           std::span<const std::string_view> names,
                           std::span<const Preset> presets) const {
  const std::string form =
      fmt::format("Give {} as {{name: {{its keys}}}}, with one of {}.", noun(key), one_of(names));
  const bool bare = node.IsScalar();  // in quotes or not, as JSON has it
  if (node.IsMap() && node.size() > 1) {  // the last is the one that --set added, where it did
    std::vector<std::string> given;
    for (const auto& pair : node) given.push_back(pair.first.Scalar());
    fail(join_path(path, given.back()),
         fmt::format("stands beside {}, but only one can be chosen", given.front()), form);
  }
  if (!bare && !(node.IsMap() && node.size() == 1)) {
    const std::string is = node.IsMap() ? "a map of 0" : describe(node);
    fail(path, fmt::format("must be a map with one key, the name of the choice, but is {}", is),
         form);
  }
  const std::string name = bare ? node.Scalar() : node.begin()->first.Scalar();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    const Preset* preset = bare ? preset_named(name, presets) : nullptr;
    if (preset != nullptr) return std::string(preset->choice);
    std::vector<std::string> known(names.begin(), names.end());
    for (const Preset& one : presets)
      if (bare) known.emplace_back(one.name);
    fail(bare ? path : join_path(path, name),
         bare ? fmt::format("is {}, which is not a known choice", name) : "is not a known choice",
         suggestion(name, known, "Choose one of"));
  }
  return name;
}

void Reader::descend(std::string_view name, std::string_view shorthand,
                     std::span<const Preset> presets) {
  const Frame& parent = frames_.back();
  const std::string path = join_path(parent.path, name);
  YAML::Node node;
  if (parent.node.IsSequence())
    node.reset(parent.node[std::stoul(std::string(name.substr(1)))]);
  else
    node.reset(parent.node[std::string(name)]);
  if (!shorthand.empty() && (node.IsScalar() || node.IsSequence())) {
    YAML::Node map(YAML::NodeType::Map);
    map[std::string(shorthand)] = node;
    node.reset(map);
  }
  const std::size_t earlier = errors_.count();
  const Preset* preset = node.IsScalar() ? preset_named(node.Scalar(), presets) : nullptr;
  if (preset != nullptr) node.reset(map_of(*preset));
  if (!node.IsMap()) {
    errors_.gather([&] {
      if (!presets.empty() && node.IsScalar() && !parse<double>(node.Scalar()))
        fail(path, fmt::format("is {}, which is not a known choice", node.Scalar()),
             suggestion(node.Scalar(), names_of(presets), "Give a map of keys, or one of"));
      wrong_type(path, "a map of keys", node,
                 "Write its keys as {key: value}; {} stands for its defaults.");
    });
    node.reset(YAML::Node(YAML::NodeType::Map));
  }
  push(path, node, false);
  frames_.back().earlier = earlier;
}

void Reader::broken(std::string_view key, const std::string& what, const std::string& remedy_text) {
  auto& list = frames_.back().broken;
  const auto same = [key](const auto& entry) { return entry.first == key; };
  if (std::any_of(list.begin(), list.end(), same)) return;
  list.emplace_back(key, InputError(what, document_.where(path_of(key)), remedy_text));
}

void Reader::idle(bool is_idle, std::string_view key, std::string_view why) {
  if (!is_idle || !document_.has(path_of(key))) return;
  broken(key, fmt::format("has no effect: {}", why),
         fmt::format("Leave {} out.", split_path(key).back()));
}

/// Tells of keys that are not declared; what was likely meant by each.
std::vector<std::string> Reader::refuse_unknown_keys(const Frame& frame) {
  std::vector<std::string> meant;
  if (frame.open) return meant;
  const std::vector<std::string>& known = frame.declared;
  for (const auto& pair : frame.node) {
    const std::string& name = pair.first.Scalar();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    meant.push_back(likely(name, known));
    // Of {end: 2,5}, YAML makes a 2 and a key 5.
    const bool decimals =
        pair.second.IsNull() && name.find_first_not_of("0123456789") == std::string::npos;
    errors_.gather([&] {
      fail(join_path(frame.path, name), "is not a known key",
           decimals ? fmt::format("Decimals begin with a point, not a comma: .{}.", name)
                    : suggestion(name, known, "Allowed here:"));
    });
  }
  return meant;
}

void Reader::leave() {
  ABUT_ASSERT(!frames_.empty());
  const Frame frame = std::move(frames_.back());
  frames_.pop_back();
  const bool misread = errors_.count() > frame.earlier && frame.node.size() == 0;
  const std::vector<std::string> meant = refuse_unknown_keys(frame);
  for (const auto& [key, error] : frame.missing)
    if (!misread && std::find(meant.begin(), meant.end(), key) == meant.end()) errors_.add(error);
  if (errors_.count() > frame.earlier) return;
  for (const auto& [key, error] : frame.broken) errors_.add(error);
}

void Reader::check_range(const Key& key, const std::string& path, const YAML::Node& node,
                         double value, std::string_view form, const Rule& rule) const {
  if (!rule.holds(value))
    fail(path,
         fmt::format(
             "must be {}, but is {}", rule.words(),
             split_quantity(node.Scalar()) ? node.Scalar() : with_unit(node.Scalar(), key.unit)),
         remedy(key, form, rule));
}

double Reader::number(const Key& key, const std::string& path, const YAML::Node& node,
                      const Rule& rule) const {
  if (is_plain(node) && is_not_finite(node.Scalar()))
    fail(path, fmt::format("must be finite, but is {}", node.Scalar()), remedy(key, "", rule));
  std::optional<double> value =
      is_plain(node) ? parse<double>(node.Scalar()) : std::optional<double>();
  if (value && *value != 0.0) note_plain(document_, key, path);
  if (!value && node.IsScalar()) value = quantity_in(document_, key, path, node.Scalar(), rule);
  if (!value || !std::isfinite(*value)) wrong_type(path, "a number", node, remedy(key, "", rule));
  check_range(key, path, node, *value, "", rule);
  return *value;
}

std::int64_t Reader::whole(const Key& key, const std::string& path, const YAML::Node& node,
                           const Rule& rule) const {
  const std::optional<std::int64_t> value =
      is_plain(node) ? parse<std::int64_t>(node.Scalar()) : std::optional<std::int64_t>();
  if (!value) wrong_type(path, "a whole number", node, remedy(key, "a whole number", rule));
  check_range(key, path, node, static_cast<double>(*value), "a whole number", rule);
  return *value;
}

std::string Reader::text(const Key& key, const std::string& path, const YAML::Node& node) const {
  if (!node.IsScalar()) wrong_type(path, "text", node, remedy(key, "text"));
  const std::string& text = node.Scalar();
  if (key.unit.empty()) return text;
  // An expression in the scene's units, or a number with a unit of its own.
  const std::optional<Quantity> parts = split_quantity(text);
  const std::optional<double> value = parts && parse_unit(parts->unit)
                                          ? quantity_in(document_, key, path, text)
                                          : std::optional<double>();
  if (value) return fmt::format("{}", *value);
  if (text.find_first_of("123456789") != std::string::npos) note_plain(document_, key, path);
  return text;
}

const YAML::Node& Reader::list_of(const Key& key, const std::string& path, const YAML::Node& node,
                                  const char* form) const {
  if (!node.IsSequence()) wrong_type(path, form, node, remedy(key, form));
  return node;
}

void Reader::fill(double& value, const Key& key, const std::string& path, const YAML::Node& node,
                  const Rule& rule) {
  value = number(key, path, node, rule);
}

void Reader::fill(int& value, const Key& key, const std::string& path, const YAML::Node& node,
                  const Rule& rule) {
  const std::int64_t wide = whole(key, path, node, rule);
  constexpr int limit = std::numeric_limits<int>::max();
  if (wide > limit || wide < -limit)
    fail(path, fmt::format("must be at most {} in size, but is {}", limit, wide),
         remedy(key, "a whole number", rule));
  value = static_cast<int>(wide);
}

void Reader::fill(std::int64_t& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule& rule) {
  value = whole(key, path, node, rule);
}

void Reader::fill(bool& value, const Key& key, const std::string& path, const YAML::Node& node,
                  const Rule&) {
  if (!is_plain(node) || (node.Scalar() != "true" && node.Scalar() != "false"))
    wrong_type(path, "true or false", node, remedy(key, "true or false"));
  value = node.Scalar() == "true";
}

void Reader::fill(std::string& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule&) {
  value = text(key, path, node);
}

void Reader::fill(std::vector<double>& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule& rule) {
  value.clear();
  const bool one = is_plain(node) && parse<double>(node.Scalar());
  if (one || (node.IsScalar() && split_quantity(node.Scalar()))) {  // a list of one
    value.push_back(number(key, path, node, rule));
    return;
  }
  for (const YAML::Node& item : list_of(key, path, node, "a list of numbers"))
    value.push_back(number(key, fmt::format("{}[{}]", path, value.size()), item, rule));
}

void Reader::fill(std::vector<std::string>& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule&) {
  value.clear();
  if (node.IsScalar()) {  // a list of one
    value.push_back(text(key, path, node));
    return;
  }
  for (const YAML::Node& item : list_of(key, path, node, "a list of words"))
    value.push_back(text(key, fmt::format("{}[{}]", path, value.size()), item));
}

void Reader::fill(std::array<std::string, 2>& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule&) {
  const YAML::Node& list = list_of(key, path, node, "a list of two words");
  if (list.size() != value.size())
    fail(path, fmt::format("must be a list of two words, but has {}", list.size()),
         remedy(key, "a list of two words"));
  for (std::size_t i = 0; i < value.size(); ++i)
    value[i] = text(key, fmt::format("{}[{}]", path, i), list[i]);
}

}  // namespace

void read_fields(const Document& document, std::string_view path,
                 const std::function<void(Fields&)>& visit) {
  const std::optional<YAML::Node> found = document.tree().find(path);
  if (!found) throw InputError("is missing", document.where(path), "Give its keys as a map.");
  const YAML::Node node(*found);
  if (!node.IsMap())
    throw InputError("must be a map of keys, but is " + describe(node), document.where(path),
                     "Give its keys as a map.");
  Reader reader(document, std::string(path), node);
  visit(reader);
  reader.leave();
  ABUT_ASSERT(reader.done());
  reader.errors().raise();
}

}  // namespace abut
