#include "subdomain_solver/fe/cell_measures.hpp"

#include <numbers>

#include <Eigen/LU>

#include "subdomain_solver/fe/hourglass.hpp"

namespace abut {

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// The points of the last cell become one, with their mean gradient.
void average(const CellBlock& cells, const Eigen::MatrixXd& x, double stiffness, int points,
             CellMeasures& out) {
  const std::size_t n = index(points), size = index(out.nodes * out.dim);
  double* volume = out.volume.data() + out.volume.size() - n;
  double* gradient = out.gradient.data() + out.gradient.size() - n * size;
  double total = 0.0;
  Rows mean = Rows::Zero(out.nodes, out.dim);
  for (std::size_t p = 0; p < n; ++p) {
    total += volume[p];
    mean += volume[p] * Eigen::Map<const Rows>(gradient + p * size, out.nodes, out.dim);
  }
  mean /= total;
  volume[0] = total;
  Eigen::Map<Rows>(gradient, out.nodes, out.dim) = mean;
  if (!out.hoop.empty()) {  // N/R, averaged over the volume too
    double* hoop = out.hoop.data() + out.hoop.size() - n * index(out.nodes);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(out.nodes);
    for (std::size_t p = 0; p < n; ++p)
      sum += volume[p] * Eigen::Map<const Eigen::VectorXd>(hoop + p * index(out.nodes), out.nodes);
    Eigen::Map<Eigen::VectorXd>(hoop, out.nodes) = sum / total;
    out.hoop.resize(out.hoop.size() - (n - 1) * index(out.nodes));
  }
  out.volume.resize(out.volume.size() - (n - 1));
  out.gradient.resize(out.gradient.size() - (n - 1) * size);
  const Rows k = hourglass_stiffness(*cells.element, x, mean, total, stiffness);
  out.hourglass.insert(out.hourglass.end(), k.data(), k.data() + k.size());
}

}  // namespace

double FeOptions::depth(int dim, double radius) const {
  if (dim == 3) return 1.0;
  if (dim == 1) return area;
  return plane == Plane::axisymmetric ? 2.0 * std::numbers::pi * radius : thickness;
}

int law_points(const Element& element, const Tabulation& table, Formulation formulation) {
  const bool one = formulation == Formulation::one_point && has_hourglasses(element);
  return one ? 1 : table.points;
}

CellGeometry CellMeasures::of(int cell) const {
  const std::size_t p = index(points), n = index(nodes), d = index(dim), c = index(cell);
  CellGeometry g{nodes, points, dim, {}, {}, {}, {}};
  g.volume = std::span(volume).subspan(c * p, p);
  g.gradient = std::span(gradient).subspan(c * p * n * d, p * n * d);
  if (!hoop.empty()) g.hoop = std::span(hoop).subspan(c * p * n, p * n);
  if (!hourglass.empty()) g.hourglass = std::span(hourglass).subspan(c * n * n, n * n);
  return g;
}

void measure_cell(const Mesh& mesh, const CellBlock& cells, int cell, const Tabulation& t,
                  const FeOptions& options, double p_wave, CellMeasures& out) {
  const int dim = mesh.dim;
  const bool round = options.plane == Plane::axisymmetric && dim == 2;
  out.nodes = t.nodes;
  out.dim = dim;
  out.points = law_points(*cells.element, t, options.formulation);
  Eigen::MatrixXd x(t.nodes, dim);
  for (int a = 0; a < t.nodes; ++a) {
    const std::int32_t node = cells.nodes[index(cell) * index(t.nodes) + index(a)];
    for (int i = 0; i < dim; ++i) x(a, i) = mesh.points[index(node) * index(dim) + index(i)];
  }
  for (int p = 0; p < t.points; ++p) {
    const Eigen::Map<const Rows> dn(t.dn.data() + index(p * t.nodes * dim), t.nodes, dim);
    const Eigen::Map<const Eigen::VectorXd> n(t.n.data() + index(p * t.nodes), t.nodes);
    const Eigen::MatrixXd jacobian = x.transpose() * dn;  // dX/dxi
    const double radius = round ? n.dot(x.col(0)) : 0.0;
    out.volume.push_back(t.weight[index(p)] * jacobian.determinant() * options.depth(dim, radius));
    const Rows gradient = dn * jacobian.inverse();
    out.gradient.insert(out.gradient.end(), gradient.data(), gradient.data() + gradient.size());
    if (!round) continue;
    for (int a = 0; a < t.nodes; ++a) out.hoop.push_back(n(a) / radius);
  }
  if (options.formulation == Formulation::one_point && has_hourglasses(*cells.element))
    average(cells, x, options.hourglass * p_wave, t.points, out);
}

}  // namespace abut
