#include "surface/boxes.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "base/index.hpp"
#include "surface/box_pairs.hpp"

namespace abut {
namespace {

Box united(const Box& a, const Box& b) {
  Box box;
  for (int d = 0; d < 3; ++d) {
    box.low[d] = std::min(a.low[d], b.low[d]);
    box.high[d] = std::max(a.high[d], b.high[d]);
  }
  return box;
}

/// All in registers, margin included: a box that is stored coordinate by coordinate and loaded as a
/// whole costs more than its extrema.
template <int dim>
inline Box hull(const PosedSurface& surface, int facet, double margin) {
  const std::span<const std::int32_t> nodes = surface.nodes(facet);
  const double* points = surface.points.data();
  const double* x = points + static_cast<std::ptrdiff_t>(dim) * nodes[0];
  double low0 = x[0], low1 = x[1], low2 = dim == 3 ? x[2] : 0.0;
  double high0 = low0, high1 = low1, high2 = low2;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    x = points + static_cast<std::ptrdiff_t>(dim) * nodes[i];
    low0 = std::min(low0, x[0]);
    high0 = std::max(high0, x[0]);
    low1 = std::min(low1, x[1]);
    high1 = std::max(high1, x[1]);
    if (dim == 2) continue;
    low2 = std::min(low2, x[2]);
    high2 = std::max(high2, x[2]);
  }
  return {{low0 - margin, low1 - margin, low2 - margin},
          {high0 + margin, high1 + margin, high2 + margin}};
}

/// Renews all boxes; `leaf_box` gives that of a facet.
template <typename LeafBox>
void refit_by(BoxTree& tree, const LeafBox& leaf_box) {
  for (std::size_t i = tree.boxes.size(); i-- > 0;) {
    const std::int32_t second = tree.second[i];
    tree.boxes[i] =
        second < 0 ? leaf_box(-1 - second) : united(tree.boxes[i + 1], tree.boxes[second]);
  }
}

class Builder {
 public:
  Builder(BoxTree& tree, std::span<const Eigen::Vector3d> centres)
      : tree_(tree), centres_(centres) {
    tree_.second.clear();
    if (centres.empty()) return;
    tree_.second.reserve(2 * centres.size() - 1);
    std::vector<std::int32_t> order(centres.size());
    std::iota(order.begin(), order.end(), 0);
    add(order);
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
  std::span<const Eigen::Vector3d> centres_;
};

}  // namespace

Box facet_box(const PosedSurface& surface, int facet, double margin) {
  return surface.dim == 3 ? hull<3>(surface, facet, margin) : hull<2>(surface, facet, margin);
}

void build(BoxTree& tree, const PosedSurface& surface, double margin) {
  std::vector<Eigen::Vector3d> centres;
  for (int f = 0; f < surface.facet_count(); ++f) centres.push_back(centre(corners(surface, f)));
  Builder(tree, centres);
  tree.boxes.resize(tree.second.size());
  refit(tree, surface, margin);
}

void build(BoxTree& tree, std::span<const Box> leaves) {
  std::vector<Eigen::Vector3d> centres;
  for (const Box& box : leaves)
    centres.push_back(0.5 * (Eigen::Vector3d(box.low.data()) + Eigen::Vector3d(box.high.data())));
  Builder(tree, centres);
  tree.boxes.resize(tree.second.size());
  refit(tree, leaves);
}

void refit(BoxTree& tree, const PosedSurface& surface, double margin) {
  if (surface.dim == 3)
    refit_by(tree, [&surface, margin](int facet) { return hull<3>(surface, facet, margin); });
  else
    refit_by(tree, [&surface, margin](int facet) { return hull<2>(surface, facet, margin); });
}

void refit(BoxTree& tree, const PosedSurface& from, const PosedSurface& to, double margin) {
  refit_by(tree, [&from, &to, margin](int facet) {
    return united(facet_box(from, facet, margin), facet_box(to, facet, margin));
  });
}

void refit(BoxTree& tree, std::span<const Box> leaves) {
  refit_by(tree, [leaves](int leaf) { return leaves[leaf]; });
}

void overlapping_pairs(const BoxTree& first, const BoxTree& second, std::vector<FacetPair>& pairs) {
  pairs.clear();
  visit_pairs(first, second, [](const Box& a, const Box& b) { return overlap(a, b); },
              [&pairs](std::int32_t k, std::int32_t n) { pairs.push_back({k, n}); });
  const auto key = [](const FacetPair& pair) {  // two comparisons in one
    return static_cast<std::uint64_t>(pair.k) << 32 | static_cast<std::uint32_t>(pair.n);
  };
  std::sort(pairs.begin(), pairs.end(),
            [&key](const FacetPair& a, const FacetPair& b) { return key(a) < key(b); });
}

}  // namespace abut
