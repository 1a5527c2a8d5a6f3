#pragma once

#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace abut {

/// The key paths of a tree that a path with `*` means, in the tree's order: `*` is every key at its
/// place, and the name of a choice that is written as its name alone. All keys before the last are
/// there; the last one need not be where `takes_out` is false. A path without `*` means itself.
/// Throws InputError, `where` being the place of the path: no key matches, with the nearest names.
std::vector<std::string> paths_meant(const YAML::Node& root, const std::string& path,
                                     bool takes_out, const std::string& where);

/// A choice that is written as its name alone, as a map of it; any other node as it is.
YAML::Node choice_as_map(const YAML::Node& node);

}  // namespace abut
