#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// A place in a lattice of cells, in halves of a cell: even numbers are corners, odd ones lie
/// between. The fourth number counts layers around the lattice's surface (O-grids).
struct LatticePoint {
  std::array<int, 4> at{};

  auto operator<=>(const LatticePoint&) const = default;
};

/// Builds a mesh out of lattice cells: numbers nodes as cells ask for them, puts nodes between
/// corners exactly where the mapping wants them, and splits cells into simplices.
class LatticeMesh {
 public:
  /// Where a place of the lattice lies [m]; only the first dim numbers are used.
  using Mapping = std::function<std::array<double, 3>(const LatticePoint&)>;
  using Predicate = std::function<bool(const LatticePoint&)>;

  LatticeMesh(const Element& element, Mapping mapping);

  /// Adds the line, quadrilateral or hexahedron with these corners in the element order of bar2,
  /// quad4 or hex8. A simplex element gets the cell split: all facets are cut from their smallest
  /// corner, so that neighbours fit whatever their orientation (Dompierre et al., How to subdivide
  /// pyramids, prisms and hexahedra into tetrahedra, 1999).
  void add_cell(std::span<const LatticePoint> corners);

  /// Names the facets of the boundary all of whose nodes lie in a set of places. After all cells.
  void name_side(const std::string& name, const Predicate& contains);
  /// Names the nodes in a set of places; no set when there are none.
  void name_nodes(const std::string& name, const Predicate& contains);
  /// The mesh, with its whole boundary as side `boundary`.
  Mesh finish();

 private:
  std::int32_t node(const LatticePoint& point);
  void add_element(std::span<const LatticePoint> corners);
  void split(const Element& whole, std::span<const LatticePoint> corners);
  const std::vector<Facet>& boundary();

  const Element& element_;
  Mapping mapping_;
  Mesh mesh_;
  std::vector<LatticePoint> places_;  // (nodes)
  std::unordered_map<std::uint64_t, std::int32_t> numbers_;
};

/// Numbers of lattice cells in a direction that LatticePoint can hold.
inline constexpr int most_lattice_cells = 30000;

/// The 2^dim corners of the lattice cell whose lowest corner is `lowest`, in the element order.
std::vector<LatticePoint> cell_corners(int dim, const LatticePoint& lowest);

}  // namespace abut
