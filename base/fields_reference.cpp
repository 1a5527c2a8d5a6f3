#include "base/fields_reference.hpp"

#include <fmt/format.h>

#include <optional>

#include "base/assert.hpp"
#include "base/yaml_document.hpp"

namespace abut {
namespace {

const char* type_of(const double*) { return "number"; }
const char* type_of(const int*) { return "whole number"; }
const char* type_of(const std::int64_t*) { return "whole number"; }
const char* type_of(const bool*) { return "true or false"; }
const char* type_of(const std::string*) { return "text"; }
const char* type_of(const std::optional<double>*) { return "number"; }
const char* type_of(const std::vector<double>*) { return "list of numbers"; }
const char* type_of(const std::vector<std::string>*) { return "list of words"; }
const char* type_of(const std::array<std::string, 2>*) { return "list of two words"; }

std::string shown(double value) { return fmt::format("{}", value); }
std::string shown(int value) { return fmt::format("{}", value); }
std::string shown(std::int64_t value) { return fmt::format("{}", value); }
std::string shown(bool value) { return value ? "true" : "false"; }
std::string shown(const std::string& value) { return value.empty() ? "\"\"" : value; }
std::string shown(const std::optional<double>& value) { return value ? shown(*value) : "absent"; }
template <class Values>
std::string shown(const Values& values) {
  std::vector<std::string> items;
  for (const auto& value : values) items.push_back(shown(value));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

class Documenter final : public Fields {
 public:
  Documenter(std::vector<Reference::Row>& rows, std::string path)
      : Fields(Purpose::document), rows_(rows), stack_{std::move(path)} {}

  void ignore(std::string_view) override {}
  void ignore_rest() override {}
  void idle(bool, std::string_view, std::string_view) override {}
  void leave() override {
    ABUT_ASSERT(stack_.size() > 1);
    stack_.pop_back();
  }

 protected:
  void leaf(const Key& key, Slot slot, const Rule& rule) override {
    std::visit(
        [this, &key, &rule](const auto* value) {
          const std::string range = rule.range();
          const std::string type = type_of(value);
          row(key, range.empty() ? type : type + ", " + range, shown(*value));
        },
        slot);
  }
  void word_leaf(const Key& key, std::string& value,
                 std::span<const std::string_view> words) override {
    row(key, fmt::format("one of {}", fmt::join(words, ", ")), value);
  }
  bool enter(const Key& key, bool) override {
    row(key, "map", "optional");
    descend(key.name);
    return true;
  }
  std::size_t enter_list(const Key& key, std::size_t) override {
    row(key, "list of maps", "[]");
    descend(key.name);
    return 0;
  }
  void enter_map(const Key& key, std::vector<std::string>&) override {
    row(key, "map from names to maps", "{}");
    descend(key.name);
  }
  std::string enter_choice(const Key& key, std::span<const std::string_view> names,
                           std::string_view current) override {
    row(key, fmt::format("choice of {}", fmt::join(names, ", ")),
        current.empty() ? "absent" : std::string(current));
    descend(key.name);
    return std::string(current);
  }
  void descend(std::string_view name, std::string_view = {}) override {
    stack_.push_back(join_path(stack_.back(), name == "[]" ? "[i]" : name));
  }
  void broken(std::string_view, const std::string&, const std::string&) override {}

 private:
  void row(const Key& key, const std::string& type, const std::string& fallback) {
    const bool required = key.presence == Presence::required;
    rows_.push_back({join_path(stack_.back(), key.name), type, std::string(key.unit),
                     required ? "required" : fallback, std::string(key.help)});
  }

  std::vector<Reference::Row>& rows_;
  std::vector<std::string> stack_;
};

}  // namespace

void Reference::heading(std::string_view text) { sections_.push_back({std::string(text), {}}); }

std::unique_ptr<Fields> Reference::documenter_at(std::string_view path) {
  if (sections_.empty()) sections_.emplace_back();
  return std::make_unique<Documenter>(sections_.back().rows, std::string(path));
}

std::string Reference::markdown() const {
  std::string out;
  for (const Section& section : sections_) {
    if (!section.heading.empty()) out += "## " + section.heading + "\n\n";
    out += "| key | type | unit | default | meaning |\n|---|---|---|---|---|\n";
    for (const Row& row : section.rows)
      out += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.path, row.type, row.unit,
                         row.fallback, row.help);
    out += '\n';
  }
  return out;
}

}  // namespace abut
