#include "surface/boxes.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "base/assert.hpp"

namespace abut {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Box nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

Box united(const Box& a, const Box& b) {
  Box box;
  for (int d = 0; d < 3; ++d) {
    box.low[d] = std::min(a.low[d], b.low[d]);
    box.high[d] = std::max(a.high[d], b.high[d]);
  }
  return box;
}

template <int dim>
void include_facet(Box& box, const PosedSurface& surface, int facet) {
  for (std::int32_t node : surface.nodes(facet)) {
    const double* x = surface.points.data() + static_cast<std::ptrdiff_t>(dim) * node;
    for (int d = 0; d < dim; ++d) {
      box.low[d] = std::min(box.low[d], x[d]);
      box.high[d] = std::max(box.high[d], x[d]);
    }
  }
}

Box hull(const PosedSurface& surface, int facet) {
  Box box = nothing;
  if (surface.dim == 3) {
    include_facet<3>(box, surface, facet);
  } else {
    include_facet<2>(box, surface, facet);
    box.low[2] = box.high[2] = 0.0;
  }
  return box;
}

Box grown(Box box, double margin) {
  for (int d = 0; d < 3; ++d) {
    box.low[d] -= margin;
    box.high[d] += margin;
  }
  return box;
}

/// Renews all boxes; `leaf_box` gives that of a facet.
template <typename LeafBox>
void refit_by(BoxTree& tree, const LeafBox& leaf_box) {
  for (std::size_t i = tree.boxes.size(); i-- > 0;) {
    const std::int32_t second = tree.second[i];
    tree.boxes[i] = second < 0
                        ? leaf_box(-1 - second)
                        : united(tree.boxes[i + 1], tree.boxes[static_cast<std::size_t>(second)]);
  }
}

class Builder {
 public:
  Builder(BoxTree& tree, const PosedSurface& surface) : tree_(tree) {
    const int count = surface.facet_count();
    tree_.second.clear();
    tree_.second.reserve(static_cast<std::size_t>(std::max(0, 2 * count - 1)));
    for (int f = 0; f < count; ++f) centres_.push_back(centre(corners(surface, f)));
    std::vector<std::int32_t> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    if (count > 0) add(order);
  }

 private:
  /// Halves in numbers, so the depth is that of the logarithm however facets are crowded.
  void add(std::span<std::int32_t> facets) {
    const std::size_t here = tree_.second.size();
    tree_.second.push_back(-1 - facets.front());
    if (facets.size() == 1) return;
    const int axis = longest_side(facets);
    const std::size_t half = facets.size() / 2;
    std::nth_element(facets.begin(), facets.begin() + half, facets.end(),
                     [this, axis](std::int32_t a, std::int32_t b) {
                       const double x = centres_[a][axis], y = centres_[b][axis];
                       return x < y || (x == y && a < b);
                     });
    add(facets.first(half));
    tree_.second[here] = static_cast<std::int32_t>(tree_.second.size());
    add(facets.subspan(half));
  }

  int longest_side(std::span<const std::int32_t> facets) const {
    Eigen::Vector3d low = centres_[facets.front()], high = low;
    for (std::int32_t f : facets) {
      low = low.cwiseMin(centres_[f]);
      high = high.cwiseMax(centres_[f]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    return axis;
  }

  BoxTree& tree_;
  std::vector<Eigen::Vector3d> centres_;
};

double size(const Box& box) {
  return (box.high[0] - box.low[0]) + (box.high[1] - box.low[1]) + (box.high[2] - box.low[2]);
}

}  // namespace

Box facet_box(const PosedSurface& surface, int facet, double margin) {
  return grown(hull(surface, facet), margin);
}

void build(BoxTree& tree, const PosedSurface& surface, double margin) {
  Builder(tree, surface);
  tree.boxes.resize(tree.second.size());
  refit(tree, surface, margin);
}

void refit(BoxTree& tree, const PosedSurface& surface, double margin) {
  refit_by(tree, [&surface, margin](int facet) { return facet_box(surface, facet, margin); });
}

void refit(BoxTree& tree, const PosedSurface& from, const PosedSurface& to, double margin) {
  refit_by(tree, [&from, &to, margin](int facet) {
    return grown(united(hull(from, facet), hull(to, facet)), margin);
  });
}

void overlapping_pairs(const BoxTree& first, const BoxTree& second, std::vector<FacetPair>& pairs) {
  pairs.clear();
  if (first.empty() || second.empty()) return;
  // Each step goes one level down in one tree and leaves one node more behind; a tree of less than
  // 2^31 facets has at most 31 levels.
  constexpr int capacity = 80;
  std::array<FacetPair, capacity> stack;
  int count = 0;
  stack[count++] = {0, 0};
  while (count > 0) {
    const auto [a, b] = stack[--count];
    const Box& box_a = first.boxes[a];
    const Box& box_b = second.boxes[b];
    if (!overlap(box_a, box_b)) continue;
    const bool leaf_a = first.is_leaf(a), leaf_b = second.is_leaf(b);
    if (leaf_a && leaf_b) {
      pairs.push_back({first.facet(a), second.facet(b)});
      continue;
    }
    ABUT_ASSERT(count + 2 <= capacity);
    if (leaf_b || (!leaf_a && size(box_a) >= size(box_b))) {
      stack[count++] = {first.second[a], b};
      stack[count++] = {a + 1, b};
    } else {
      stack[count++] = {a, second.second[b]};
      stack[count++] = {a, b + 1};
    }
  }
  const auto key = [](const FacetPair& pair) {  // two comparisons in one
    return static_cast<std::uint64_t>(pair.k) << 32 | static_cast<std::uint32_t>(pair.n);
  };
  std::sort(pairs.begin(), pairs.end(),
            [&key](const FacetPair& a, const FacetPair& b) { return key(a) < key(b); });
}

}  // namespace abut
