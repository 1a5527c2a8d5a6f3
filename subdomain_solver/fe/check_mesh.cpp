// Refusal of meshes that no analysis can run on.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "subdomain_solver/fe/cell_words.hpp"

namespace abut {
namespace {

using Index = std::size_t;

/// "(0.1, 0.2, 0) m"
std::string position(std::span<const double> x) {
  return fmt::format("({:.9g}) m", fmt::join(x, ", "));
}

std::span<const double> point(const Mesh& mesh, Index node) {
  const auto dim = static_cast<Index>(mesh.dim);
  return std::span(mesh.points).subspan(node * dim, dim);
}

double distance(const Mesh& mesh, Index a, Index b) {
  double sum = 0.0;
  for (Index d = 0; d < static_cast<Index>(mesh.dim); ++d) {
    const double gap = point(mesh, a)[d] - point(mesh, b)[d];
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

/// The nodes of a cell.
std::span<const std::int32_t> cell_nodes(const CellBlock& block, Index cell) {
  const auto nodes = static_cast<Index>(block.element->nodes);
  return std::span(block.nodes).subspan(cell * nodes, nodes);
}

double determinant(const std::array<double, 9>& j, int dim) {
  if (dim == 1) return j[0];
  if (dim == 2) return j[0] * j[3] - j[1] * j[2];
  return j[0] * (j[4] * j[8] - j[5] * j[7]) - j[1] * (j[3] * j[8] - j[5] * j[6]) +
         j[2] * (j[3] * j[7] - j[4] * j[6]);
}

/// Smallest Jacobian of a cell over the points of a table [m^dim].
/// `sign` -1: the largest one, with the other sign.
double smallest_jacobian(const Mesh& mesh, std::span<const std::int32_t> nodes,
                         const Tabulation& table, double sign = 1.0) {
  const auto dim = static_cast<Index>(mesh.dim);
  double least = std::numeric_limits<double>::infinity();
  for (Index q = 0; q < static_cast<Index>(table.points); ++q) {
    std::array<double, 9> j{};
    for (Index a = 0; a < nodes.size(); ++a) {
      const std::span<const double> x = point(mesh, static_cast<Index>(nodes[a]));
      const double* dn = &table.dn[(q * nodes.size() + a) * dim];
      for (Index i = 0; i < dim; ++i)
        for (Index k = 0; k < dim; ++k) j[i * dim + k] += x[i] * dn[k];
    }
    const double value = sign * determinant(j, mesh.dim);
    if (std::isnan(value)) return value;
    least = std::min(least, value);
  }
  return least;
}

/// What rounding of the coordinates leaves of the Jacobian of a flat cell: its extent to the power
/// of the dimension, times the relative error of differences of coordinates of this size.
double rounding_of(const Mesh& mesh, std::span<const std::int32_t> nodes) {
  double extent = 0.0, size = 0.0;
  for (std::int32_t node : nodes) {
    extent =
        std::max(extent, distance(mesh, static_cast<Index>(nodes[0]), static_cast<Index>(node)));
    for (double x : point(mesh, static_cast<Index>(node))) size = std::max(size, std::abs(x));
  }
  return 16.0 * std::numeric_limits<double>::epsilon() * (extent + size) *
         std::pow(extent, mesh.dim - 1);
}

void check_shape_of_arrays(const Mesh& mesh, const std::string& where) {
  if (mesh.dim < 1 || mesh.dim > 3)
    throw InputError(fmt::format("is a mesh in {} dimensions", mesh.dim), where, "Use 1 to 3.");
  if (mesh.cell_count() == 0)
    throw InputError("has no cells", where, "Mesh the part's inside, not only its boundary.");
  for (const CellBlock& block : mesh.blocks) {
    if (block.element->dim != mesh.dim) {
      throw InputError(fmt::format("has cells of {} dimensions ({}) in a space of {}",
                                   block.element->dim, block.element->name, mesh.dim),
                       where, "Shells and trusses are not supported: mesh a solid.");
    }
    for (std::int32_t node : block.nodes) {
      if (node < 0 || node >= mesh.node_count())
        throw InputError(fmt::format("has a cell with node {} of {}", node + 1, mesh.node_count()),
                         where, "Export the mesh again.");
    }
  }
}

void check_jacobians(const Mesh& mesh, const std::string& where, const CellWords& words) {
  int bad = 0, turned = 0;
  std::string first;
  for (Index b = 0; b < mesh.blocks.size(); ++b) {
    const CellBlock& block = mesh.blocks[b];
    const Element& element = *block.element;
    const Tabulation inside =
        tabulate(element, quadrature(element.shape, stiffness_degree(element)));
    const Quadrature at_nodes = {element.corners,
                                 std::vector(static_cast<Index>(element.nodes), 1.0)};
    const Tabulation nodal = tabulate(element, at_nodes);
    for (Index cell = 0; cell < static_cast<Index>(block.count()); ++cell) {
      const std::span<const std::int32_t> nodes = cell_nodes(block, cell);
      const double least =
          std::min(smallest_jacobian(mesh, nodes, nodal), smallest_jacobian(mesh, nodes, inside));
      const double rounding = rounding_of(mesh, nodes);
      if (least > rounding) continue;
      if (std::min(smallest_jacobian(mesh, nodes, nodal, -1.0),
                   smallest_jacobian(mesh, nodes, inside, -1.0)) > rounding)
        ++turned;
      if (bad++ == 0)
        first = fmt::format("{}{}{}, with a Jacobian of {:.3g} m^{}", cell_text(mesh, b, cell),
                            words ? ", " : "", words ? words(b, cell) : "", least, mesh.dim);
    }
  }
  if (bad == 0) return;
  const char* remedy = "Mesh it finer there, or optimise the mesh before the export.";
  if (bad == mesh.cell_count())
    remedy = turned == bad ? "All cells are: their nodes run the wrong way round; reverse the "
                             "surface or volume."
                           : "All cells are, and would be the other way round: their nodes are not "
                             "in the order that the file's format has for such cells.";
  throw InputError(fmt::format("has {} inverted or degenerate cells of {}, the first is {}", bad,
                               mesh.cell_count(), first),
                   where, remedy);
}

/// Length of the shortest edge at every node, between corners; infinity at nodes of no cell.
std::vector<double> shortest_edges(const Mesh& mesh) {
  std::vector<double> shortest(static_cast<Index>(mesh.node_count()),
                               std::numeric_limits<double>::infinity());
  for (const CellBlock& block : mesh.blocks) {
    for (Index cell = 0; cell < static_cast<Index>(block.count()); ++cell) {
      const std::span<const std::int32_t> nodes = cell_nodes(block, cell);
      const auto corners = static_cast<Index>(block.element->corner_count());
      double least = std::numeric_limits<double>::infinity();
      for (Index a = 0; a < corners; ++a)
        for (Index b = 0; b < a; ++b)
          least = std::min(
              least, distance(mesh, static_cast<Index>(nodes[a]), static_cast<Index>(nodes[b])));
      for (std::int32_t node : nodes) {
        double& kept = shortest[static_cast<Index>(node)];
        kept = std::min(kept, least);
      }
    }
  }
  return shortest;
}

void check_nodes(const Mesh& mesh, const std::string& where) {
  const std::vector<double> shortest = shortest_edges(mesh);
  double longest = 0.0;
  for (Index n = 0; n < shortest.size(); ++n) {
    if (std::isinf(shortest[n]))
      throw InputError(
          fmt::format("has a node of no cell: node {} at {}", n + 1, position(point(mesh, n))),
          where, "Remove it.");
    longest = std::max(longest, shortest[n]);
  }
  // Nodes at one place are neighbours along any line; along a skew one few others are.
  constexpr std::array<double, 3> skew = {1.0, 0.6180339887498949, 0.3028534321386899};
  std::vector<std::pair<double, Index>> along(shortest.size());
  for (Index n = 0; n < along.size(); ++n) {
    const std::span<const double> x = point(mesh, n);
    along[n] = {std::inner_product(x.begin(), x.end(), skew.begin(), 0.0), n};
  }
  std::sort(along.begin(), along.end());
  constexpr double share = 1e-6;
  for (Index i = 0; i < along.size(); ++i) {
    for (Index j = i + 1; j < along.size(); ++j) {
      if (along[j].first - along[i].first > 2.0 * share * longest) break;  // |skew| < 2
      const auto [a, b] = std::minmax(along[i].second, along[j].second);
      if (distance(mesh, a, b) > share * std::min(shortest[a], shortest[b])) continue;
      throw InputError(fmt::format("has nodes at one place: nodes {} and {} at {}", a + 1, b + 1,
                                   position(point(mesh, a))),
                       where,
                       "Merge them (Gmsh: `Coherence;` before meshing, or "
                       "Mesh.RemoveDuplicateNodes), or make two bodies of the two pieces.");
    }
  }
}

}  // namespace

std::string cell_text(const Mesh& mesh, std::size_t block, std::size_t cell) {
  const CellBlock& cells = mesh.blocks[block];
  std::vector<double> centre(static_cast<Index>(mesh.dim), 0.0);
  for (std::int32_t node : cell_nodes(cells, cell))
    for (Index d = 0; d < centre.size(); ++d)
      centre[d] += point(mesh, static_cast<Index>(node))[d] / cells.element->nodes;
  Index number = cell + 1;
  for (Index b = 0; b < block; ++b) number += static_cast<Index>(mesh.blocks[b].count());
  return fmt::format("cell {} ({} around {})", number, cells.element->name, position(centre));
}

void check_mesh(const Mesh& mesh, const std::string& where) { check_mesh(mesh, where, {}); }

void check_mesh(const Mesh& mesh, const std::string& where, const CellWords& words) {
  check_shape_of_arrays(mesh, where);
  check_jacobians(mesh, where, words);
  check_nodes(mesh, where);
}

}  // namespace abut
