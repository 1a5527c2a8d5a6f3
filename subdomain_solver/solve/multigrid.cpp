#include "subdomain_solver/solve/multigrid.hpp"

#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/solve/aggregates.hpp"

namespace abut {

namespace {

/// Unknowns that a direct solver takes in the time of a sweep through some 1e5.
constexpr Eigen::Index few_unknowns = 1500;
/// The published bound of strong couplings of the finest level; half as much on each coarser one.
constexpr double weak_couplings = 0.08;
/// Levels until a matrix that does not get smaller is given up.
constexpr std::size_t most_levels = 20;

/// Orthonormal columns of a block (rows, motions) in `block`, as many as it has directions, and
/// what they take to make it again (directions, motions).
Eigen::MatrixXd orthonormalise(Eigen::MatrixXd& block) {
  const Eigen::MatrixXd whole = block;
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < whole.cols(); ++k) {
    Vector column = whole.col(k);
    const double size = column.norm();
    for (int twice = 0; twice < 2; ++twice)
      for (Eigen::Index j = 0; j < kept; ++j) column -= block.col(j).dot(column) * block.col(j);
    const double left = column.norm();
    if (!(left > 1.0e-6 * size)) continue;  // a motion that these nodes do not tell apart
    block.col(kept++) = column / left;
  }
  block.conservativeResize(Eigen::NoChange, kept);
  return block.transpose() * whole;
}

/// Motions of groups as rigid as their nodes' motions are: (rows, coarser rows), and what of these
/// is left for the next level.
SparseMatrix tentative(const CoarseMotions& motions, const std::vector<std::int32_t>& groups,
                       CoarseMotions& coarser) {
  std::vector<std::vector<Eigen::Index>> rows;  // of each group
  for (std::size_t row = 0; row < motions.nodes.size(); ++row) {
    const std::size_t group = index(groups[index(motions.nodes[row])]);
    if (rows.size() <= group) rows.resize(group + 1);
    rows[group].push_back(static_cast<Eigen::Index>(row));
  }
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<Eigen::MatrixXd> left;
  coarser.nodes.clear();
  std::int32_t nodes = 0;
  for (std::size_t group = 0; group < rows.size(); ++group) {
    Eigen::MatrixXd block = motions.motions(rows[group], Eigen::all);
    left.push_back(orthonormalise(block));
    for (Eigen::Index k = 0; k < block.cols(); ++k) {
      const auto column = static_cast<Eigen::Index>(coarser.nodes.size());
      coarser.nodes.push_back(nodes);
      for (Eigen::Index i = 0; i < block.rows(); ++i)
        entries.emplace_back(rows[group][index(i)], column, block(i, k));
    }
    if (block.cols() > 0) ++nodes;
  }
  const auto count = static_cast<Eigen::Index>(coarser.nodes.size());
  coarser.motions.resize(count, motions.motions.cols());
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& part : left) {
    coarser.motions.middleRows(at, part.rows()) = part;
    at += part.rows();
  }
  SparseMatrix out(motions.motions.rows(), count);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Largest eigenvalue of D^-1 A, some hundredths too small, by the power method from a start that
/// has no symmetry.
double largest_eigenvalue(const SparseMatrix& matrix, const Vector& inverse_diagonal) {
  Vector x(matrix.rows());
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) = std::sin(1.0 + 1.7 * static_cast<double>(i));
  double value = 0.0;
  for (int k = 0; k < 12; ++k) {
    x /= x.norm();
    const Vector next = inverse_diagonal.cwiseProduct(matrix * x);
    value = next.norm();
    x = next;
  }
  return value;
}

/// One sweep of Gauss and Seidel towards A z = r, by columns: of a symmetric matrix they are rows.
void gauss_seidel(const SparseMatrix& matrix, const Vector& r, Vector& z, bool forward) {
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index i = forward ? k : n - 1 - k;
    double sum = r(i), diagonal = 0.0;
    for (SparseMatrix::InnerIterator entry(matrix, i); entry; ++entry) {
      sum -= entry.value() * z(entry.row());
      if (entry.row() == i) diagonal = entry.value();
    }
    z(i) += sum / diagonal;
  }
}

}  // namespace

Multigrid::Multigrid(CoarseMotions motions) : motions_(std::move(motions)) {}

bool Multigrid::factor(const SparseMatrix& matrix) {
  ABUT_ASSERT(matrix.rows() == motions_.motions.rows());
  levels_.clear();
  levels_.emplace_back().matrix = matrix;
  CoarseMotions motions = motions_;
  while (levels_.back().matrix.rows() > few_unknowns && levels_.size() < most_levels) {
    if (!(levels_.back().matrix.diagonal().minCoeff() > 0.0)) return false;
    if (!add_level(motions)) break;
  }
  for (Level& level : levels_) {
    level.r.resize(level.matrix.rows());
    level.z.resize(level.matrix.rows());
  }
  coarsest_ = make_own_solver(Pivots::definite);
  return coarsest_->factor(levels_.back().matrix);
}

/// P = (1 - 4/3 D^-1 A / largest) T. False: there is nothing to make groups of.
bool Multigrid::add_level(CoarseMotions& motions) {
  Level& fine = levels_.back();
  const double weak = weak_couplings * std::pow(0.5, static_cast<double>(levels_.size() - 1));
  CoarseMotions coarser;
  const SparseMatrix rough =
      tentative(motions, aggregates(fine.matrix, motions.nodes, weak), coarser);
  if (rough.cols() >= rough.rows()) return false;
  const Vector inverse = fine.matrix.diagonal().cwiseInverse();
  const Vector damping = 4.0 / 3.0 / largest_eigenvalue(fine.matrix, inverse) * inverse;
  SparseMatrix smoothed = fine.matrix * rough;
  smoothed = damping.asDiagonal() * smoothed;
  smoothed = rough - smoothed;
  fine.prolongation = smoothed;
  Level next;
  const SparseMatrix applied = fine.matrix * smoothed;
  next.matrix = SparseMatrix(smoothed.transpose()) * applied;
  motions = std::move(coarser);
  levels_.push_back(std::move(next));
  return true;
}

void Multigrid::cycle(std::size_t at) {
  Level& level = levels_[at];
  if (at + 1 == levels_.size()) {
    if (!coarsest_->solve(level.r, level.z)) level.z.setConstant(std::nan(""));
    return;
  }
  level.z.setZero();
  gauss_seidel(level.matrix, level.r, level.z, true);
  level.rest.noalias() = level.r - level.matrix * level.z;
  levels_[at + 1].r.noalias() = level.prolongation.transpose() * level.rest;
  cycle(at + 1);
  level.z.noalias() += level.prolongation * levels_[at + 1].z;
  gauss_seidel(level.matrix, level.r, level.z, false);
}

void Multigrid::apply(const Vector& r, Vector& z) {
  levels_.front().r = r;
  cycle(0);
  z = levels_.front().z;
}

std::vector<Eigen::Index> Multigrid::sizes() const {
  std::vector<Eigen::Index> out;
  for (const Level& level : levels_) out.push_back(level.matrix.rows());
  return out;
}

}  // namespace abut
