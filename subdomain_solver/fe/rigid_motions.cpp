#include "subdomain_solver/fe/rigid_motions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/dense.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Part of a motion's size below which a component of it is round-off.
constexpr double nothing = 1.0e-10;

/// Of motions whose values at so many coordinates have these singular values.
Eigen::Index rank_of(const Vector& values, Eigen::Index coordinates) {
  const double largest = std::sqrt(static_cast<double>(coordinates));
  Eigen::Index rank = 0;
  while (rank < values.size() && values(rank) > nothing * largest) ++rank;
  return rank;
}

/// Root of the tree that a node hangs in; shortens the way to it.
std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t node) {
  while (parent[node] != node) {
    parent[node] = parent[parent[index(node)]];
    node = parent[node];
  }
  return node;
}

}  // namespace

Eigen::MatrixXd rigid_motions(const FeModel& model) {
  return rigid_motions(model, model.mesh().points);
}

Eigen::MatrixXd rigid_motions(const FeModel& model, std::span<const double> at) {
  const Mesh& mesh = model.mesh();
  const int dim = mesh.dim, nodes = mesh.node_count();
  const int first = model.round() ? 1 : 0;  // an axisymmetric body cannot move along its radius
  const int translations = dim - first;
  const int rotations = model.round() ? 0 : dim * (dim - 1) / 2;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(model.dofs(), translations + rotations);
  const Eigen::Map<const Eigen::MatrixXd> points(at.data(), dim, nodes);
  const Eigen::MatrixXd arms = points.colwise() - points.rowwise().mean().eval();
  const double size = arms.cwiseAbs().maxCoeff();
  for (int node = 0; node < nodes; ++node) {
    for (int i = first; i < dim; ++i) out(node * dim + i, i - first) = 1.0;
    int column = translations;
    for (int i = 0; i < dim && rotations > 0; ++i) {
      for (int j = i + 1; j < dim; ++j, ++column) {
        out(node * dim + i, column) = -arms(j, node) / size;
        out(node * dim + j, column) = arms(i, node) / size;
      }
    }
  }
  for (Eigen::Index k = 0; k < out.cols(); ++k)
    model.to_frames({out.col(k).data(), index(out.rows())});
  return out;
}

Eigen::MatrixXd vanishing_on(const std::vector<int>& rows, const Eigen::MatrixXd& motions) {
  const Eigen::Index count = motions.cols();
  if (rows.empty() || count == 0) return motions;
  const Vector sizes = motions.cwiseAbs().colwise().maxCoeff();
  const Eigen::MatrixXd scaled = motions * sizes.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd there = scaled(rows, Eigen::all);
  const SingularValues parts = singular_values(there, SingularVectors::right);
  Eigen::MatrixXd out = scaled * parts.v.rightCols(count - rank_of(parts.values, there.rows()));
  for (int row : rows) out.row(row).setZero();
  return out;
}

std::vector<std::vector<std::int32_t>> connected_pieces(const Mesh& mesh) {
  std::vector<std::int32_t> parent(index(mesh.node_count()));
  std::iota(parent.begin(), parent.end(), 0);
  for (const CellBlock& cells : mesh.blocks) {
    const std::size_t each = index(cells.element->nodes);
    for (std::size_t k = 0; k < cells.nodes.size(); ++k) {
      const std::int32_t a = root_of(parent, cells.nodes[k - k % each]);
      const std::int32_t b = root_of(parent, cells.nodes[k]);
      parent[std::max(a, b)] = std::min(a, b);  // roots are the first of their nodes
    }
  }
  std::vector<std::vector<std::int32_t>> pieces;
  std::vector<std::size_t> place(parent.size());
  for (std::int32_t node = 0; node < mesh.node_count(); ++node) {
    const std::int32_t root = root_of(parent, node);
    if (root == node) {
      place[node] = pieces.size();
      pieces.emplace_back();
    }
    pieces[place[root]].push_back(node);
  }
  return pieces;
}

std::optional<LoosePiece> find_loose_piece(const FeModel& model, const std::vector<int>& held) {
  const Eigen::MatrixXd motions = rigid_motions(model);
  const std::vector<std::vector<std::int32_t>> pieces = connected_pieces(model.mesh());
  const int dim = model.mesh().dim, count = static_cast<int>(motions.cols());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    std::vector<int> rows;
    for (std::int32_t node : pieces[k]) {
      for (int i = node * dim; i < (node + 1) * dim; ++i)
        if (std::binary_search(held.begin(), held.end(), i)) rows.push_back(i);
    }
    int rank = 0;
    if (!rows.empty() && count > 0) {
      const Eigen::MatrixXd there = motions(rows, Eigen::all);
      const Vector values = singular_values(there, SingularVectors::none).values;
      rank = static_cast<int>(rank_of(values, there.rows()));
    }
    if (rank < count)
      return LoosePiece{static_cast<int>(k), static_cast<int>(pieces.size()), count - rank};
  }
  return std::nullopt;
}

Eigen::MatrixXd loose_motions(const FeModel& model, const std::vector<int>& held) {
  const Eigen::MatrixXd left = vanishing_on(held, rigid_motions(model));
  const double others = static_cast<double>(left.rows()) - static_cast<double>(held.size());
  Eigen::MatrixXd out = orthogonal_columns(left);
  for (const int row : held) out.row(row).setZero();  // to the last bit
  return std::sqrt(others) * out;
}

std::vector<double> translations_and_rotations(const FeModel& model,
                                               const Eigen::MatrixXd& motions) {
  const Mesh& mesh = model.mesh();
  const int dim = mesh.dim, rotations = dim * (dim - 1) / 2;
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(model.dofs(), dim + rotations);
  for (int node = 0; node < mesh.node_count(); ++node) {
    const double* x = &mesh.points[node * dim];
    for (int i = 0; i < dim; ++i) units(node * dim + i, i) = 1.0;
    if (dim == 2) units.block(node * 2, 2, 2, 1) << -x[1], x[0];
    if (dim == 3)
      units.block(node * 3, 3, 3, 3) << 0.0, x[2], -x[1], -x[2], 0.0, x[0], x[1], -x[0], 0.0;
  }
  for (Eigen::Index k = 0; k < units.cols(); ++k)
    model.to_frames({units.col(k).data(), index(units.rows())});
  const Eigen::MatrixXd found = least_squares(units, motions);  // (dim + r, k)
  return {found.data(), found.data() + found.size()};
}

std::vector<int> determining_rows(const Eigen::MatrixXd& motions, Eigen::Index rank) {
  if (rank == 0) return {};
  const Eigen::VectorXi order = pivot_order(motions.transpose());
  std::vector<int> out(order.data(), order.data() + rank);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace abut
