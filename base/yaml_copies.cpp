#include "base/yaml_copies.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_copies_table.hpp"
#include "base/yaml_document.hpp"
#include "base/yaml_fields.hpp"
#include "base/yaml_moved.hpp"
#include "base/yaml_text.hpp"
#include "base/yaml_tree.hpp"

namespace abut {
namespace {

struct DimensionKey {
  int dimension = 0;
  void fields(Fields& f) {
    f.required("dimension", dimension, "", "space dimension of the body", between(1, 3));
    f.ignore_rest();
  }
};

/// Of a body's `initial`, to which copies add.
struct InitialPlace {
  std::vector<double> position, velocity;
  void fields(Fields& f) {
    f.optional("position", position, "m", "place of the body's own origin");
    f.optional("velocity", velocity, "m/s", "uniform velocity at the start");
    f.ignore_rest();
  }
};

constexpr std::size_t most_of_place = 9;  // values: keys and numbers of position and velocity

std::string path_of(std::string_view body) { return fmt::format("bodies.{}", body); }

/// Walls and pairs of bars tell no dimension and have one; 0: what tells it is missing, which the
/// body's reader says.
std::size_t dimension_of(const Document& document, const std::string& body) {
  const std::string model = body + ".model";
  for (const std::string& name : document.keys(model))
    if (document.has(join_path(join_path(model, name), "dimension")))
      return index(read<DimensionKey>(document, join_path(model, name)).dimension);
  return document.chooses(model, "rigid_wall") || document.chooses(model, "bar_pair") ? 1 : 0;
}

/// Lists of numbers of one body.
struct Lengths {
  const Document& document;
  std::size_t dim;

  void check(const std::vector<double>& values, const std::string& path) const {
    const bool absent = values.size() == 1 && values[0] == 0.0;  // as the body's reader has it
    if (dim == 0 || absent || values.size() == dim) return;
    throw InputError("has " + counted(values.size(), "number"), document.where(path),
                     dim == 1 ? "Give one number: the body has one dimension."
                              : fmt::format("Give {} numbers, one per dimension.", dim));
  }
};

std::size_t values_of(const YAML::Node& node) {
  std::size_t count = 1;
  for (const auto& item : node) count += values_of(node.IsMap() ? item.second : item);
  return count;
}

/// One of the three ways, and for bodies of ours.
void check_ways(const CopiesSpec& spec, const Document& document, const std::string& body) {
  const std::string at = body + ".copies";
  const int ways =
      (spec.grid ? 1 : 0) + (document.has(at + ".list") ? 1 : 0) + (spec.table ? 1 : 0);
  if (ways != 1)
    throw InputError(ways == 0 ? "places no copy" : "places copies in more than one way",
                     document.where(at), "Give one of grid, list and table.");
  if (!spec.grid && !spec.table && spec.list.empty())
    throw InputError("is empty", document.where(at + ".list"),
                     "Give one map per copy, for example {position: [0.1]}.");
  if (document.chooses(body + ".model", "external"))
    throw InputError("is for bodies of this program: another one reads the text as it stands",
                     document.where(at), "Write the external bodies out.");
}

std::vector<TableRow> rows_of(const TableCopies& table, std::size_t dim, const Document& document,
                              const std::string& key) {
  const std::string& scene = document.name();
  const std::string folder =
      table.file.starts_with('/') ? "" : scene.substr(0, scene.rfind('/') + 1);
  try {
    return read_copies_table(folder + table.file, dim, max_copies);
  } catch (const InputError& error) {
    throw InputError(error.what_is_wrong, fmt::format("{}: {}", document.where(key), error.where),
                     error.remedy);
  }
}

}  // namespace

Copies::Copies(const Document& document) {
  InputErrors errors;
  for (const std::string& name : document.keys("bodies"))
    if (document.has(path_of(name) + ".copies")) errors.gather([&] { read_body(document, name); });
  for (const auto& [body, copies] : bodies_) {
    for (std::size_t i = 0; i < copies.names.size(); ++i) {
      const std::string& name = copies.names[i];
      const bool fresh = copies_.emplace(name, std::pair(body, i)).second;
      if (fresh && !document.has(path_of(name))) continue;
      errors.add({fmt::format("makes a body {}, but there is another one of this name", name),
                  document.where(path_of(body) + ".copies"), "Rename one of the two."});
    }
  }
  errors.raise();
}

void Copies::read_body(const Document& document, const std::string& name) {
  const std::string path = path_of(name), at = path + ".copies";
  Body body;
  body.spec = read<CopiesSpec>(document, at);
  const CopiesSpec& spec = body.spec;
  check_ways(spec, document, path);
  const Lengths lengths{document, dimension_of(document, path)};
  if (document.has(path + ".initial.position") || document.has(path + ".initial.velocity")) {
    const InitialPlace initial = read<InitialPlace>(document, path + ".initial");
    if (!initial.position.empty()) lengths.check(initial.position, path + ".initial.position");
    if (!initial.velocity.empty()) lengths.check(initial.velocity, path + ".initial.velocity");
  }
  if (spec.grid) {
    lengths.check(spec.grid->count, at + ".grid.count");
    for (std::size_t i = 0; i < spec.grid->number(); ++i)
      body.places.push_back({spec.grid->offset(i), {}});
  }
  for (std::size_t i = 0; i < spec.list.size(); ++i) {
    const std::string item = fmt::format("{}.list[{}]", at, i);
    if (document.has(item + ".position")) lengths.check(spec.list[i].position, item + ".position");
    if (document.has(item + ".velocity")) lengths.check(spec.list[i].velocity, item + ".velocity");
    body.places.push_back({spec.list[i].position, spec.list[i].velocity});
  }
  if (spec.table)
    for (const TableRow& row : rows_of(*spec.table, lengths.dim, document, at + ".table.file"))
      body.places.push_back({row.position, row.velocity});
  const std::size_t digits = std::to_string(body.places.size()).size();
  for (std::size_t i = 0; i < body.places.size(); ++i)
    body.names.push_back(fmt::format("{}_{:0{}}", name, i + 1, digits));
  bodies_.emplace(name, std::move(body));
}

YAML::Node Copies::written_out(const Document& document) const {
  YAML::Node out(YAML::NodeType::Map), bodies(YAML::NodeType::Map);
  std::size_t values = 0;
  for (const auto& pair : document.root()["bodies"]) {
    const auto found = bodies_.find(pair.first.Scalar());
    if (found == bodies_.end()) {
      bodies.force_insert(pair.first, pair.second);
      continue;
    }
    const Body& body = found->second;
    const std::string at = path_of(found->first) + ".copies";
    const YAML::Node places = child(pair.second, "copies")->node;
    values += body.places.size() * (values_of(pair.second) - values_of(places) + most_of_place);
    if (values > max_values)
      throw InputError("makes too many values, written out", document.where(at),
                       "Give fewer copies.");
    const std::optional<Found> list = child(places, "list");
    for (std::size_t i = 0; i < body.places.size(); ++i) {
      YAML::Node own(YAML::NodeType::Map);
      if (list) {
        own.reset(list->node[i]);
      } else {
        const Place& place = body.places[i];
        if (!place.position.empty()) own["position"] = numbers_of(place.position);
        if (!place.velocity.empty()) own["velocity"] = numbers_of(place.velocity);
      }
      bodies.force_insert(body.names[i], moved_copy(pair.second, own, document.units()));
    }
  }
  for (const auto& pair : document.root())
    out.force_insert(pair.first, pair.first.Scalar() == "bodies" ? bodies : pair.second);
  return out;
}

std::vector<std::string> Copies::tables_as_lists() const {
  std::vector<std::string> overrides;
  for (const auto& [name, body] : bodies_) {
    if (!body.spec.table) continue;
    std::vector<std::string> items;
    for (const Place& place : body.places) {
      std::vector<std::string> keys;
      if (!place.position.empty())
        keys.push_back(fmt::format("position: [{}]", fmt::join(place.position, ", ")));
      if (!place.velocity.empty())
        keys.push_back(fmt::format("velocity: [{}]", fmt::join(place.velocity, ", ")));
      items.push_back(fmt::format("{{{}}}", fmt::join(keys, ", ")));
    }
    overrides.push_back(
        fmt::format("{}.copies={{list: [{}]}}", path_of(name), fmt::join(items, ", ")));
  }
  return overrides;
}

std::string Copies::body_of(std::string_view copy) const {
  const auto found = copies_.find(copy);
  return found == copies_.end() ? "" : found->second.first;
}

std::string Copies::names_of(std::string_view body) const {
  const auto found = bodies_.find(body);
  if (found == bodies_.end()) return "";
  const std::vector<std::string>& names = found->second.names;
  return names.size() == 1 ? names[0] : fmt::format("{} to {}", names.front(), names.back());
}

std::string Copies::origin_of(std::string_view path,
                              const std::function<bool(const std::string&)>& has) const {
  const std::vector<std::string> steps = split_path(path);
  const auto found =
      steps.size() < 2 || steps[0] != "bodies" ? copies_.end() : copies_.find(steps[1]);
  if (found == copies_.end()) return std::string(path);
  const auto& [body, i] = found->second;
  const CopiesSpec& spec = bodies_.find(body)->second.spec;
  const std::string at = path_of(body);
  const auto with_rest = [&steps](std::string there, std::size_t first) {
    for (std::size_t s = first; s < steps.size(); ++s) there = join_path(there, steps[s]);
    return there;
  };
  if (steps.size() > 3 && steps[2] == "initial") {
    const std::string listed = fmt::format("{}.copies.list[{}]", at, i);
    if (has(join_path(listed, steps[3]))) return with_rest(listed, 3);
    if (spec.grid && steps[3] == "position") return at + ".copies.grid";
    if (spec.table && (steps[3] == "position" || steps[3] == "velocity"))
      return at + ".copies.table";
  }
  return with_rest(at, 2);
}

std::string possible_body_of(const YAML::Node& scene, std::string_view name) {
  const std::size_t mark = std::min(name.rfind('_'), name.size());
  const std::string_view number = name.substr(std::min(mark + 1, name.size()));
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  if (number.empty() || !std::all_of(number.begin(), number.end(), is_digit)) return "";
  const std::optional<Found> bodies = child(scene, "bodies");
  const std::optional<Found> body =
      bodies ? child(bodies->node, name.substr(0, mark)) : std::optional<Found>();
  return body && child(body->node, "copies") ? std::string(name.substr(0, mark)) : "";
}

}  // namespace abut
