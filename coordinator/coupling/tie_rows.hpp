#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "contract/port.hpp"
#include "surface/sparse_rows.hpp"

namespace abut {

/// Rows in which the motions of two joined surfaces are compared: each sums up to 1 over the nodes
/// of either side, so that a force of a row acts on both alike.
struct TieRows {
  int dim = 1;
  std::array<SparseRows, 2> of;     // by side: over its nodes
  std::array<SparseRows, 2> force;  // the same, where a force of a row acts: of ties as `of`
  std::vector<double> area;         // [m^(dim-1)] (rows) of the joint
  double apart = 0.0;               // [m] between the surfaces, at the place where it is most
  std::vector<double> place;        // [m] (dim) there
  int count() const { return of[0].count(); }
  int width() const { return count() * dim; }
  /// out += factor x forces [N] (rows, dim) of those rows that act on a side, at its nodes.
  void press(int side, double factor, std::span<const double> forces, std::span<double> out) const {
    add_transposed(force[side], dim, factor, forces, out);
  }
};

/// Of the reference configuration: the dual mortar rows of one side, 0 or 1  [M.108]; of second
/// order, where the other side deforms, those of its corners  [M.118]; where its facets are facets
/// of the other side as well, a row for each node and its twin. In one dimension one row of two
/// points. No rows: the surfaces do not face each other.
TieRows make_tie_rows(const PortGeometry& one, const PortGeometry& other, int side);

/// Of bodies that overlap, whose ports tell where the other one's side is inside them: rows of both
/// sides, each against the inside of the other body  [M.113].
TieRows make_overlap_rows(const PortGeometry& one, const PortGeometry& other);

}  // namespace abut
