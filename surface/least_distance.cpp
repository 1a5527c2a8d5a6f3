#include "surface/least_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/assert.hpp"

namespace abut {
namespace {

double boxes_apart(const Box& a, const Box& b) {
  double square = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double apart = std::max({0.0, a.low[i] - b.high[i], b.low[i] - a.high[i]});
    square += apart * apart;
  }
  return std::sqrt(square);
}

/// [m] by which b lies beyond a along a unit vector.
double beyond(const Corners& a, const Corners& b, const Eigen::Vector3d& axis) {
  double high = axis.dot(a.x[0]), low = axis.dot(b.x[0]);
  for (int i = 1; i < a.count; ++i) high = std::max(high, axis.dot(a.x[i]));
  for (int i = 1; i < b.count; ++i) low = std::min(low, axis.dot(b.x[i]));
  return low - high;
}

double extent(const Box& box) {
  return (box.high[0] - box.low[0]) + (box.high[1] - box.low[1]) + (box.high[2] - box.low[2]);
}

struct Pair {
  std::int32_t a = 0, b = 0;
  double apart = 0.0;  // [m] their boxes
};

}  // namespace

double facets_apart(const Corners& a, const Corners& b) {
  double apart = std::max({0.0, beyond(a, b, mean_normal(a)), beyond(b, a, mean_normal(b))});
  const Eigen::Vector3d line = centre(b) - centre(a);
  const double length = line.norm();
  if (length > 0.0) apart = std::max(apart, beyond(a, b, line / length));
  return apart;
}

double least_distance(const PosedSurface& a, const BoxTree& tree_a, const PosedSurface& b,
                      const BoxTree& tree_b) {
  double least = std::numeric_limits<double>::infinity();
  if (tree_a.empty() || tree_b.empty()) return least;
  constexpr int capacity = 80;  // as in overlapping_pairs
  std::array<Pair, capacity> stack;
  int count = 0;
  const auto pair = [&](std::int32_t i, std::int32_t j) {
    return Pair{i, j, boxes_apart(tree_a.boxes[i], tree_b.boxes[j])};
  };
  stack[count++] = pair(0, 0);
  while (count > 0 && least > 0.0) {
    const Pair at = stack[--count];
    if (at.apart >= least) continue;
    const bool leaf_a = tree_a.is_leaf(at.a), leaf_b = tree_b.is_leaf(at.b);
    if (leaf_a && leaf_b) {
      const double facets =
          facets_apart(corners(a, tree_a.facet(at.a)), corners(b, tree_b.facet(at.b)));
      least = std::min(least, std::max(at.apart, facets));
      continue;
    }
    const bool split_a = leaf_b || (!leaf_a && extent(tree_a.boxes[at.a]) >=
                                                   extent(tree_b.boxes[at.b]));
    Pair near = split_a ? pair(at.a + 1, at.b) : pair(at.a, at.b + 1);
    Pair far =
        split_a ? pair(tree_a.second[at.a], at.b) : pair(at.a, tree_b.second[at.b]);
    if (far.apart < near.apart) std::swap(near, far);
    ABUT_ASSERT(count + 2 <= capacity);
    stack[count++] = far;
    stack[count++] = near;
  }
  return least;
}

}  // namespace abut
