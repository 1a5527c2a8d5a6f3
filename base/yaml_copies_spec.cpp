#include "base/yaml_copies_spec.hpp"
#include "base/counted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace abut {

std::size_t GridCopies::number() const {
  double total = 1.0;
  for (const double axis : count) total *= axis;
  return static_cast<std::size_t>(std::min(total, 1.0e9));
}

std::vector<double> GridCopies::offset(std::size_t i) const {
  std::vector<double> place;
  for (std::size_t axis = 0; axis < count.size(); ++axis) {
    const std::size_t along = static_cast<std::size_t>(count[axis]);
    place.push_back(static_cast<double>(i % along) * spacing[axis] + 0.0);  // no -0
    i /= along;
  }
  return place;
}

void GridCopies::fields(Fields& f) {
  f.required("count", count, "", "number of copies along each axis, the first runs fastest",
             at_least(1));
  f.required("spacing", spacing, "m", "distance from one copy to the next along each axis");
  const auto is_whole = [](double number) { return number == std::floor(number); };
  f.check(!count.empty(), "count", "is empty", "Give one number per dimension.");
  f.check(std::all_of(count.begin(), count.end(), is_whole), "count", "is not of whole numbers",
          "Give the number of copies along each axis.");
  f.check(count.size() == spacing.size(), "spacing",
          fmt::format("has {}, but count has {}", counted(spacing.size(), "number"), count.size()),
          "Give both one number per dimension.");
  for (std::size_t axis = 0; axis < std::min(count.size(), spacing.size()); ++axis)
    f.check(count[axis] == 1.0 || spacing[axis] != 0.0, "spacing",
            fmt::format("is 0 along an axis with {:g} copies", count[axis]),
            "Give the distance from one copy to the next.");
  f.check(number() <= max_copies, "count", fmt::format("is of more than {} copies", max_copies),
          "Give fewer copies.");
}

void ListedCopy::fields(Fields& f) {
  f.optional("position", position, "m", "way of the copy from the body's place");
  f.optional("velocity", velocity, "m/s", "velocity that the copy has beside that of the body");
  f.ignore_rest();
}

void TableCopies::fields(Fields& f) {
  f.required("file", file, "",
             "table, relative to the scene file: a line of columns, some of x, y, z, vx, vy, vz, "
             "and a line per copy, with commas");
}

void CopiesSpec::fields(Fields& f) {
  f.optional_section("grid", grid, "copies in rows, the first where the body is");
  f.list("list", list,
         "copies one by one, each a map of keys of initial: position and velocity are added to "
         "those of the body, anything else is in the place of the body's own");
  f.optional_section("table", table, "positions and velocities, added to those of the body");
  f.check(list.size() <= max_copies, "list", fmt::format("is of more than {} copies", max_copies),
          "Give fewer copies.");
}

}  // namespace abut
