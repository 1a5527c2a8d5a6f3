#include "base/yaml_differences.hpp"

#include <yaml-cpp/yaml.h>

#include "base/error.hpp"
#include "base/yaml_document.hpp"

namespace abut {
namespace {

YAML::Node parsed(const std::string& text) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError("is no YAML: " + std::string(error.what()), "the resolved scene",
                     "Run the scene again.");
  }
}

std::string on_one_line(const YAML::Node& node) {
  if (!node) return "";
  YAML::Emitter out;
  out << YAML::Flow << YAML::DoubleQuoted << YAML::Auto << node;
  std::string text = out.c_str();
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

void compare(const std::string& path, const YAML::Node& before, const YAML::Node& now,
             std::vector<Difference>& out) {
  if (before && now && before.IsMap() && now.IsMap()) {
    for (const auto& entry : before) {
      const std::string key = entry.first.as<std::string>();
      compare(join_path(path, key), entry.second, now[key], out);
    }
    for (const auto& entry : now) {
      const std::string key = entry.first.as<std::string>();
      if (!before[key]) out.push_back({join_path(path, key), "", on_one_line(entry.second)});
    }
    return;
  }
  const std::string one = on_one_line(before), other = on_one_line(now);
  if (one != other) out.push_back({path, one, other});
}

}  // namespace

std::vector<Difference> differences(const std::string& before, const std::string& now) {
  std::vector<Difference> found;
  const YAML::Node one = parsed(before), other = parsed(now);
  compare("", one, other, found);
  return found;
}

}  // namespace abut
