#include "base/yaml_values.hpp"

#include <algorithm>
#include <cctype>

#include "base/synonyms.hpp"

namespace abut {

std::string describe(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "empty";
  return node.Tag() == "!" ? '"' + node.Scalar() + '"' : node.Scalar();
}

bool is_plain(const YAML::Node& node) { return node.IsScalar() && node.Tag() != "!"; }

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

std::string_view bare_unit(std::string_view unit) { return unit.substr(0, unit.find(" (")); }

std::string with_unit(const std::string& text, std::string_view unit) {
  return unit.empty() ? text : fmt::format("{} {}", text, bare_unit(unit));
}

std::string noun(const Key& key) {
  const std::string_view words = key.help.substr(0, key.help.find_first_of(",;:"));
  const bool clause = words.starts_with("what ") || words.starts_with("whether ");
  return fmt::format("{}{}", clause ? "" : "the ", words);
}

std::string remedy(const Key& key, std::string_view form, const Rule& rule) {
  std::string text = fmt::format("Give {}", noun(key));
  if (!form.empty()) text += fmt::format(" as {}", form);
  if (!key.unit.empty()) text += fmt::format(" in {}", bare_unit(key.unit));
  const std::string range = rule.range();
  if (!range.empty()) text += fmt::format(", {}", range);
  return text + '.';
}

std::string likely(std::string_view word, std::span<const std::string> known) {
  const std::string meant = meant_by(word, known);
  return meant.empty() ? nearest(word, known) : meant;
}

std::string suggestion(std::string_view word, std::span<const std::string> known,
                       std::string_view lead) {
  const std::string near = likely(word, known);
  const std::string hint = near.empty() ? "" : fmt::format("Did you mean {}? ", near);
  return hint + fmt::format("{} {}.", lead, known.empty() ? "no key" : one_of(known));
}

}  // namespace abut
