#pragma once

#include <array>
#include <span>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// Stress as the numbers that tables and files tell: xx yy zz xy yz zx [Pa].
using StressEntries = std::array<double, 6>;
StressEntries entries_of(const Matrix3& stress);
Matrix3 stress_of(const StressEntries& entries);

/// Stress at the nodes of a body.
struct NodalStress {
  std::vector<StressEntries> nodes;  // [Pa] (nodes) mean of what the node's cells say
  double most_of_cells = 0.0;        // [Pa] largest von Mises stress that one cell says of a node
};

/// Cauchy stress at the nodes [M.73]: in every cell the polynomial of first order along each
/// direction of the reference cell that is nearest to the stresses at its quadrature points, or
/// their mean where there are too few of them; at a node the mean over its cells, each of which
/// counts once. Fields that such polynomials hold are exact. Not numbers where q is inadmissible.
/// q: coordinates of the mesh's model [m], with the history at them.
NodalStress nodal_stress(FeModel& model, std::span<const double> q,
                         std::span<const double> history);

/// What it takes of one element: values at its nodes from those at its points, (nodes, points).
/// `points` is the number at which the law is evaluated, less than the rule's under one_point.
Eigen::MatrixXd extrapolation(const Element& element, const Tabulation& rule, int points);

}  // namespace abut
