#include "subdomain_solver/fe/cell_measures.hpp"

#include <cmath>
#include <numbers>

#include "base/assert.hpp"
#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/hourglass.hpp"

namespace abut {

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The points of the last cell become one, with their mean gradient. A ring that turns in its
/// section has a mean hoop strain of none and no hourglass: Young's modulus holds what the hoop
/// strain is beside its mean, as uniaxial stress does, by a stiffness of radial displacements.
void average(const CellBlock& cells, const Eigen::MatrixXd& x, double stiffness, double young,
             int points, CellMeasures& out) {
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
  Eigen::MatrixXd beside;
  if (!out.hoop.empty()) {  // N/R, averaged over the volume too
    double* hoop = out.hoop.data() + out.hoop.size() - n * index(out.nodes);
    Eigen::Map<Eigen::MatrixXd> at_points(hoop, out.nodes, points);
    const Eigen::Map<const Eigen::VectorXd> share(volume, points);
    const Eigen::VectorXd average = at_points * share / total;
    at_points.colwise() -= average;
    beside = young * at_points * share.asDiagonal() * at_points.transpose();
    at_points.col(0) = average;
    out.hoop.resize(out.hoop.size() - (n - 1) * index(out.nodes));
  }
  volume[0] = total;  // the points' own volumes have weighted all means
  Eigen::Map<Rows>(gradient, out.nodes, out.dim) = mean;
  out.volume.resize(out.volume.size() - (n - 1));
  out.gradient.resize(out.gradient.size() - (n - 1) * size);
  const Eigen::MatrixXd k = hourglass_stiffness(*cells.element, x, mean, total, stiffness);
  if (beside.size() > 0) {
    beside += k;
    out.hourglass.insert(out.hourglass.end(), beside.data(), beside.data() + beside.size());
  }
  out.hourglass.insert(out.hourglass.end(), k.data(), k.data() + k.size());
}

/// Orthonormal fields over the last cell in which its volume change is told: 1, and of quadratic
/// cells the coordinates of space too [M.44].
void add_dilatation(const Eigen::MatrixXd& x, const Tabulation& t, int fields, CellMeasures& out) {
  const Eigen::Map<const Eigen::VectorXd> volume(
      out.volume.data() + out.volume.size() - index(t.points), t.points);
  const Eigen::VectorXd share = volume / volume.sum();
  const Eigen::Map<const Rows> n(t.n.data(), t.points, t.nodes);
  const Eigen::MatrixXd place = n * x;
  Eigen::MatrixXd made = Eigen::MatrixXd::Ones(t.points, fields);
  for (int k = 1; k < fields; ++k) {
    Eigen::VectorXd field = place.col(k - 1);
    for (int pass = 0; pass < 2; ++pass) {  // the second removes what rounding left to the first
      for (int l = 0; l < k; ++l) field -= made.col(l).cwiseProduct(share).dot(field) * made.col(l);
    }
    made.col(k) = field / std::sqrt(field.cwiseProduct(share).dot(field));
  }
  out.fields = fields;
  out.dilatation.insert(out.dilatation.end(), made.data(), made.data() + made.size());
}

/// What of its volume every point of a cell has, so that integrals of shape functions are those
/// over the cell's own part [M.114].
Eigen::VectorXd shares_at_points(const CellBlock& cells, int cell, const Tabulation& t) {
  if (!is_shared(cells, cell)) return Eigen::VectorXd::Ones(t.points);
  const Eigen::Map<const Eigen::VectorXd> share(cells.shares.data() + index(cell) * index(t.nodes),
                                                t.nodes);
  if ((share.array() == share(0)).all()) return Eigen::VectorXd::Constant(t.points, share(0));
  const Eigen::Map<const Rows> n(t.n.data(), t.points, t.nodes);
  const Eigen::Map<const Eigen::VectorXd> weight(t.weight.data(), t.points);
  const Eigen::VectorXd whole = n.transpose() * weight;
  if (t.points == 1) return Eigen::VectorXd::Constant(1, share.dot(whole) / whole.sum());
  ABUT_ASSERT(t.points == t.nodes);
  const Eigen::MatrixXd sums = n.transpose() * weight.asDiagonal();
  return solve_square(sums, Eigen::VectorXd(share.cwiseProduct(whole)));
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
  CellGeometry g{nodes, points, dim, {}, {}, {}, {}, {}};
  g.volume = std::span(volume).subspan(c * p, p);
  g.gradient = std::span(gradient).subspan(c * p * n * d, p * n * d);
  if (!hoop.empty()) g.hoop = std::span(hoop).subspan(c * p * n, p * n);
  const std::size_t stiffnesses = (hoop.empty() ? 1 : d) * n * n;
  if (!hourglass.empty()) g.hourglass = std::span(hourglass).subspan(c * stiffnesses, stiffnesses);
  const std::size_t f = index(fields) * p;
  if (!dilatation.empty()) g.dilatation = std::span(dilatation).subspan(c * f, f);
  return g;
}

void measure_cell(const Mesh& mesh, const CellBlock& cells, int cell, const Tabulation& t,
                  const FeOptions& options, const Moduli& moduli, CellMeasures& out) {
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
  const Eigen::VectorXd share = shares_at_points(cells, cell, t);
  for (int p = 0; p < t.points; ++p) {
    const Eigen::Map<const Rows> dn(t.dn.data() + index(p * t.nodes * dim), t.nodes, dim);
    const Eigen::Map<const Eigen::VectorXd> n(t.n.data() + index(p * t.nodes), t.nodes);
    const Eigen::MatrixXd jacobian = x.transpose() * dn;  // dX/dxi
    const double radius = round ? n.dot(x.col(0)) : 0.0;
    out.volume.push_back(share(p) * t.weight[p] * determinant_of(jacobian) *
                         options.depth(dim, radius));
    const Rows gradient = dn * inverse_of(jacobian);
    out.gradient.insert(out.gradient.end(), gradient.data(), gradient.data() + gradient.size());
    if (!round) continue;
    for (int a = 0; a < t.nodes; ++a) out.hoop.push_back(n(a) / radius);
  }
  if (options.formulation == Formulation::one_point && has_hourglasses(*cells.element))
    average(cells, x, options.hourglass * moduli.p_wave(), moduli.youngs(), t.points, out);
  if (options.formulation == Formulation::mean_dilatation)
    add_dilatation(x, t, cells.element->order == 1 ? 1 : 1 + dim, out);
}

}  // namespace abut
