#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/posed_surface.hpp"
#include "surface/sharp_nodes.hpp"

namespace abut {

/// A sharp edge with the two facets beside it, in the plane a corner; and, where it ends at a
/// corner of three edges or more, with all facets and edges there.
struct Wedge : SharpEdge {
  std::vector<std::int32_t> planes;                // these facets, ascending
  std::vector<std::int32_t> nodes;                 // of them, ascending
  std::vector<std::array<std::int32_t, 2>> edges;  // their ends; the first is its own
  std::array<std::int32_t, 2> beyond = {-1, -1};   // next nodes where it goes straight on; -1: not
};

/// The wedges of a surface, found as it is at first: deformed, it keeps its edges.
class Wedges {
 public:
  Wedges() = default;
  explicit Wedges(const PosedSurface& surface);
  bool any() const { return !all_.empty(); }
  int count() const { return static_cast<int>(all_.size()); }
  const Wedge& operator[](std::int32_t wedge) const { return all_[wedge]; }
  /// Those that a facet touches with a node, and those that its neighbours touch, ascending.
  std::span<const std::int32_t> at(int facet) const { return at_.of(facet); }
  std::span<const std::int32_t> around(int facet) const { return around_.of(facet); }

 private:
  struct Lists {  // (facets)
    std::vector<std::int32_t> numbers, offsets = {0};

    std::span<const std::int32_t> of(int facet) const {
      const std::size_t begin = index(offsets[facet]);
      return std::span(numbers).subspan(begin, index(offsets[index(facet) + 1]) - begin);
    }
    void add(std::vector<std::int32_t> list);
  };
  std::vector<Wedge> all_;
  Lists at_, around_;
};

}  // namespace abut
