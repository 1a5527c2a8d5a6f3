#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/element.hpp"

namespace abut {

/// Cells of one element type.
struct CellBlock {
  const Element* element = nullptr;
  std::vector<std::int32_t> nodes;  // (cells, element->nodes)
  std::string name;                 // of the group of cells in the file; empty: none
  // (cells, element->nodes) of cells that share their place with those of another body: how much
  // of the material is theirs, as means over their shape functions [M.114]; empty: all of it
  std::vector<double> shares;

  int count() const;
};

/// Nodes of one cell.
inline std::span<const std::int32_t> nodes_of(const CellBlock& cells, int cell) {
  const std::size_t n = index(cells.element->nodes);
  return std::span(cells.nodes).subspan(index(cell) * n, n);
}

/// Whether a cell has less than all of the material where it is.
inline bool is_shared(const CellBlock& cells, int cell) {
  const std::size_t n = index(cells.element->nodes);
  for (std::size_t a = 0; a < n && !cells.shares.empty(); ++a)
    if (cells.shares[index(cell) * n + a] != 1.0) return true;
  return false;
}

/// One facet of one cell.
struct Facet {
  std::int32_t block = 0, cell = 0, local = 0;  // local: index into Element::facets

  bool operator==(const Facet&) const = default;
};

/// Nodes, cells, and the named parts of the boundary on which loads, supports and ports lie. In the
/// reference configuration, SI units.
struct Mesh {
  int dim = 0;                 // 1, 2 or 3: of space and of the cells
  std::vector<double> points;  // [m] (nodes, dim)
  std::vector<CellBlock> blocks;
  std::map<std::string, std::vector<Facet>, std::less<>> sides;
  std::map<std::string, std::vector<std::int32_t>, std::less<>> node_sets;  // sorted, unique

  int node_count() const;
  int cell_count() const;
  /// Nodes of a side, sorted and unique; or of a node set of that name. Throws InputError that
  /// lists the names there are.
  std::vector<std::int32_t> nodes_of(const std::string& name) const;
  /// Throws InputError that lists the sides there are.
  const std::vector<Facet>& side(const std::string& name) const;
  std::vector<std::int32_t> nodes_of(const Facet& facet) const;  // in the facet element's order
};

/// Refuses what no analysis can run on: inverted or degenerate cells (Jacobian not positive beyond
/// rounding at a point of the stiffness rule or at a node), nodes of no cell, nodes at one place
/// (closer than 1e-6 of the shortest edge at them), cells of another dimension than the mesh.
/// Throws InputError with the number of the cell or node, counted from 1 as in the mesh's own
/// order, and its position. `where` names the mesh: a key or a file.
void check_mesh(const Mesh& mesh, const std::string& where);

/// A cell for people: "cell 7 (hex8 around (0.1, 0.2, 0) m)", counted as there.
std::string cell_text(const Mesh& mesh, std::size_t block, std::size_t cell);

}  // namespace abut
