#include "subdomain_solver/fe/stable_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <Eigen/Eigenvalues>

namespace abut {

namespace {

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Largest eigenvalue of M^-1 K with a diagonal M of one number per node.
double highest(const Eigen::MatrixXd& stiffness, const Vector& nodal_mass, int dim) {
  Eigen::MatrixXd scaled = stiffness;
  for (int i = 0; i < scaled.rows(); ++i) {
    const double root = 1.0 / std::sqrt(nodal_mass(i / dim));
    scaled.row(i) *= root;
    scaled.col(i) *= root;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().tail(1)(0);
}

/// Shape and displacement of a cell as seen from its first node, in parts of 2^-36 of its size:
/// far above the rounding of equal cells at different places, and far below what matters. Enough
/// for 1e-6 in the frequency at aspect ratios of 1e4, by which the bound is raised.
using Key = std::vector<std::int64_t>;
constexpr int key_digits = 36;
constexpr double margin = 1.0e-6;

struct Hash {
  std::size_t operator()(const Key& key) const {
    std::size_t sum = 0;
    for (const std::int64_t part : key) sum = (sum ^ index(part)) * 0x9e3779b97f4a7c15ull;
    return sum ^ sum >> 29;
  }
};

void append(std::span<const double> values, const CellBlock& cells, int cell, int dim, int exponent,
            Key& key) {
  const std::size_t n = index(cells.element->nodes), first = index(cell) * n;
  const double* origin = values.data() + index(cells.nodes[first]) * index(dim);
  for (std::size_t a = 1; a < n; ++a) {
    const double* at = values.data() + index(cells.nodes[first + a]) * index(dim);
    for (int i = 0; i < dim; ++i)
      key.push_back(std::llround(std::ldexp(at[i] - origin[i], key_digits - exponent)));
  }
}

/// Exponent of two of the cell's size.
int size_of(const Mesh& mesh, const CellBlock& cells, int cell) {
  const std::size_t n = index(cells.element->nodes), first = index(cell) * n;
  const std::size_t dim = index(mesh.dim), origin = index(cells.nodes[first]) * dim;
  double size = 0.0;
  for (std::size_t k = 0; k < n * dim; ++k) {
    const std::size_t at = index(cells.nodes[first + k / dim]) * dim + k % dim;
    size = std::max(size, std::abs(mesh.points[at] - mesh.points[origin + k % dim]));
  }
  return std::ilogb(size) + 1;
}

}  // namespace

double stable_step(FeModel& model, std::span<const double> q, std::span<const double> history) {
  const Mesh& mesh = model.mesh();
  std::vector<double> u(q.begin(), q.end());
  model.to_space(u);
  // Cells away from the axis are stiffer or softer than equal ones near it.
  const bool alike = !model.round() &&
                     std::all_of(history.begin(), history.end(), [](double h) { return h == 0.0; });
  double most = 0.0;
  Eigen::MatrixXd stiffness;
  Vector mass;
  Key key;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& cells = mesh.blocks[index(b)];
    std::unordered_map<Key, bool, Hash> seen;
    for (int c = 0; c < cells.count(); ++c) {
      const int exponent = size_of(mesh, cells, c);
      key.assign(1, exponent);
      append(mesh.points, cells, c, mesh.dim, exponent, key);
      if (!model.is_linear()) append(u, cells, c, mesh.dim, exponent, key);
      if (alike && !seen.try_emplace(key, true).second) continue;
      if (!model.cell_matrices(b, c, q, history, stiffness, mass))
        return std::numeric_limits<double>::quiet_NaN();
      most = std::max(most, highest(stiffness, mass, mesh.dim));
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
