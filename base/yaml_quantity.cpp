#include "base/yaml_quantity.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/yaml_values.hpp"

namespace abut {
namespace {

[[noreturn]] void fail(const Document& document, const std::string& path, const std::string& what,
                       const std::string& remedy_text) {
  throw InputError(what, document.where(path), remedy_text);
}

}  // namespace

std::optional<double> quantity_in(const Document& document, const Key& key, const std::string& path,
                                  const std::string& text, const Rule& rule) {
  const std::optional<Quantity> parts = split_quantity(text);
  if (!parts) return std::nullopt;
  const std::string_view bare = bare_unit(key.unit);
  const std::optional<Unit> wanted = bare.empty() ? std::optional<Unit>(Unit{}) : parse_unit(bare);
  const std::optional<Unit> unit = parts->unit == bare ? wanted : parse_unit(parts->unit);
  if (parts->unit == bare && !wanted) return parse<double>(parts->number);  // MiB
  if (!unit)
    fail(document, path, fmt::format("is {}, but {} is not a known unit", text, parts->unit),
         remedy(key, "", rule));
  if (!wanted || bare.empty() || unit->dimension != wanted->dimension)
    fail(document, path,
         fmt::format("is {}, {}, but must be {}", text, dimension_words(unit->dimension),
                     wanted ? dimension_words(wanted->dimension) : fmt::format("in {}", bare)),
         remedy(key, "", rule));
  std::string& first = document.units_read().with;
  if (first.empty() && bare.size() == key.unit.size()) first = path;
  return converted(parts->number, *unit, *wanted);
}

void note_plain(const Document& document, const Key& key, const std::string& path) {
  std::string& first = document.units_read().without;
  if (!first.empty() || document.declares_units() || key.unit.empty()) return;
  const std::vector<std::string> steps = split_path(path);
  const bool moved = steps.size() > 3 && (steps[2] == "initial" || steps[2] == "points");
  if (moved && !document.body_of_copy(steps[1]).empty()) return;
  const std::optional<Unit> unit = parse_unit(key.unit);
  if (unit && unit->dimension != Dimension{}) first = path;
}

const Preset* preset_named(const std::string& name, std::span<const Preset> presets) {
  const auto found = std::ranges::find(presets, name, &Preset::name);
  return found == presets.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(std::span<const Preset> presets) {
  std::vector<std::string> names;
  for (const Preset& preset : presets) names.emplace_back(preset.name);
  return names;
}

YAML::Node map_of(const Preset& preset) {
  YAML::Node map(YAML::NodeType::Map);
  for (const auto& [key, value] : preset.values) map[std::string(key)] = std::string(value);
  return map;
}

}  // namespace abut
