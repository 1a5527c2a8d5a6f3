#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace abut {

/// Which points of a surface are near others, counted by facets between them: neighbours share one.
class PointRings {
 public:
  /// `facets`, `offsets`: connectivity as that of a PortGeometry. `among`: ascending, the points
  /// that are numbered from 0 on and alone count; empty: all of them.
  PointRings(int points, std::span<const std::int32_t> facets,
             std::span<const std::int32_t> offsets, std::span<const std::int32_t> among = {});

  int count() const { return static_cast<int>(first_.size()) - 1; }
  /// Points no more than so many facets from a point, with itself, ascending; good until the next
  /// call.
  std::span<const std::int32_t> around(std::int32_t point, int rings);
  /// (points) colours from 0 on, such that nothing lies within `rings` of two of one colour.
  std::vector<int> colours(int rings);

 private:
  std::vector<std::int32_t> first_, neighbours_;  // (points + 1); by point
  std::vector<std::int32_t> found_, seen_;        // seen_: (points) the call that saw it
  std::int32_t call_ = 0;
};

}  // namespace abut
