#include "subdomain_solver/overlap/conforming.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace abut {

namespace {

constexpr double same_overlap_place = 1.0e-6;  // of a cell

Eigen::Vector3d place_of(const Mesh& mesh, std::int32_t node) {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int i = 0; i < mesh.dim; ++i) x(i) = mesh.points[node * mesh.dim + i];
  return x;
}

std::span<const std::int32_t> nodes_of(const Mesh& mesh, CellPlace place) {
  return nodes_of(mesh.blocks[place.block], place.cell);
}

Eigen::Vector3d middle_of(const Mesh& mesh, CellPlace place) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const std::span<const std::int32_t> nodes = nodes_of(mesh, place);
  for (const std::int32_t node : nodes) sum += place_of(mesh, node);
  return sum / static_cast<double>(nodes.size());
}

/// Along a direction in which cells of lattices differ.
double along(const Eigen::Vector3d& x) { return x.x() + 0.7320508 * x.y() + 0.4142136 * x.z(); }

/// Cells of a mesh by where their middles are.
std::vector<std::pair<double, CellPlace>> in_order(const Mesh& mesh) {
  std::vector<std::pair<double, CellPlace>> cells;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    for (std::int32_t c = 0; c < mesh.blocks[b].count(); ++c) {
      const CellPlace place{static_cast<std::int32_t>(b), c};
      cells.emplace_back(along(middle_of(mesh, place)), place);
    }
  }
  std::ranges::sort(cells, {}, [](const auto& cell) { return cell.first; });
  return cells;
}

/// Whether every node of a cell is where a node of the other one is.
bool meet(const Mesh& own, CellPlace cell, const Mesh& other, CellPlace its, double near) {
  const std::span<const std::int32_t> theirs = nodes_of(other, its);
  const std::span<const std::int32_t> nodes = nodes_of(own, cell);
  return nodes.size() == theirs.size() && std::ranges::all_of(nodes, [&](std::int32_t node) {
           const Eigen::Vector3d x = place_of(own, node);
           return std::ranges::any_of(
               theirs, [&](std::int32_t k) { return (place_of(other, k) - x).norm() <= near; });
         });
}

}  // namespace

std::optional<CellPlace> first_without_twin(const CommonParts& common, const Mesh& own,
                                            const Mesh& other) {
  const std::vector<std::pair<double, CellPlace>> theirs = in_order(other);
  for (const CommonParts::Part& part : common.parts) {
    const Eigen::Vector3d middle = middle_of(own, part.cell);
    const std::span<const std::int32_t> nodes = nodes_of(own, part.cell);
    const double size = (place_of(own, nodes[0]) - middle).norm();
    const double near = same_overlap_place * size, at = along(middle),
                 far = 2.0 * near;  // |direction| < 2
    auto it =
        std::ranges::lower_bound(theirs, at - far, {}, [](const auto& cell) { return cell.first; });
    while (it != theirs.end() && it->first <= at + far &&
           !meet(own, part.cell, other, it->second, near))
      ++it;
    if (it == theirs.end() || it->first > at + far) return part.cell;
  }
  return std::nullopt;
}

}  // namespace abut
