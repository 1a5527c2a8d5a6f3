#include "subdomain_solver/fe/stable_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/cell_keys.hpp"
#include "subdomain_solver/fe/slower_cells.hpp"

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

/// The square of the highest frequency of cells, which wait until eight can be held against the
/// fastest so far; those that are not told slower are computed, in order.
class FastestCell {
 public:
  FastestCell(FeModel& model, std::span<const double> q, std::span<const double> u,
              std::span<const double> history)
      : model_(model), slower_(model), q_(q), u_(u), history_(history) {}

  double square() const { return most_; }  // NaN: a cell has no answer
  void add(int block, int cell) {
    waiting_.push_back(cell);
    if (waiting_.size() == batch_lanes || !(most_ > 0.0)) finish(block);
  }
  void finish(int block) {
    if (waiting_.empty()) return;
    const unsigned slower = most_ > 0.0 ? slower_.find(block, waiting_, u_, history_, most_) : 0u;
    for (std::size_t k = 0; k < waiting_.size(); ++k)
      if ((slower >> k & 1u) == 0) compute(block, waiting_[k]);
    waiting_.clear();
  }

 private:
  void compute(int block, int cell) {
    if (std::isnan(most_)) return;
    if (!model_.cell_tangent(block, cell, q_, history_, stiffness_)) {
      most_ = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    const Vector mass = model_.cell_mass(block, cell);
    shifted_ = stiffness_;
    if (most_ > 0.0 && is_slower(shifted_, mass, most_)) return;
    const double own = highest_square(stiffness_, mass);
    if (most_ < own) most_ = own;  // never again where it is NaN
  }

  FeModel& model_;
  SlowerCells slower_;
  std::span<const double> q_, u_, history_;
  std::vector<int> waiting_;
  double most_ = 0.0;
  Eigen::MatrixXd stiffness_, shifted_;
};

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
  FastestCell fastest(model, q, u, history);
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& cells = mesh.blocks[b];
    CellKeys keys(mesh, cells);
    std::unordered_set<CellKeys::Key, CellKeys::Hash> seen;
    for (int c = 0; c < cells.count(); ++c) {
      if (alike && !seen.insert(model.is_linear() ? keys.of(c) : keys.of(c, u)).second) continue;
      fastest.add(b, c);
    }
    fastest.finish(b);
  }
  const double most = fastest.square();
  if (std::isnan(most)) return most;
  if (!(most > 0.0)) return std::numeric_limits<double>::infinity();
  return 2.0 / (std::sqrt(most) * (1.0 + margin));
}

double stable_step(FeModel& model) {
  const std::vector<double> rest(index(model.dofs()), 0.0);
  const std::vector<double> history(model.history_size(), 0.0);
  return stable_step(model, rest, history);
}

}  // namespace abut
