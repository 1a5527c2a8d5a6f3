// What the passive form of finite elements takes of them: all mass on the nodes, definite tangents.

#include <algorithm>

#include <Eigen/LU>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

namespace {

/// Negative eigenvalues become zero.
void make_definite(Eigen::MatrixXd& matrix) {
  const auto [values, vectors] = symmetric_eigen(matrix);
  matrix = vectors * values.cwiseMax(0.0).asDiagonal() * vectors.transpose();
}

}  // namespace

/// As hand_over() and inherit() move it.
SparseMatrix FeModel::given_mass() const {
  std::vector<Eigen::Triplet<double>> parts;
  const int dim = mesh_.dim;
  for (const auto& cell : layer_cells_) {
    const std::span<const std::int32_t> nodes = nodes_of(mesh_.blocks[cell.first], cell.second);
    const Vector own = cell_mass(cell.first, cell.second);
    for (int i = 0; i < dim; ++i) {
      std::vector<std::int32_t> takers;
      for (const std::int32_t node : nodes)
        if (takes_mass(node, i)) takers.push_back(node);
      if (takers.empty() && heirs_[i].contains(cell)) takers = heirs_[i].at(cell);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        if (!is_bare(nodes[a], i)) continue;
        const double each = own(static_cast<Eigen::Index>(a)) / static_cast<double>(takers.size());
        for (const std::int32_t taker : takers)
          parts.emplace_back(nodes[a] * dim + i, taker * dim + i, each);
      }
    }
  }
  SparseMatrix given(dofs(), dofs());
  given.setFromTriplets(parts.begin(), parts.end());
  return given;
}

const std::vector<Vector>& FeModel::cell_masses() const {
  std::vector<Vector>& masses = assembly().cell_masses;
  if (!masses.empty()) return masses;
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    for (int c = 0; c < mesh_.blocks[k].count(); ++c)
      masses.push_back(cell_mass(static_cast<int>(k), c));
  return masses;
}

bool FeModel::definite_tangent(std::span<const double> q, std::span<const double> history,
                               double inertia, SparseMatrix& tangent) {
  const Assembly& reference = assembly();
  auto mass = cell_masses().begin();
  tangent = reference.pattern;
  const int dim = mesh_.dim;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    for (int c = 0; c < mesh_.blocks[k].count(); ++c, ++mass) {
      if (!respond(static_cast<int>(k), c, q, history)) return false;
      Eigen::MatrixXd whole = local_.tangent;
      for (Eigen::Index a = 0; a < whole.rows(); ++a) whole(a, a) += inertia * (*mass)(a / dim);
      if (!factor_definite(whole)) make_definite(local_.tangent);
      turn(nodes_of(mesh_.blocks[k], c), nullptr, &local_.tangent);
      add_matrix(k, c, reference, local_.tangent, tangent);
    }
  }
  return true;
}

/// Where volume can be taken from all sides, laws resist too little; where the section is free to
/// swell, those that give way.
bool FeModel::can_be_crushed() const {
  const bool free = mesh_.dim == 1 || (mesh_.dim == 2 && options_.plane == Plane::stress);
  return !is_linear() && (!free || !material().resists_crushing());
}

bool FeModel::guard(bool on) {
  kernel_.guard(on && can_be_crushed());
  answers_->guard(kernel_.guarded());
  return kernel_.guarded();
}

double FeModel::least_volume(std::span<const double> q) const {
  double least = 1.0;
  if (!can_be_crushed()) return least;
  std::vector<double> turned;
  std::span<const double> u = q;
  if (!frames_.empty()) {
    turned.assign(q.begin(), q.end());
    to_space(turned);
    u = turned;
  }
  const std::size_t dim = index(mesh_.dim);
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Tabulation& table = blocks_[k].table;
    for (int c = 0; c < mesh_.blocks[k].count(); ++c) {
      const std::span<const std::int32_t> nodes = nodes_of(mesh_.blocks[k], c);
      const double* slope = table.dn.data();
      for (int p = 0; p < table.points; ++p) {
        Matrix3 before = Matrix3::Identity(), now = Matrix3::Identity();
        before.topLeftCorner(mesh_.dim, mesh_.dim).setZero();
        now.topLeftCorner(mesh_.dim, mesh_.dim).setZero();
        for (const std::int32_t node : nodes) {
          for (std::size_t j = 0; j < dim; ++j, ++slope) {
            for (std::size_t i = 0; i < dim; ++i) {
              const double x = mesh_.points[index(node) * dim + i];
              const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
              before(row, column) += x * *slope;
              now(row, column) += (x + u[index(node) * dim + i]) * *slope;
            }
          }
        }
        least = std::min(least, now.determinant() / before.determinant());
      }
    }
  }
  return least;
}

}  // namespace abut
