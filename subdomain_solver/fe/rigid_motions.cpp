#include "subdomain_solver/fe/rigid_motions.hpp"

#include <cmath>

#include <Eigen/SVD>

namespace abut {

namespace {

/// Part of a motion's size below which a component of it is round-off.
constexpr double nothing = 1.0e-10;

}  // namespace

Eigen::MatrixXd rigid_motions(const FeModel& model) {
  const Mesh& mesh = model.mesh();
  const int dim = mesh.dim, nodes = mesh.node_count();
  const int first = model.round() ? 1 : 0;  // an axisymmetric body cannot move along its radius
  const int translations = dim - first;
  const int rotations = model.round() ? 0 : dim * (dim - 1) / 2;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(model.dofs(), translations + rotations);
  const Eigen::Map<const Eigen::MatrixXd> points(mesh.points.data(), dim, nodes);
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
    model.to_frames({out.col(k).data(), static_cast<std::size_t>(out.rows())});
  return out;
}

Eigen::MatrixXd vanishing_on(const std::vector<int>& rows, const Eigen::MatrixXd& motions) {
  const Eigen::Index count = motions.cols();
  if (rows.empty() || count == 0) return motions;
  const Vector sizes = motions.cwiseAbs().colwise().maxCoeff();
  const Eigen::MatrixXd scaled = motions * sizes.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd there = scaled(rows, Eigen::all);
  const Eigen::JacobiSVD<Eigen::MatrixXd> parts(there, Eigen::ComputeFullV);
  const double largest = std::sqrt(static_cast<double>(rows.size()));
  Eigen::Index rank = 0;
  while (rank < parts.singularValues().size() && parts.singularValues()(rank) > nothing * largest)
    ++rank;
  Eigen::MatrixXd out = scaled * parts.matrixV().rightCols(count - rank);
  for (int row : rows) out.row(row).setZero();
  return out;
}

}  // namespace abut
