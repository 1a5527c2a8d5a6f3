#pragma once

#include <span>
#include <vector>

#include "contract/field.hpp"
#include "subdomain_solver/bars/bar.hpp"

namespace abut {

/// Adds the nodes of a bar and a line cell for every element.
void add_bar(const BarProperties& bar, Grid& grid);

/// What bodies of bars tell all over themselves: displacement [m] and velocity [m/s] of the nodes,
/// and of the elements the axial stress [Pa] as a tensor and as von Mises stress, under the names
/// and with the components that solids give them.
std::vector<FieldInfo> bar_fields();

/// Their values in that order, from displacement and velocity by node and axial stress by element.
std::vector<FieldValues> bar_field_values(std::span<const double> u, std::span<const double> v,
                                          std::span<const double> stress);

}  // namespace abut
