#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/key.hpp"
#include "base/yaml_document.hpp"

namespace abut {

// Numbers with units, and names that stand for maps of keys. For the reader alone.

/// The number of a text with a unit, "5 mm", in the key's unit, which is the scene's. Nothing: the
/// text is no such. Throws InputError: a word that is no unit, or a unit of another dimension.
std::optional<double> quantity_in(const Document& document, const Key& key, const std::string& path,
                                  const std::string& text, const Rule& rule = any);

/// Tells the document of a number without a unit, where the key has one. What copies have is
/// written out without units: the body was read before.
void note_plain(const Document& document, const Key& key, const std::string& path);

/// Null: there is none of this name.
const Preset* preset_named(const std::string& name, std::span<const Preset> presets);
std::vector<std::string> names_of(std::span<const Preset> presets);
YAML::Node map_of(const Preset& preset);

}  // namespace abut
