#include "base/yaml_resolved.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "base/assert.hpp"
#include "base/yaml_document.hpp"

namespace abut {

/// One value: a scalar or flow list ready to print, or a map or list of further nodes.
struct ResolvedYaml::Node {
  enum class Kind { map, list, text };
  Kind kind = Kind::map;
  std::string text, unit;
  std::vector<std::pair<std::string, std::unique_ptr<Node>>> children;

  Node* find(std::string_view name) {
    for (auto& [key, node] : children)
      if (key == name) return node.get();
    return nullptr;
  }
  Node& child(std::string_view name) {
    if (Node* found = find(name)) return *found;
    children.emplace_back(std::string(name), std::make_unique<Node>());
    return *children.back().second;
  }
};

namespace {

using Node = ResolvedYaml::Node;

/// Shortest form that reads back to the same double, and looks like a number with a fraction.
std::string written(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char letter : text) {
    const unsigned char code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      out += '\\';
      out += letter;
    } else if (code < 0x20 || code == 0x7f) {
      out += fmt::format("\\x{:02x}", code);
    } else {
      out += letter;
    }
  }
  return out + '"';
}

/// Plain when no reader of YAML can take it for anything but text, else quoted.
std::string written(const std::string& text) {
  const auto plain_letter = [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/';
  };
  static constexpr std::array<std::string_view, 10> taken{"true", "false", "null", "yes", "no",
                                                          "on",   "off",   "y",    "n",   "nan"};
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool plain = !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
                     std::all_of(text.begin(), text.end(), plain_letter) &&
                     std::find(taken.begin(), taken.end(), lower) == taken.end();
  return plain ? text : quoted(text);
}

std::string written(bool value) { return value ? "true" : "false"; }
std::string written(int value) { return fmt::format("{}", value); }
std::string written(std::int64_t value) { return fmt::format("{}", value); }

template <class Values>
std::string written_list(const Values& values) {
  std::vector<std::string> items;
  for (const auto& value : values) items.push_back(written(value));
  return fmt::format("[{}]", fmt::join(items, ", "));
}
std::string written(const std::vector<double>& values) { return written_list(values); }
std::string written(const std::vector<std::string>& values) { return written_list(values); }
std::string written(const std::array<std::string, 2>& values) { return written_list(values); }

/// A tree of somebody else in one line. A plain scalar stays plain, so that a number stays one.
std::string flow(const YAML::Node& node, const std::string& path,
                 const ResolvedYaml::Placed& placed) {
  std::vector<std::string> items;
  if (node.IsMap()) {
    for (const auto& pair : node)
      items.push_back(fmt::format(
          "{}: {}", flow(pair.first, {}, {}),
          flow(pair.second, pair.first.IsScalar() ? join_path(path, pair.first.Scalar()) : path,
               placed)));
    return fmt::format("{{{}}}", fmt::join(items, ", "));
  }
  if (node.IsSequence()) {
    for (const YAML::Node& item : node) items.push_back(flow(item, path, placed));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  if (!node.IsScalar()) return "null";
  const std::string text = placed ? placed(path, node.Scalar()) : node.Scalar();
  const auto plain_letter = [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/' || c == '+';
  };
  const bool plain = node.Tag() != "!" && !text.empty() &&  // "!": it stood in quotes
                     std::all_of(text.begin(), text.end(), plain_letter);
  return plain ? text : quoted(text);
}

class Writer final : public Fields {
 public:
  Writer(Node& at, const UnitSystem& units) : Fields(Purpose::write), units_(units), stack_{&at} {}

  void ignore(std::string_view) override {}
  void ignore_rest() override {}
  void idle(bool is_idle, std::string_view key, std::string_view) override {
    if (!is_idle) return;
    Node* at = stack_.back();
    std::vector<std::string> steps = split_path(key);
    const std::string last = std::move(steps.back());
    steps.pop_back();
    for (const std::string& step : steps) {
      at = at->find(step);
      if (at == nullptr) return;
    }
    std::erase_if(at->children, [&last](const auto& entry) { return entry.first == last; });
  }
  void leave() override {
    ABUT_ASSERT(stack_.size() > 1);
    stack_.pop_back();
  }

 protected:
  void leaf(const Key& key, Slot slot, const Rule&) override {
    std::visit([this, &key](const auto* value) { put(key, *value); }, slot);
  }
  void word_leaf(const Key& key, std::string& value, std::span<const std::string_view>) override {
    put(key, value);
  }
  bool enter(const Key& key, bool present) override {
    if (present) descend(key.name, {}, {});
    return present;
  }
  std::size_t enter_list(const Key& key, std::size_t count) override {
    descend(key.name, {}, {});
    stack_.back()->kind = Node::Kind::list;
    return count;
  }
  void enter_map(const Key& key, std::vector<std::string>&) override { descend(key.name, {}, {}); }
  std::string enter_choice(const Key& key, std::span<const std::string_view>,
                           std::string_view current, std::span<const Preset>) override {
    if (!current.empty()) descend(key.name, {}, {});
    return std::string(current);
  }
  void descend(std::string_view name, std::string_view, std::span<const Preset>) override {
    Node& child = stack_.back()->child(name);
    stack_.push_back(&child);
  }
  void broken(std::string_view, const std::string&, const std::string&) override {}

 private:
  template <class T>
  void put(const Key& key, const T& value) {
    Node& node = stack_.back()->child(key.name);
    node.kind = Node::Kind::text;
    node.text = written(value);
    node.unit = units_.word(key.unit);
  }
  template <class T>
  void put(const Key& key, const std::optional<T>& value) {
    if (value) put(key, *value);
  }

  const UnitSystem& units_;
  std::vector<Node*> stack_;
};

void print(const Node& node, std::size_t indent, bool first_inline, std::string& out) {
  bool inline_next = first_inline;
  for (const auto& [name, child] : node.children) {
    if (!inline_next) out.append(indent, ' ');
    inline_next = false;
    if (node.kind == Node::Kind::list) {
      out += "- ";
      print(*child, indent + 2, true, out);
      continue;
    }
    out += name + ':';
    if (child->kind == Node::Kind::text) {
      out += ' ' + child->text;
      if (!child->unit.empty()) out += "  # [" + child->unit + ']';
      out += '\n';
    } else if (child->children.empty()) {
      out += child->kind == Node::Kind::list ? " []\n" : " {}\n";
    } else {
      out += '\n';
      print(*child, indent + 2, false, out);
    }
  }
  if (first_inline && node.children.empty()) out += "{}\n";
}

}  // namespace

ResolvedYaml::ResolvedYaml(UnitSystem units)
    : units_(std::move(units)), root_(std::make_unique<Node>()) {}
ResolvedYaml::~ResolvedYaml() = default;

std::unique_ptr<Fields> ResolvedYaml::writer_at(std::string_view path) {
  Node* at = root_.get();
  for (const std::string& step : split_path(path)) at = &at->child(step);
  return std::make_unique<Writer>(*at, units_);
}

void ResolvedYaml::copy(std::string_view path, const Document& document, const Placed& placed) {
  Node* at = root_.get();
  YAML::Node from(document.root());
  for (const std::string& step : split_path(path)) {
    at = &at->child(step);
    from.reset(from[step]);
  }
  at->kind = Node::Kind::text;
  at->text = flow(from, std::string(path), placed);
}

namespace {

void keep_below(Node& node, const std::string& path,
                const std::function<bool(const std::string&)>& wanted) {
  if (node.kind != Node::Kind::map) return;
  const auto own = [&path](const std::string& name) { return join_path(path, name); };
  std::erase_if(node.children, [&](const auto& entry) { return !wanted(own(entry.first)); });
  for (const auto& [name, child] : node.children) keep_below(*child, own(name), wanted);
}

}  // namespace

void ResolvedYaml::keep(std::string_view path,
                        const std::function<bool(const std::string&)>& wanted) {
  Node* at = root_.get();
  for (const std::string& step : split_path(path)) at = &at->child(step);
  keep_below(*at, std::string(path), wanted);
}

std::string ResolvedYaml::text() const {
  std::string out;
  print(*root_, 0, false, out);
  return out;
}

}  // namespace abut
