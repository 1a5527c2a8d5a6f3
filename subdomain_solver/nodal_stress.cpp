#include "subdomain_solver/nodal_stress.hpp"

#include <algorithm>
#include <limits>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/solid_measures.hpp"

namespace abut {

namespace {

using Eigen::MatrixXd;

/// 1 and the coordinates on simplices, all their products on squares and cubes: as many terms as
/// corners.
Vector polynomial(const Element& element, const Vector& xi) {
  Vector terms = Vector::Ones(element.corner_count());
  const bool simplex = element.corner_count() == element.dim + 1;
  for (int k = 1; k < element.corner_count(); ++k) {
    if (simplex) {
      terms(k) = xi(k - 1);
      continue;
    }
    for (int i = 0; i < element.dim; ++i)
      if ((k >> i & 1) != 0) terms(k) *= xi(i);
  }
  return terms;
}

}  // namespace

StressEntries entries_of(const Matrix3& s) {
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
}

Matrix3 stress_of(const StressEntries& e) {
  Matrix3 stress;
  stress << e[0], e[3], e[5], e[3], e[1], e[4], e[5], e[4], e[2];
  return stress;
}

MatrixXd extrapolation(const Element& element, const Tabulation& rule, int points) {
  const int terms = element.corner_count();
  if (points != rule.points || points < terms)
    return MatrixXd::Constant(element.nodes, points, 1.0 / points);
  const Eigen::Map<const MatrixXd> corners(element.corners.data(), element.dim, element.nodes);
  const Eigen::Map<const MatrixXd> n(rule.n.data(), element.nodes, points);
  const Eigen::Map<const Vector> weight(rule.weight.data(), points);
  MatrixXd at_points(points, terms), at_nodes(element.nodes, terms);
  for (int p = 0; p < points; ++p)
    at_points.row(p) = polynomial(element, corners * n.col(p)).transpose();
  for (int a = 0; a < element.nodes; ++a)
    at_nodes.row(a) = polynomial(element, corners.col(a)).transpose();
  const MatrixXd weighted = at_points.transpose() * weight.asDiagonal();
  return at_nodes * solve_symmetric(weighted * at_points, weighted);
}

NodalStress nodal_stress(FeModel& model, std::span<const double> q,
                         std::span<const double> history) {
  const Mesh& mesh = model.mesh();
  const std::size_t nodes = index(mesh.node_count());
  MatrixXd sum = MatrixXd::Zero(6, mesh.node_count());
  std::vector<int> cells(nodes, 0);
  MatrixXd to_nodes, here;  // (nodes, points) of the present block; (6, points) of the cell
  int block = -1;
  NodalStress out;
  const bool admissible = model.visit(q, history, [&](const FeModel::PointState& point) {
    const CellBlock& all = mesh.blocks[point.block];
    if (point.block != block) {
      block = point.block;
      const Tabulation& rule = model.rule(block);
      const int points = law_points(*all.element, rule, model.options().formulation);
      to_nodes = extrapolation(*all.element, rule, points);
      here.resize(6, points);
    }
    const Matrix3 stress = cauchy_stress(model.material(), point.stress, point.deformation);
    here.col(point.point) = Eigen::Map<const Vector>(entries_of(stress).data(), 6);
    if (point.point + 1 < here.cols()) return;
    for (int a = 0; a < all.element->nodes; ++a) {
      const std::int32_t node = all.nodes[point.cell * all.element->nodes + a];
      StressEntries said{};
      Eigen::Map<Vector> entries(said.data(), 6);
      entries = here * to_nodes.row(a).transpose();
      out.most_of_cells = std::max(out.most_of_cells, von_mises(stress_of(said)));
      sum.col(node) += entries;
      ++cells[node];
    }
  });
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  out.nodes.resize(nodes);
  for (std::size_t node = 0; node < nodes; ++node) {
    for (std::size_t k = 0; k < 6; ++k)
      out.nodes[node][k] =
          admissible ? sum(static_cast<int>(k), static_cast<int>(node)) / cells[node] : nothing;
  }
  if (!admissible) out.most_of_cells = nothing;
  return out;
}

}  // namespace abut
