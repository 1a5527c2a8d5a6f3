#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "contract/port.hpp"
#include "surface/boxes.hpp"
#include "surface/divided_surface.hpp"
#include "surface/mortar.hpp"

namespace abut {

/// [m] How near nodes are that have a foot inside of a facet of another surface; infinity: none is.
struct EdgesNear {
  static constexpr double none = std::numeric_limits<double>::infinity();
  double sharp = none;    // at sharp edges
  double leaning = none;  // of these, where neither facet beside lies along the other surface
  double bent = none;     // where the surface turns like an edge

  bool any() const { return sharp < none || bent < none; }
};

/// A surface whose nodes may have the rows of a contact, because it has sharp edges, or turns so
/// much over a facet of the other side that this one sees an edge: averaged over facets around an
/// edge, rows of the other side's nodes would let it through, and press before a round one touches
/// [M.93]. Its facets are divided to about the size of the other's.
class EdgedSurface {
 public:
  /// `size` [m] of facets that it is divided to; `seen_by` [m]: facets that meet it, 0: edges alone
  /// count.
  EdgedSurface(const PortGeometry& surface, double size, double seen_by);
  /// It has sharp edges, or turns like them.
  bool any() const { return !sharp_.empty() || !bent_.empty(); }

  /// What of it lies over another surface, no farther from it than `reach` [m]; `tree` holds that
  /// one's boxes. `pose`: [m] (points, dim) of this surface.
  EdgesNear near(std::span<const double> pose, const PosedSurface& other, const BoxTree& tree,
                 double reach);
  /// Rows of this surface's nodes against the other's facets, told as those of the other: T over
  /// its nodes, P over the points of this surface, normals out of this surface. `way`: [m] that the
  /// two go in the substep. `drops`: of a facet of the other surface and one of this, whether these
  /// have no rows.
  using Drops = std::function<bool(const FacetPair&)>;
  void join(std::span<const double> pose, const PosedSurface& other, const BoxTree& tree,
            double way, const Drops& drops, SurfaceRows& rows);

 private:
  PosedSurface pose_of(std::span<const double> pose);

  DividedSurface divided_;
  std::vector<std::pair<std::int32_t, std::int32_t>> sharp_;  // nodes with facets beside, ascending
  std::vector<std::int32_t> bent_;                            // other nodes
  std::vector<double> points_;                                // [m] (nodes, dim)
  double longest_ = 0.0;                                      // [m] edge
  std::int32_t parts_ = 1;                                    // of a facet
  BoxTree tree_;
  std::vector<FacetPair> pairs_;
  MortarOptions options_;
  MortarBuffers buffers_;
  RowSum sum_;
  SparseRows mapped_;
};

}  // namespace abut
