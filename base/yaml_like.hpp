#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace YAML {
class Node;
}

namespace abut {

class YamlTree;

/// Key paths of the choices in a body, such as `integrator: {newmark: ...}`, where another name
/// replaces all that was there. `*` stands for any key.
std::span<const std::string_view> body_choices();

/// Whether a scene has bodies that are like others: `right: {like: left, ...}`.
bool has_likes(const YAML::Node& scene);

using Where = std::function<std::string(const std::string&)>;  // of a key path, for messages

/// The scene with all that its bodies have from those that they are like: maps key by key, anything
/// else as a whole; null leaves a key out. Throws InputError: the name of no body, a body that is
/// like itself or in a circle, more values than a scene can hold.
YAML::Node with_likes(const YAML::Node& scene, const Where& where);

/// In such a scene as it was before: where the text of a key path stands. That of another body when
/// the path's own body has less of it.
std::string origin_of(const YamlTree& scene, std::string_view path);

}  // namespace abut
