#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

// Thin bodies that lie on each other: far sides of both look at each other, too, each behind the
// other by as much as both bodies are thick, though neither body is in the other one. Contact has
// no rows there.

/// What of a surface is nearest to a place.
struct NearestPoint {
  static constexpr int none = -1, unknown = -2;
  int facet = unknown;
  Eigen::Vector3d point;  // [m] on that facet
};

/// Whether a place of one body, behind a facet of `other`, sees that facet through `other`: what is
/// nearest of `other` lies between them, and the place is not in it. `tree` holds the boxes of
/// `other` in this pose; `depth` [m]: what is less far behind is not looked at.
[[nodiscard]] bool sees_through(const Eigen::Vector3d& place, const PosedSurface& other,
                                const BoxTree& tree, int facet, double depth);

/// Whether the middle of the pair's facet of K is that far behind its facet of N [m].
bool is_behind(const PosedSurface& k, const PosedSurface& n, const FacetPair& pair, double depth);

/// Pairs of facets of which the middle of one sees the other one through its body, in poses in
/// which bodies touch or overlap a little, as at the begin of a step.
class FarSides {
 public:
  /// Leaves them out of pairs, which ascend. `depth` [m]: facets whose middles are less far behind
  /// each other are not looked at.
  void leave_out(const PosedSurface& k, const PosedSurface& n, double depth,
                 std::vector<FacetPair>& pairs);
  /// None is.
  void forget() { dropped_.clear(); }
  /// Whether the pair was left out then.
  bool drops(const FacetPair& pair) const { return std::ranges::binary_search(dropped_, pair); }

 private:
  std::vector<FacetPair> dropped_;  // ascending, as pairs are
  BoxTree k_tree_, n_tree_;
  std::vector<NearestPoint> of_k_, of_n_;  // what is nearest to the middle of a facet, once asked
};

}  // namespace abut
