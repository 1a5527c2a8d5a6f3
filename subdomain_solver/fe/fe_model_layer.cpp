// The surface layer of finite elements: nodes whose mass the others of their cells have.

#include <algorithm>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

void FeModel::make_massless(const std::vector<std::int32_t>& nodes) {
  ABUT_ASSERT(massless_.empty() && (!assembly_ || assembly_->mass.size() == 0));
  for (const std::int32_t node : nodes) {
    for (int i = 0; i < mesh_.dim; ++i) massless_.push_back(node * mesh_.dim + i);
  }
  std::sort(massless_.begin(), massless_.end());
  for (std::size_t k = 0; k < mesh_.blocks.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    const std::size_t n = index(cells.element->nodes);
    for (int c = 0; c < cells.count(); ++c) {
      const std::span own = std::span(cells.nodes).subspan(index(c) * n, n);
      const std::ptrdiff_t bare = std::ranges::count_if(own, [this](std::int32_t node) {
        return std::ranges::binary_search(massless_, node * mesh_.dim);
      });
      if (bare == 0) continue;
      if (index(bare) == n) {
        throw InputError(fmt::format("{} has no node that could take the mass of its surface",
                                     cell_text(mesh_, k, index(c))),
                         "mesh", "Use a finer mesh, or fewer ports for contact.");
      }
      layer_cells_.emplace_back(static_cast<int>(k), c);
    }
  }
  lump_mass();
}

/// Of one cell's mass, what belongs to massless nodes goes to its others in equal parts: the matrix
/// keeps its sum.
void FeModel::hand_over(std::span<const std::int32_t> nodes, Eigen::MatrixXd& nodal) const {
  const double total = nodal.sum();
  std::vector<Eigen::Index> others;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const Eigen::Index at = static_cast<Eigen::Index>(a);
    if (!std::ranges::binary_search(massless_, nodes[a] * mesh_.dim)) {
      others.push_back(at);
      continue;
    }
    nodal.row(at).setZero();
    nodal.col(at).setZero();
  }
  if (others.size() == nodes.size()) return;
  const double each = (total - nodal.sum()) / static_cast<double>(others.size());
  for (const Eigen::Index at : others) nodal(at, at) += each;
}

/// Of a linear bar, from differences of displacements, as its whole force: what is far smaller than
/// a rounding of F, which is about 1, counts too.
void FeModel::spring_layer(std::span<const double> q, LayerResponse& out) {
  const SparseMatrix& stiffness = linear_stiffness();
  const Eigen::Index size = static_cast<Eigen::Index>(massless_.size());
  out.force.setZero(size);
  out.tangent.setZero(size, size);
  for (Eigen::Index row = 0; row < size; ++row) {
    const int dof = massless_[index(row)];
    for (SparseMatrix::InnerIterator at(stiffness, dof); at; ++at) {
      const int other = static_cast<int>(at.row());
      if (other != dof) out.force(row) += at.value() * (q[index(other)] - q[index(dof)]);
      const auto place = std::ranges::lower_bound(massless_, other);
      if (place != massless_.end() && *place == other)
        out.tangent(row, place - massless_.begin()) = at.value();
    }
  }
}

bool FeModel::evaluate_layer(std::span<const double> q, std::span<const double> history,
                             LayerResponse& out) {
  if (is_linear() && mesh_.dim == 1) {
    spring_layer(q, out);
    return true;
  }
  const int dim = mesh_.dim, size = static_cast<int>(massless_.size());
  const auto place = [this](int dof) {
    const auto at = std::ranges::lower_bound(massless_, dof);
    return at != massless_.end() && *at == dof ? static_cast<int>(at - massless_.begin()) : -1;
  };
  out.force.setZero(size);
  out.tangent.setZero(size, size);
  for (const auto& [block, cell] : layer_cells_) {
    if (!respond(block, cell, q, history)) return false;
    const CellBlock& cells = mesh_.blocks[index(block)];
    const int n = cells.element->nodes;
    const std::span own = std::span(cells.nodes).subspan(index(cell * n), index(n));
    turn(own, &local_.force, &local_.tangent);
    for (int a = 0; a < n; ++a) {
      const int row = place(own[index(a)] * dim);
      if (row < 0) continue;
      out.force.segment(row, dim) += local_.force.segment(a * dim, dim);
      for (int b = 0; b < n; ++b) {
        const int column = place(own[index(b)] * dim);
        if (column >= 0)
          out.tangent.block(row, column, dim, dim) +=
              local_.tangent.block(a * dim, b * dim, dim, dim);
      }
    }
  }
  return true;
}

}  // namespace abut
