#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "subdomain_solver/fe/batched_cells.hpp"
#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Internal forces on the coordinates of a surface layer, by batches of the cells that touch it.
class BatchedLayer {
 public:
  /// `cells`: (block, cell), in the order of blocks; `dofs`: of the mesh, ascending, of nodes of
  /// these cells.
  BatchedLayer(const Mesh& mesh, const Material& material, const BatchedOptions& options,
               std::span<const std::pair<int, int>> cells, std::span<const int> dofs);

  /// q: [m] (nodes of the mesh, dim); force: [N] (dofs). False: a point has no answer.
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<double> force);

 private:
  std::size_t dim_;
  std::vector<std::int32_t> nodes_;  // of the mesh, ascending: those of the cells
  std::vector<std::size_t> places_;  // (dofs) of them among the values of nodes_
  std::optional<BatchedCells> batched_;
  std::vector<double> displacement_, force_;  // [m], [N] (nodes_, dim)
};

}  // namespace abut
