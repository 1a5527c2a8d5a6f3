#include "subdomain_solver/fe/largest_rotation.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Dense>

namespace abut {

namespace {

// Bounded by the largest element: asked for at every record, they shall allocate nothing.
constexpr int most_nodes = 27;
using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_nodes, 3>;
using CellPlaces = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, most_nodes>;
using SpaceSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// Derivatives of an element's shape functions at the mean of its corners: (nodes, dim).
Slopes slopes_at_centre(const Element& element) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int corners = element.corner_count();
  const Eigen::Map<const Rows> places(element.corners.data(), corners, element.dim);
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> centre = places.colwise().mean();
  const std::size_t nodes = index(element.nodes);
  std::array<double, most_nodes> n;
  std::array<double, 3 * most_nodes> dn;
  element.evaluate({centre.data(), index(centre.size())}, std::span(n).first(nodes),
                   std::span(dn).first(nodes * index(element.dim)));
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
    const Slopes slopes = slopes_at_centre(*cells.element);
    for (int c = 0; c < cells.count(); ++c) {
      if (next-- > 0) continue;
      next = stride - 1;
      const Eigen::Map<const Eigen::VectorXi> own(cells.nodes.data() + c * nodes, nodes);
      const CellPlaces x = points(Eigen::all, own), v = moved(Eigen::all, own);
      const SpaceSquare jacobian = x * slopes, change = v * slopes, inverse = jacobian.inverse();
      const SpaceSquare gradient = change * inverse;
      // The axial vector has half the norm of gradient - gradient^T over sqrt(2).
      most = std::max(most, (gradient - gradient.transpose()).squaredNorm() / 8.0);
    }
  }
  return std::sqrt(most);
}

}  // namespace abut
