#include "base/yaml_fields.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "base/assert.hpp"
#include "base/error.hpp"

namespace abut {
namespace {

/// What a message calls a value.
std::string describe(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "empty";
  return node.Tag() == "!" ? '"' + node.Scalar() + '"' : node.Scalar();
}

/// A scalar that is not quoted: quotes say that text is meant.
bool is_plain(const YAML::Node& node) { return node.IsScalar() && node.Tag() != "!"; }

template <class T>
std::optional<T> parse(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  T value{};
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || text.empty()) return std::nullopt;
  return value;
}

/// YAML writes .nan and .inf; from_chars knows nan and inf as well.
bool is_not_finite(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (text.starts_with('+') || text.starts_with('-')) text.erase(0, 1);
  if (text.starts_with('.')) text.erase(0, 1);
  return text == "nan" || text == "inf" || text == "infinity";
}

bool is_name(const std::string& text) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

std::string with_unit(const std::string& text, std::string_view unit) {
  return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

template <class Strings>
std::string one_of(const Strings& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Of the help only the noun itself fits into a sentence.
std::string_view noun(const Key& key) { return key.help.substr(0, key.help.find_first_of(",;:")); }

/// The sentence that says what to write.
std::string remedy(const Key& key, std::string_view form, const Rule& rule = any) {
  std::string text = fmt::format("Give the {}", noun(key));
  if (!form.empty()) text += fmt::format(" as {}", form);
  if (!key.unit.empty()) text += fmt::format(" in {}", key.unit);
  const std::string range = rule.range();
  if (!range.empty()) text += fmt::format(", {}", range);
  return text + '.';
}

std::string suggestion(std::string_view word, std::span<const std::string> known,
                       std::string_view lead) {
  const std::string near = nearest(word, known);
  const std::string hint = near.empty() ? "" : fmt::format("Did you mean {}? ", near);
  return hint + fmt::format("{} {}.", lead, known.empty() ? "no key" : one_of(known));
}

class Reader final : public Fields {
 public:
  Reader(const Document& document, std::string path, const YAML::Node& node)
      : Fields(Purpose::read), document_(document) {
    push(std::move(path), node, false);
  }

  void ignore(std::string_view key) override { declare(key); }
  void ignore_rest() override { frames_.back().open = true; }
  void leave() override;
  bool done() const { return frames_.empty(); }

 protected:
  void leaf(const Key& key, Slot slot, const Rule& rule) override;
  void word_leaf(const Key& key, std::string& value,
                 std::span<const std::string_view> words) override;
  bool enter(const Key& key, bool present) override;
  std::size_t enter_list(const Key& key, std::size_t count) override;
  void enter_map(const Key& key, std::vector<std::string>& names) override;
  std::string enter_choice(const Key& key, std::span<const std::string_view> names,
                           std::string_view current) override;
  void descend(std::string_view name) override;
  void broken(std::string_view key, const std::string& what, const std::string& remedy) override;

 private:
  struct Frame {
    std::string path;
    YAML::Node node;
    bool open = false;  // keys that are not declared belong to somebody else
    std::vector<std::string> declared;
    // Kept until all keys are known, so that a misspelt key is not reported as a missing one.
    std::optional<InputError> missing, broken;
  };

  void push(std::string path, const YAML::Node& node, bool open) {
    frames_.push_back(Frame{std::move(path), node, open, {}, {}, {}});
  }
  void declare(std::string_view key) { frames_.back().declared.emplace_back(key); }
  std::string path_of(std::string_view key) const { return join_path(frames_.back().path, key); }
  std::optional<YAML::Node> find(const Key& key, const std::string& form, const Rule& rule = any);
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
  void fill(std::optional<double>& value, const Key&, const std::string& path, const YAML::Node&,
            const Rule&);
  void fill(std::vector<double>& value, const Key&, const std::string& path, const YAML::Node&,
            const Rule&);
  void fill(std::vector<std::string>& value, const Key&, const std::string& path, const YAML::Node&,
            const Rule&);
  void fill(std::array<std::string, 2>& value, const Key&, const std::string& path,
            const YAML::Node&, const Rule&);

  const Document& document_;
  std::vector<Frame> frames_;
};

const char* form_of(const double*) { return ""; }
const char* form_of(const int*) { return "a whole number"; }
const char* form_of(const std::int64_t*) { return "a whole number"; }
const char* form_of(const bool*) { return "true or false"; }
const char* form_of(const std::string*) { return "text"; }
const char* form_of(const std::optional<double>*) { return ""; }
const char* form_of(const std::vector<double>*) { return "a list of numbers"; }
const char* form_of(const std::vector<std::string>*) { return "a list of words"; }
const char* form_of(const std::array<std::string, 2>*) { return "a list of two words"; }

/// The value of a declared key. When it is absent and required, that is noted for leave().
std::optional<YAML::Node> Reader::find(const Key& key, const std::string& form, const Rule& rule) {
  declare(key.name);
  Frame& frame = frames_.back();
  for (const auto& pair : frame.node)
    if (pair.first.Scalar() == key.name) return pair.second;
  if (key.presence == Presence::required && !frame.missing) {
    const std::string where = document_.where(path_of(key.name));
    frame.missing.emplace("is missing", where, remedy(key, form, rule));
  }
  return std::nullopt;
}

void Reader::leaf(const Key& key, Slot slot, const Rule& rule) {
  std::visit(
      [this, &key, &rule](auto* value) {
        const std::optional<YAML::Node> node = find(key, form_of(value), rule);
        if (node) fill(*value, key, path_of(key.name), *node, rule);
      },
      slot);
}

void Reader::word_leaf(const Key& key, std::string& value,
                       std::span<const std::string_view> words) {
  const std::optional<YAML::Node> node = find(key, "one of " + one_of(words));
  if (!node) return;
  const std::string path = path_of(key.name);
  if (!node->IsScalar()) wrong_type(path, "a word", *node, remedy(key, "one of " + one_of(words)));
  if (std::find(words.begin(), words.end(), node->Scalar()) == words.end()) {
    const std::vector<std::string> known(words.begin(), words.end());
    fail(path, fmt::format("is {}, which is not a known choice", node->Scalar()),
         suggestion(node->Scalar(), known, "Choose one of"));
  }
  value = node->Scalar();
}

bool Reader::enter(const Key& key, bool) {
  const std::optional<YAML::Node> node = find(key, "a map of keys");
  if (!node) return false;
  const std::string path = path_of(key.name);
  if (!node->IsMap())
    wrong_type(path, "a map of keys", *node,
               remedy(key, "a map of keys; {} stands for its defaults"));
  push(path, *node, false);
  return true;
}

std::size_t Reader::enter_list(const Key& key, std::size_t) {
  const std::optional<YAML::Node> node = find(key, "a list of maps");
  const std::string path = path_of(key.name);
  if (node && !node->IsSequence())
    wrong_type(path, "a list of maps", *node, remedy(key, "a list of maps"));
  push(path, node ? *node : YAML::Node(YAML::NodeType::Sequence), true);
  return node ? node->size() : 0;
}

void Reader::enter_map(const Key& key, std::vector<std::string>& names) {
  names.clear();
  const std::optional<YAML::Node> node = find(key, "a map from names to maps");
  const std::string path = path_of(key.name);
  if (node && !node->IsMap())
    wrong_type(path, "a map from names to maps", *node, remedy(key, "a map from names to maps"));
  if (node) {
    for (const auto& pair : *node) {
      const std::string& name = pair.first.Scalar();
      if (!is_name(name))
        fail(join_path(path, name), "is not a name", "Use letters, digits, _ and - alone.");
      names.push_back(name);
    }
  }
  push(path, node ? *node : YAML::Node(YAML::NodeType::Map), true);
}

std::string Reader::enter_choice(const Key& key, std::span<const std::string_view> names,
                                 std::string_view) {
  const std::string choices = one_of(names);
  const std::optional<YAML::Node> node = find(key, "one of " + choices);
  if (!node) return {};
  const std::string path = path_of(key.name);
  const bool bare = is_plain(*node);
  if (!bare && !(node->IsMap() && node->size() == 1)) {
    const std::string is =
        node->IsMap() ? fmt::format("a map of {}", node->size()) : describe(*node);
    fail(path, fmt::format("must be a map with one key, the name of the choice, but is {}", is),
         fmt::format("Give the {} as {{name: {{its keys}}}}, with one of {}.", noun(key), choices));
  }
  const std::string name = bare ? node->Scalar() : node->begin()->first.Scalar();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    const std::vector<std::string> known(names.begin(), names.end());
    fail(bare ? path : join_path(path, name),
         bare ? fmt::format("is {}, which is not a known choice", name) : "is not a known choice",
         suggestion(name, known, "Choose one of"));
  }
  YAML::Node map(YAML::NodeType::Map);
  if (bare) map[name] = YAML::Node(YAML::NodeType::Map);
  push(path, bare ? map : *node, true);
  return name;
}

void Reader::descend(std::string_view name) {
  const Frame& parent = frames_.back();
  const std::string path = join_path(parent.path, name);
  YAML::Node node;
  if (parent.node.IsSequence())
    node.reset(parent.node[static_cast<std::size_t>(std::stoul(std::string(name.substr(1))))]);
  else
    node.reset(parent.node[std::string(name)]);
  if (!node.IsMap())
    wrong_type(path, "a map of keys", node,
               "Write its keys as {key: value}; {} stands for its defaults.");
  push(path, node, false);
}

void Reader::broken(std::string_view key, const std::string& what, const std::string& remedy_text) {
  Frame& frame = frames_.back();
  if (!frame.broken) frame.broken.emplace(what, document_.where(path_of(key)), remedy_text);
}

void Reader::leave() {
  ABUT_ASSERT(!frames_.empty());
  const Frame frame = std::move(frames_.back());
  frames_.pop_back();
  if (!frame.open) {
    for (const auto& pair : frame.node) {
      const std::string& name = pair.first.Scalar();
      if (std::find(frame.declared.begin(), frame.declared.end(), name) == frame.declared.end())
        fail(join_path(frame.path, name), "is not a known key",
             suggestion(name, frame.declared, "Allowed here:"));
    }
  }
  if (frame.missing) throw *frame.missing;
  if (frame.broken) throw *frame.broken;
}

void Reader::check_range(const Key& key, const std::string& path, const YAML::Node& node,
                         double value, std::string_view form, const Rule& rule) const {
  if (!rule.holds(value))
    fail(path,
         fmt::format("must be {}, but is {}", rule.words(), with_unit(node.Scalar(), key.unit)),
         remedy(key, form, rule));
}

double Reader::number(const Key& key, const std::string& path, const YAML::Node& node,
                      const Rule& rule) const {
  if (is_plain(node) && is_not_finite(node.Scalar()))
    fail(path, fmt::format("must be finite, but is {}", node.Scalar()), remedy(key, "", rule));
  const std::optional<double> value =
      is_plain(node) ? parse<double>(node.Scalar()) : std::optional<double>();
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
  return node.Scalar();
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

void Reader::fill(std::optional<double>& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule& rule) {
  value = number(key, path, node, rule);
}

void Reader::fill(std::vector<double>& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule& rule) {
  value.clear();
  for (const YAML::Node& item : list_of(key, path, node, "a list of numbers"))
    value.push_back(number(key, fmt::format("{}[{}]", path, value.size()), item, rule));
}

void Reader::fill(std::vector<std::string>& value, const Key& key, const std::string& path,
                  const YAML::Node& node, const Rule&) {
  value.clear();
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
  YAML::Node node(document.root());
  for (const std::string& step : split_path(path)) {
    if (!document.has(path) || !node.IsMap())
      throw InputError("is missing", document.where(path), "Give its keys as a map.");
    node.reset(node[step]);
  }
  if (!node.IsMap())
    throw InputError("must be a map of keys, but is " + describe(node), document.where(path),
                     "Give its keys as a map.");
  Reader reader(document, std::string(path), node);
  visit(reader);
  reader.leave();
  ABUT_ASSERT(reader.done());
}

}  // namespace abut
