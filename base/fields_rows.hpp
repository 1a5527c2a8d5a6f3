#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/fields_reference.hpp"

namespace abut {

/// A key as a row of a table. The path may stand for several: `{a,b}` for two alternatives of a
/// choice, `*` for all of them.
struct KeyRow {
  std::string path, type, unit, fallback, help;
};

/// The keys below a node that lives at a path, in the order of their declaration; what alternatives
/// of a choice have in common once, where the first of them has it.
std::vector<KeyRow> key_rows(const KeyNode& node, std::string_view path);

/// The same paths one by one.
std::vector<std::string> paths_below(const KeyNode& node, std::string_view path);

}  // namespace abut
