#include "base/fields_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <tuple>
#include <utility>

#include "base/input_errors.hpp"
#include "base/yaml_document.hpp"
#include "base/yaml_values.hpp"

namespace abut {
namespace {

using Kind = KeyNode::Kind;

/// The step from a key to the keys of its items.
std::string_view item_step(const KeyNode& node) {
  if (node.kind == Kind::list) return "[i]";
  if (node.kind == Kind::names) return "<name>";
  return "";
}

/// Of a node at a path: where the keys of its items are.
std::string path_of_items(const KeyNode& node, const std::string& path) {
  const std::string_view step = item_step(node);
  return step.empty() || path.ends_with(step) ? path : join_path(path, step);
}

KeyRow row_of(const KeyNode& node, std::string path) {
  return {std::move(path), node.type(), node.unit, node.required ? "required" : node.fallback,
          node.help};
}

bool same_key(const KeyRow& a, const KeyRow& b) {
  return std::tie(a.path, a.type, a.unit, a.fallback, a.help) ==
         std::tie(b.path, b.type, b.unit, b.fallback, b.help);
}

/// Paths relative to the node.
std::vector<KeyRow> rows_below(const KeyNode& node);

/// What alternatives have, each row with the alternatives that have it.
std::vector<KeyRow> rows_of_choice(const KeyNode& choice) {
  std::vector<std::pair<KeyRow, std::vector<std::string>>> all;
  for (const KeyNode& alternative : choice.keys) {
    for (KeyRow& row : rows_below(alternative)) {
      const auto known =
          std::ranges::find_if(all, [&row](const auto& one) { return same_key(one.first, row); });
      if (known != all.end()) {
        known->second.push_back(alternative.name);
      } else {
        all.emplace_back(std::move(row), std::vector<std::string>{alternative.name});
      }
    }
  }
  std::vector<KeyRow> rows;
  for (auto& [row, names] : all) {
    const std::string step = names.size() == 1 ? names[0]
                             : names.size() == choice.keys.size()
                                 ? std::string("*")
                                 : fmt::format("{{{}}}", fmt::join(names, ","));
    row.path = join_path(step, row.path);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<KeyRow> rows_below(const KeyNode& node) {
  if (node.kind == Kind::choice) return rows_of_choice(node);
  std::vector<KeyRow> rows;
  for (const KeyNode& key : node.keys) {
    rows.push_back(row_of(key, key.name));
    const std::string prefix = path_of_items(key, key.name);
    for (KeyRow& row : rows_below(key)) {
      row.path = join_path(prefix, row.path);
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

void add_paths(const KeyNode& node, const std::string& path, std::vector<std::string>& paths) {
  for (const KeyNode& key : node.keys) {
    const std::string own = join_path(path, key.name);
    if (node.kind != Kind::choice) paths.push_back(own);
    add_paths(key, path_of_items(key, own), paths);
  }
}

/// Whether a step of a path that somebody wrote means the step of a declared one.
bool means(const std::string& step, std::string_view declared) {
  return declared == "<name>" || step == declared || (declared == "[i]" && step.starts_with('['));
}

/// A node that a path leads to, or how far it leads.
struct Way {
  const KeyNode* node = nullptr;  // the last that is there
  std::string path;               // of it, as declared
  std::size_t steps = 0;          // of those asked for
};

Way way_to(const KeySection& section, std::span<const std::string> steps) {
  Way way{&section.root, section.path, 0};
  for (const std::string& declared : split_path(section.path)) {
    if (way.steps == steps.size()) return way;
    if (!means(steps[way.steps], declared)) return {&section.root, section.path, 0};
    ++way.steps;
  }
  while (way.steps < steps.size()) {
    const std::string_view item = item_step(*way.node);
    const bool inside = way.path.ends_with(item) || way.node == &section.root;
    if (!item.empty() && !inside) {
      if (!means(steps[way.steps], item)) return way;
      way.path = join_path(way.path, item);
    } else {
      const auto next = std::ranges::find(way.node->keys, steps[way.steps], &KeyNode::name);
      if (next == way.node->keys.end()) return way;
      way.node = &*next;
      way.path = join_path(way.path, next->name);
    }
    ++way.steps;
  }
  return way;
}

/// Of paths, a line each, the shortest that end with this one: what was meant where somebody left
/// out the keys above.
std::string ends_of_paths(const std::string& paths, std::string_view end) {
  constexpr std::size_t most = 3;
  std::vector<std::string> found;
  std::istringstream lines(paths);
  for (std::string line; std::getline(lines, line);)
    if (line.ends_with("." + std::string(end))) found.push_back(line);
  std::ranges::stable_sort(found, {}, &std::string::size);
  found.resize(std::min(found.size(), most));
  return fmt::format("{}", fmt::join(found, ", "));
}

std::string entry(const KeyRow& row) {
  std::string text = fmt::format("{}\n    {}", row.path, row.type);
  if (!row.unit.empty()) text += fmt::format(" [{}]", row.unit);
  if (row.fallback == "required" || row.fallback == "optional") {
    text += "; " + row.fallback;
  } else {
    text += "; default " + row.fallback;
  }
  return text + "\n    " + row.help + "\n";
}

}  // namespace

std::vector<KeyRow> key_rows(const KeyNode& node, std::string_view path) {
  std::vector<KeyRow> rows = rows_below(node);
  for (KeyRow& row : rows) row.path = join_path(path, row.path);
  return rows;
}

std::vector<std::string> paths_below(const KeyNode& node, std::string_view path) {
  std::vector<std::string> paths;
  add_paths(node, std::string(path), paths);
  return paths;
}

std::string Reference::part(std::string_view path) const {
  const std::vector<std::string> steps = split_path(path);
  std::string out;
  Way farthest;
  std::vector<std::string> known;  // keys where the path ends
  for (const KeySection& section : sections_) {
    const Way way = way_to(section, steps);
    if (way.steps == steps.size()) {
      const bool items = way.path.ends_with('>') || way.path.ends_with(']');
      if (way.node != &section.root && !items && !way.node->help.empty())
        out += entry(row_of(*way.node, way.path));
      for (const KeyRow& row : key_rows(*way.node, path_of_items(*way.node, way.path)))
        out += entry(row);
    }
    if (farthest.node == nullptr || way.steps > farthest.steps) {
      farthest = way;
      known.clear();
    }
    const bool within = way.steps >= split_path(section.path).size();  // else no key of its own
    if (within && way.steps == farthest.steps && way.path == path_of_items(*way.node, way.path))
      for (const KeyNode& key : way.node->keys)
        if (std::ranges::find(known, key.name) == known.end()) known.push_back(key.name);
  }
  if (!out.empty()) return out;
  const std::string deeper = ends_of_paths(key_paths(), path);
  throw InputError("is not a key of a scene", std::string(path),
                   !deeper.empty() ? fmt::format("There is {}.", deeper)
                   : known.empty() ? "The key before it has none below."
                                   : suggestion(steps[farthest.steps], known, "There are:"));
}

}  // namespace abut
