#include "subdomain_solver/fe/hourglass.hpp"

#include "base/assert.hpp"
#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

bool has_hourglasses(const Element& element) {
  return element.order == 1 &&
         (element.shape == Shape::hexahedron || element.shape == Shape::quadrilateral);
}

Eigen::MatrixXd hourglass_stiffness(const Element& element, const Eigen::MatrixXd& x,
                                    const Eigen::MatrixXd& b, double volume, double stiffness) {
  ABUT_ASSERT(has_hourglasses(element));
  const int dim = element.dim, n = element.nodes;
  // Products of the corners' coordinates: yz, zx, xy, xyz of a cube, xy of a square.
  Eigen::MatrixXd gamma(n, dim == 3 ? 4 : 1);
  for (int a = 0; a < n; ++a) {
    const double* c = element.corners.data() + a * dim;
    if (dim == 3)
      gamma.row(a) << c[1] * c[2], c[2] * c[0], c[0] * c[1], c[0] * c[1] * c[2];
    else
      gamma(a, 0) = c[0] * c[1];
  }
  gamma -= b * (x.transpose() * gamma);  // no part of a linear field
  const double k = stiffness / (n * dim) * volume * b.squaredNorm();
  return k * gamma * gamma.transpose();
}

double hourglass_energy(const FeModel& model, std::span<const double> u) {
  if (model.options().formulation != Formulation::one_point) return 0.0;
  const Mesh& mesh = model.mesh();
  const Eigen::Map<const Eigen::MatrixXd> moved(u.data(), mesh.dim, mesh.node_count());
  double energy = 0.0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const CellBlock& cells = mesh.blocks[b];
    if (!has_hourglasses(*cells.element)) continue;
    const int n = cells.element->nodes;
    for (int c = 0; c < cells.count(); ++c) {
      const CellMeasures measures = model.cell_measures(static_cast<int>(b), c);
      const Eigen::Map<const Eigen::VectorXi> own(cells.nodes.data() + c * n, n);
      const Eigen::MatrixXd local = moved(Eigen::all, own);  // (dim, nodes)
      for (int i = 0; i < mesh.dim; ++i) {
        const double* first = measures.hourglass.data() + (measures.hoop.empty() ? 0 : i * n * n);
        const Eigen::Map<const Eigen::MatrixXd> k(first, n, n);
        energy += 0.5 * (local.row(i) * k).dot(local.row(i));
      }
    }
  }
  return energy;
}

}  // namespace abut
