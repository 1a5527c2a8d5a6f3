#include "subdomain_solver/fe/largest_rotation.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

namespace abut {

namespace {

/// Derivatives of an element's shape functions at the mean of its corners: (nodes, dim).
Eigen::MatrixXd slopes_at_centre(const Element& element) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int corners = element.corner_count();
  const Eigen::Map<const Rows> places(element.corners.data(), corners, element.dim);
  const Eigen::VectorXd centre = places.colwise().mean();
  const std::size_t nodes = index(element.nodes);
  std::vector<double> n(nodes), dn(nodes * index(element.dim));
  element.evaluate({centre.data(), index(centre.size())}, n, dn);
  return Eigen::Map<const Rows>(dn.data(), element.nodes, element.dim);
}

}  // namespace

double largest_rotation(const Mesh& mesh, std::span<const double> u, int stride) {
  if (mesh.dim == 1) return 0.0;
  const int dim = mesh.dim;
  const Eigen::Map<const Eigen::MatrixXd> points(mesh.points.data(), dim, mesh.node_count());
  const Eigen::Map<const Eigen::MatrixXd> moved(u.data(), dim, mesh.node_count());
  double most = 0.0;
  int next = 0;  // cells to pass by
  for (const CellBlock& cells : mesh.blocks) {
    const int nodes = cells.element->nodes;
    const Eigen::MatrixXd slopes = slopes_at_centre(*cells.element);
    for (int c = 0; c < cells.count(); ++c) {
      if (next-- > 0) continue;
      next = stride - 1;
      const Eigen::Map<const Eigen::VectorXi> own(cells.nodes.data() + c * nodes, nodes);
      const Eigen::MatrixXd jacobian = points(Eigen::all, own) * slopes;
      const Eigen::MatrixXd gradient = moved(Eigen::all, own) * slopes * jacobian.inverse();
      // The axial vector has half the norm of gradient - gradient^T over sqrt(2).
      most = std::max(most, (gradient - gradient.transpose()).squaredNorm() / 8.0);
    }
  }
  return std::sqrt(most);
}

}  // namespace abut
