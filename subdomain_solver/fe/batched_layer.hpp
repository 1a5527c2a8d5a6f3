#pragma once

#include <optional>
#include <span>
#include <vector>

#include "subdomain_solver/fe/batched_cells.hpp"
#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Internal forces on the coordinates of a surface layer, by batches of the cells that touch it.
class BatchedLayer {
 public:
  /// A cell of the mesh, and where its numbers begin in the histories of the mesh's points.
  struct Cell {
    int block = 0, cell = 0;
    std::int64_t first_history = 0;
  };
  /// `cells`: in the order of blocks; `dofs`: of the mesh, ascending, of nodes of these cells.
  BatchedLayer(const Mesh& mesh, const Material& material, BatchedOptions options,
               std::span<const Cell> cells, std::span<const int> dofs);

  /// q: [m] (nodes of the mesh, dim); history: of all points at the step's begin; force: [N]
  /// (dofs). False: a point has no answer.
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<const double> history,
                              std::span<double> force);
  /// [N] of the forces on all nodes of the cells, the root of the sum of their squares.
  double size() const;

 private:
  std::size_t dim_;
  std::vector<std::int32_t> nodes_;  // of the mesh, ascending: those of the cells
  std::vector<std::size_t> places_;  // (dofs) of them among the values of nodes_
  std::optional<BatchedCells> batched_;
  std::vector<double> displacement_, force_;  // [m], [N] (nodes_, dim)
};

}  // namespace abut
