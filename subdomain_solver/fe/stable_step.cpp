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
  Eigen::MatrixXd stiffness;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& cells = mesh.blocks[b];
    CellKeys keys(mesh, cells);
    std::unordered_set<CellKeys::Key, CellKeys::Hash> seen;
    for (int c = 0; c < cells.count(); ++c) {
      if (alike && !seen.insert(model.is_linear() ? keys.of(c) : keys.of(c, u)).second) continue;
      if (!model.cell_tangent(b, c, q, history, stiffness))
        return std::numeric_limits<double>::quiet_NaN();
      most = std::max(most, highest_square(stiffness, model.cell_mass(b, c)));
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
