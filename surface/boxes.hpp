#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// An axis-parallel box. Boxes that touch overlap.
struct Box {
  std::array<double, 3> low, high;  // [m]

  bool operator==(const Box&) const = default;
};

inline bool overlap(const Box& a, const Box& b) {
  return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] &&
         b.low[1] <= a.high[1] && a.low[2] <= b.high[2] && b.low[2] <= a.high[2];
}

/// [m] the sum of a box's sides.
inline double size(const Box& box) {
  return (box.high[0] - box.low[0]) + (box.high[1] - box.low[1]) + (box.high[2] - box.low[2]);
}

/// The box of a facet, larger by `margin` [m] on every side.
Box facet_box(const PosedSurface& surface, int facet, double margin);

/// A binary tree of boxes over the facets of a surface, or over other boxes by their numbers. Its
/// structure is made once and kept while the surface moves; only the boxes follow. Nodes lie in
/// preorder: the first child follows its parent, so a pass from the end meets children before
/// parents.
struct BoxTree {
  std::vector<Box> boxes;            // (2 m - 1)
  std::vector<std::int32_t> second;  // (2 m - 1) the second child; of a leaf -1 - its facet

  bool empty() const { return boxes.empty(); }
  bool is_leaf(int node) const { return second[node] < 0; }
  int facet(int leaf) const { return -1 - second[leaf]; }
};

/// Structure and boxes of a tree: facets halved across the longest side of their centres' box.
void build(BoxTree& tree, const PosedSurface& surface, double margin);

/// The boxes renewed for another pose of the surface that the tree was built for. Allocates
/// nothing.
void refit(BoxTree& tree, const PosedSurface& surface, double margin);

/// The same over two poses: every box holds its facet on straight ways from one to the other.
void refit(BoxTree& tree, const PosedSurface& from, const PosedSurface& to, double margin);

/// The same over given boxes, of which a tree's facets are the numbers: structure and boxes, or
/// boxes alone.
void build(BoxTree& tree, std::span<const Box> leaves);
void refit(BoxTree& tree, std::span<const Box> leaves);

struct FacetPair {
  std::int32_t k = 0, n = 0;  // facets of the first and of the second surface

  auto operator<=>(const FacetPair&) const = default;
};

/// All pairs of facets whose boxes overlap, ordered by first, then second facet. What `pairs` held
/// is dropped, its memory is used again.
void overlapping_pairs(const BoxTree& first, const BoxTree& second, std::vector<FacetPair>& pairs);

}  // namespace abut
