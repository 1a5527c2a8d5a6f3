#include "subdomain_solver/fe/stable_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/cell_keys.hpp"

namespace abut {

namespace {

/// By which a bound is raised for what CellKeys do not tell apart.
constexpr double margin = 1.0e-6;

/// Whether all squares of a cell's frequencies are below one: Cholesky factors of square M - K,
/// which takes the place of K, cost a tenth of eigenvalues.
bool is_slower(Eigen::MatrixXd& stiffness, const Vector& mass, double square) {
  const Eigen::Index dim = stiffness.rows() / mass.size();
  stiffness *= -1.0;
  for (Eigen::Index i = 0; i < stiffness.rows(); ++i) stiffness(i, i) += square * mass(i / dim);
  return factor_definite(stiffness);
}

}  // namespace

double highest_square(Eigen::MatrixXd stiffness, const Vector& mass) {
  const Eigen::Index dim = stiffness.rows() / mass.size();
  for (Eigen::Index i = 0; i < stiffness.rows(); ++i) {
    const double root = 1.0 / std::sqrt(mass(i / dim));
    stiffness.row(i) *= root;
    stiffness.col(i) *= root;
  }
  return symmetric_eigenvalues(stiffness).tail(1)(0);
}

double stable_step(FeModel& model, std::span<const double> q, std::span<const double> history) {
  const Mesh& mesh = model.mesh();
  std::vector<double> u(q.begin(), q.end());
  model.to_space(u);
  // Cells away from the axis are stiffer or softer than equal ones near it.
  const bool alike = !model.round() &&
                     std::all_of(history.begin(), history.end(), [](double h) { return h == 0.0; });
  double most = 0.0;
  Eigen::MatrixXd stiffness, shifted;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& cells = mesh.blocks[b];
    CellKeys keys(mesh, cells);
    std::unordered_set<CellKeys::Key, CellKeys::Hash> seen;
    for (int c = 0; c < cells.count(); ++c) {
      if (alike && !seen.insert(model.is_linear() ? keys.of(c) : keys.of(c, u)).second) continue;
      if (!model.cell_tangent(b, c, q, history, stiffness))
        return std::numeric_limits<double>::quiet_NaN();
      const Vector mass = model.cell_mass(b, c);
      shifted = stiffness;
      if (most > 0.0 && is_slower(shifted, mass, most)) continue;
      most = std::max(most, highest_square(stiffness, mass));
    }
  }
  if (!(most > 0.0)) return std::numeric_limits<double>::infinity();
  return 2.0 / (std::sqrt(most) * (1.0 + margin));
}

double stable_step(FeModel& model) {
  const std::vector<double> rest(index(model.dofs()), 0.0);
  const std::vector<double> history(model.history_size(), 0.0);
  return stable_step(model, rest, history);
}

}  // namespace abut
