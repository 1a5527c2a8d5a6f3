#pragma once

#include <cstddef>
#include <string>

namespace YAML {
class Node;
struct Mark;
}  // namespace YAML

namespace abut {

/// Values of a scene, at most: no honest one comes near.
constexpr std::size_t max_values = 200'000;

/// "scene.yaml:12"; the name alone where the place is not in a file.
std::string at_line(const std::string& name, const YAML::Mark& mark);

/// The one value of a YAML text. Its events are walked first, so that no tree is made of a text
/// that holds more values than a scene can, or that the library would read without end. Throws
/// InputError: syntax, a second document, tags, keys that are no words or given twice, too many
/// values. `name` is the text's place and `path` the value's key path, for messages.
YAML::Node parse_yaml(const std::string& text, const std::string& name, const std::string& path,
                      const std::string& remedy);

}  // namespace abut
