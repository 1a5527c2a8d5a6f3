#pragma once

#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// Infinitesimal rigid motions of a mesh, which cost no energy at small strain: translations, and
/// rotations about the mean of the nodes, scaled to a largest component of 1; the axial one alone
/// of an axisymmetric body. (dofs, motions), in the nodes' own frames.
Eigen::MatrixXd rigid_motions(const FeModel& model);

/// Combinations of motions (n, k) that vanish on some rows: (n, at most k). Sizes are relative to
/// the largest component of each motion.
Eigen::MatrixXd vanishing_on(const std::vector<int>& rows, const Eigen::MatrixXd& motions);

}  // namespace abut
