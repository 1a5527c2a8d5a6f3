#include "subdomain_solver/fe/highest_frequency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/cell_keys.hpp"
#include "subdomain_solver/fe/stable_step.hpp"

namespace abut {

namespace {

/// Largest eigenvalue of B^-1 A, both symmetric and B positive definite.
double largest_ratio(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return generalized_eigenvalues(a, b).tail(1)(0);
}

/// S of [M.58]: of the linear part of the map from the reference shape, (dim, dim).
Eigen::MatrixXd metric_of(const Mesh& mesh, const CellBlock& cells, int cell) {
  const Element& element = *cells.element;
  const int n = element.nodes, dim = mesh.dim;
  Eigen::MatrixXd x(dim, n);
  for (int a = 0; a < n; ++a) {
    const std::int32_t node = cells.nodes[index(cell) * index(n) + index(a)];
    for (int i = 0; i < dim; ++i) x(i, a) = mesh.points[node * dim + i];
  }
  Eigen::MatrixXd corner = Eigen::Map<const Eigen::MatrixXd>(element.corners.data(), dim, n);
  corner.colwise() -= corner.rowwise().mean().eval();
  const Eigen::MatrixXd moment = corner * corner.transpose();
  const Eigen::MatrixXd linear = x * corner.transpose() * inverse_of(moment);
  return linear * moment * linear.transpose() / n;
}

/// Isotropic moduli at rest in the metric: the largest H : A : H / tr(H S H^T).
double rest_in_metric(const Moduli& moduli, const Eigen::MatrixXd& s) {
  const Eigen::Index dim = s.rows(), size = dim * dim;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size), b = a;  // rows i + dim J
  for (Eigen::Index j = 0; j < dim; ++j) {
    for (Eigen::Index i = 0; i < dim; ++i) {
      a(i + dim * i, j + dim * j) += moduli.lame();
      a(i + dim * j, i + dim * j) += moduli.shear;
      a(i + dim * j, j + dim * i) += moduli.shear;
      for (Eigen::Index k = 0; k < dim; ++k) b(k + dim * i, k + dim * j) = s(i, j);
    }
  }
  return largest_ratio(a, b);
}

}  // namespace

HighestFrequency::HighestFrequency(FeModel& model)
    : model_(model), cells_(model.batched()), slower_(model) {
  if (cells_ != nullptr && !cells_->bounds()) cells_ = nullptr;
  if (cells_ != nullptr)
    find_scales();
  else
    find_masses();
}

/// Moduli per metric at which a cell's highest frequency may be 1 [M.58]. Where a stiffness against
/// hourglasses has a part in it, which does not follow the moduli: those at rest, over the square
/// of the frequency with them.
double HighestFrequency::scale_of(int block, int cell) {
  const Mesh& mesh = model_.mesh();
  const Eigen::MatrixXd s = metric_of(mesh, mesh.blocks[block], cell);
  const CellMeasures measures = model_.cell_measures(block, cell);
  const CellGeometry g = measures.of(0);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(g.nodes, g.nodes);
  for (int p = 0; p < g.points; ++p) {
    const Eigen::Map<const Rows> b(g.gradient.data() + index(p * g.nodes * g.dim), g.nodes, g.dim);
    laplacian += g.volume[p] * b * s * b.transpose();
  }
  const Vector mass = model_.cell_mass(block, cell);
  if (g.hourglass.empty()) return 1.0 / highest_square(laplacian, mass);
  const double rest = rest_in_metric(model_.material().moduli(), s);
  const Eigen::Map<const Rows> hourglass(g.hourglass.data(), g.nodes, g.nodes);
  const double square = highest_square(rest * laplacian + hourglass, mass);
  floor_ = std::max(floor_, square);
  return rest / square;
}

void HighestFrequency::find_scales() {
  const Mesh& mesh = model_.mesh();
  std::vector<CellKeys> keys;
  for (const CellBlock& cells : mesh.blocks) keys.emplace_back(mesh, cells);
  std::vector<std::unordered_map<CellKeys::Key, double, CellKeys::Hash>> known(keys.size());
  for (const CellPatch& patch : cells_->patches().list()) {
    const std::size_t first = scales_.size(), b = index(patch.block);
    for (const std::int32_t cell : patch.cells) {
      const auto [at, fresh] = known[b].try_emplace(keys[b].of(cell), 0.0);
      if (fresh) at->second = scale_of(patch.block, cell);
      scales_.push_back(at->second);
    }
    scales_.resize(first + index(patch.batches) * batch_lanes, 0.0);
  }
}

void HighestFrequency::find_masses() {
  const Mesh& mesh = model_.mesh();
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    first_mass_.push_back(masses_.size());
    for (int c = 0; c < mesh.blocks[b].count(); ++c) {
      const Vector mass = model_.cell_mass(static_cast<int>(b), c);
      masses_.insert(masses_.end(), mass.begin(), mass.end());
    }
  }
}

std::optional<FrequencyWatch::Bound> HighestFrequency::bound(std::span<const double> q,
                                                             std::span<const double> history,
                                                             double from, Effort effort) {
  if (cells_ == nullptr) return cell_bound(q, history, from);
  if (effort == Effort::bounded) return batched_bound(in_space(q), history, from);
  return fast_bound(q, history, from);
}

std::span<const double> HighestFrequency::in_space(std::span<const double> q) {
  if (!model_.has_frames()) return q;
  u_.assign(q.begin(), q.end());
  model_.to_space(u_);
  return u_;
}

/// A cell's own square takes the place of a lower bound. False: it has none.
bool HighestFrequency::compute(int block, int cell, std::span<const double> q,
                               std::span<const double> history, Bound& best) {
  if (!model_.cell_tangent(block, cell, q, history, stiffness_)) return false;
  const double square = highest_square(stiffness_, model_.cell_mass(block, cell));
  if (!std::isfinite(square)) return false;
  if (square > best.square) best = {square, block, cell};
  return true;
}

std::optional<FrequencyWatch::Bound> HighestFrequency::batched_bound(
    std::span<const double> u, std::span<const double> history, double from) {
  const double square = cells_->bound_frequencies(u, history, std::max(from, floor_), scales_);
  if (!std::isfinite(square)) return std::nullopt;
  return Bound{square, -1, -1};
}

/// Computes those cells by themselves that are not shown to be slower, until one is faster. Below
/// the floor nothing is shown.
std::optional<FrequencyWatch::Bound> HighestFrequency::fast_bound(std::span<const double> q,
                                                                  std::span<const double> history,
                                                                  double from) {
  fast_.clear();
  cells_->find_fast(in_space(q), history, from < floor_ ? 0.0 : from, scales_, fast_);
  Bound best{from, -1, -1};
  for (const BatchedCells::Place& place : fast_) {
    if (!compute(place.block, place.cell, q, history, best)) return std::nullopt;
    if (best.square > from) break;
  }
  return best;
}

std::optional<FrequencyWatch::Bound> HighestFrequency::cell_bound(std::span<const double> q,
                                                                  std::span<const double> history,
                                                                  double from) {
  const Mesh& mesh = model_.mesh();
  const std::span<const double> u = in_space(q);
  Bound best{from, -1, -1};
  std::array<int, batch_lanes> eight{};
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const int count = mesh.blocks[index(b)].count();
    for (int first = 0; first < count; first += batch_lanes) {
      std::iota(eight.begin(), eight.end(), first);
      const std::span<const int> cells =
          std::span<const int>(eight).first(index(std::min(batch_lanes, count - first)));
      const unsigned slower = slower_.can(b) ? slower_.find(b, cells, u, history, best.square) : 0u;
      for (std::size_t k = 0; k < cells.size(); ++k)
        if ((slower >> k & 1u) == 0 && !raise(b, cells[k], q, history, best)) return std::nullopt;
    }
  }
  return best;
}

/// By one cell, where Cholesky factors do not tell it slower. False: it has no answer.
bool HighestFrequency::raise(int block, int cell, std::span<const double> q,
                             std::span<const double> history, Bound& best) {
  const Mesh& mesh = model_.mesh();
  const int nodes = mesh.blocks[index(block)].element->nodes;
  if (!model_.cell_tangent(block, cell, q, history, stiffness_)) return false;
  const double* mass = masses_.data() + first_mass_[index(block)] + index(cell) * index(nodes);
  shifted_ = -stiffness_;
  for (int i = 0; i < shifted_.rows(); ++i) shifted_(i, i) += best.square * mass[i / mesh.dim];
  return factor_definite(shifted_) || compute(block, cell, q, history, best);
}

std::string HighestFrequency::place(const Bound& bound) const {
  return cell_text(model_.mesh(), index(bound.block), index(bound.cell));
}

}  // namespace abut
