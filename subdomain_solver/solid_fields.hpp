#pragma once

#include <span>
#include <vector>

#include "contract/field.hpp"
#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// The mesh as VTK's cells, in space.
Grid grid_of(const Mesh& mesh);

/// Values (n, dim) in three dimensions (n, 3), with zeros for the axes that there are not.
std::vector<double> in_space(std::span<const double> values, int dim);

/// What a solid tells all over itself: displacement [m] and velocity [m/s] of the nodes; of the
/// cells, where the body deforms, Cauchy stress and von Mises stress [Pa] and the internal
/// variables that the law names: means over the points of the cell, weighted by reference volume;
/// at last the stresses carried to the nodes.
std::vector<FieldInfo> solid_fields(const Material& material, bool deforms);

/// What they are taken of.
struct SolidFieldState {
  std::span<const double> q;             // [m] coordinates of the mesh's model
  std::span<const double> displacement;  // [m] (nodes, dim) along the axes of space
  std::span<const double> velocity;      // [m/s] alike
  std::span<const double> history;
};

/// Their values, in that order. Those of the cells are not numbers where the state is inadmissible.
std::vector<FieldValues> solid_field_values(FeModel& model, const SolidFieldState& state,
                                            bool deforms);

}  // namespace abut
