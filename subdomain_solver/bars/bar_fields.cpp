#include "subdomain_solver/bars/bar_fields.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace abut {

namespace {

constexpr std::int32_t vtk_line = 3;

/// Values as the first of several components, the others zero.
FieldValues first_of(std::span<const double> values, std::size_t components) {
  FieldValues out(values.size() * components, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) out[i * components] = values[i];
  return out;
}

}  // namespace

void add_bar(const BarProperties& bar, Grid& grid) {
  const std::int32_t first = static_cast<std::int32_t>(grid.nodes());
  if (grid.offsets.empty()) grid.offsets.push_back(0);
  for (int i = 0; i <= bar.elements; ++i) {
    const double along = bar.length * i / bar.elements;
    grid.points.insert(grid.points.end(), {bar.position + along, 0.0, 0.0});
  }
  for (int e = 0; e < bar.elements; ++e) {
    grid.connectivity.insert(grid.connectivity.end(), {first + e, first + e + 1});
    grid.offsets.push_back(static_cast<std::int32_t>(grid.connectivity.size()));
    grid.types.push_back(vtk_line);
  }
}

std::vector<FieldInfo> bar_fields() {
  return {{"displacement", FieldPlace::nodes, 3},
          {"velocity", FieldPlace::nodes, 3},
          {"stress", FieldPlace::cells, 6},
          {"von_mises", FieldPlace::cells, 1}};
}

std::vector<FieldValues> bar_field_values(std::span<const double> u, std::span<const double> v,
                                          std::span<const double> stress) {
  FieldValues von_mises;
  for (const double value : stress) von_mises.push_back(std::abs(value));
  return {first_of(u, 3), first_of(v, 3), first_of(stress, 6), std::move(von_mises)};
}

}  // namespace abut
