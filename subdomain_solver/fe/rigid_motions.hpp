#pragma once

#include <optional>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// Infinitesimal rigid motions of a mesh, which cost no energy at small strain: translations, and
/// rotations about the mean of the nodes, scaled to a largest component of 1; the axial one alone
/// of an axisymmetric body. (dofs, motions), in the nodes' own frames.
Eigen::MatrixXd rigid_motions(const FeModel& model);
/// The same of the mesh with its nodes at other points [m] (nodes, dim).
Eigen::MatrixXd rigid_motions(const FeModel& model, std::span<const double> at);

/// Combinations of motions (n, k) that vanish on some rows: (n, at most k). Sizes are relative to
/// the largest component of each motion.
Eigen::MatrixXd vanishing_on(const std::vector<int>& rows, const Eigen::MatrixXd& motions);

/// Nodes of each part of a mesh that shares no node with the others, sorted, in the order of their
/// first nodes.
std::vector<std::vector<std::int32_t>> connected_pieces(const Mesh& mesh);

/// A piece that may move as a whole although some coordinates are held.
struct LoosePiece {
  int piece = 0, pieces = 1;  // which of connected_pieces
  int motions = 0;            // rigid ones that nothing prevents
};
/// The first one; held: sorted coordinates.
std::optional<LoosePiece> find_loose_piece(const FeModel& model, const std::vector<int>& held);

/// Rigid motions that held coordinates (sorted) leave a mesh, 0 there: (dofs, k), columns of length
/// sqrt(others) at right angles.
Eigen::MatrixXd loose_motions(const FeModel& model, const std::vector<int>& held);

/// The same in small translations [m] and rotations [rad] about the origin per unit of each
/// motion: (k, dim + rotations), flat.
std::vector<double> translations_and_rotations(const FeModel& model,
                                               const Eigen::MatrixXd& motions);

/// Rows of motions (n, k), as many as their rank, that determine the others best; sorted.
std::vector<int> determining_rows(const Eigen::MatrixXd& motions, Eigen::Index rank);

}  // namespace abut
