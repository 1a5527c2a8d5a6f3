#include "contract/field.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/index.hpp"

namespace abut {

namespace {

constexpr int most_components = 9;

std::size_t first_not_finite(std::span<const double> values) {
  const auto at = std::find_if(values.begin(), values.end(),
                               [](double value) { return !std::isfinite(value); });
  return index(at - values.begin());
}

}  // namespace

std::string unsound(std::span<const FieldInfo> fields) {
  std::set<std::string> names;
  for (const FieldInfo& field : fields) {
    if (field.name.empty()) return "a field has no name";
    if (!names.insert(field.name).second) return "two fields have the name " + field.name;
    if (field.components < 1 || field.components > most_components)
      return "field " + field.name + " has " + std::to_string(field.components) + " components";
  }
  return "";
}

std::string unsound(const Grid& grid) {
  if (grid.points.size() % 3 != 0) return "the grid has no whole number of points";
  const std::size_t bad = first_not_finite(grid.points);
  if (bad < grid.points.size())
    return "point " + std::to_string(bad / 3) + " of the grid is not finite";
  if (grid.offsets.size() != grid.cells() + 1 || grid.offsets.front() != 0)
    return "the grid has " + std::to_string(grid.offsets.size()) + " offsets for " +
           std::to_string(grid.cells()) + " cells, or they do not begin with 0";
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    if (grid.offsets[c + 1] <= grid.offsets[c])
      return "cell " + std::to_string(c) + " of the grid has no node";
    if (grid.types[c] < 1 || grid.types[c] > 255)
      return "cell " + std::to_string(c) + " of the grid has no type of VTK's";
  }
  if (index(grid.offsets.back()) != grid.connectivity.size())
    return "the last offset of the grid is not the number of its cells' nodes";
  const auto stray = [&grid](std::int32_t node) {
    return node < 0 || index(node) >= grid.nodes();
  };
  if (std::any_of(grid.connectivity.begin(), grid.connectivity.end(), stray))
    return "a cell of the grid has a node that is not there";
  return "";
}

std::string unsound(std::span<const FieldValues> values, std::span<const FieldInfo> fields,
                    std::size_t nodes, std::size_t cells) {
  if (values.size() != fields.size())
    return std::to_string(values.size()) + " fields came where the description lists " +
           std::to_string(fields.size());
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const std::size_t wanted = (fields[k].place == FieldPlace::nodes ? nodes : cells) *
                               index(fields[k].components);
    if (values[k].size() != wanted)
      return "field " + fields[k].name + " has " + std::to_string(values[k].size()) +
             " numbers where " + std::to_string(wanted) + " belong";
  }
  return "";
}

std::string not_finite(std::span<const FieldValues> values, std::span<const FieldInfo> fields) {
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const std::size_t bad = first_not_finite(values[k]);
    if (bad == values[k].size()) continue;
    const bool nodal = fields[k].place == FieldPlace::nodes;
    return "field " + fields[k].name + " is not finite at " + (nodal ? "node " : "cell ") +
           std::to_string(bad / index(fields[k].components));
  }
  return "";
}

}  // namespace abut
