#include "surface/whole_rows.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <map>

#include "base/index.hpp"
#include "surface/mortar_merge.hpp"
#include "surface/mortar_pieces.hpp"
#include "surface/overlap_points.hpp"
#include "surface/whole_facet.hpp"

namespace abut {
namespace {

/// Integrals of a row, not yet divided by its weight.
struct Sum {
  double weight = 0.0;
  std::map<std::int32_t, double> k, n;

  void add(const Sum& other) {
    weight += other.weight;
    for (const auto& [node, value] : other.k) k[node] += value;
    for (const auto& [node, value] : other.n) n[node] += value;
  }
};

/// What two straight facets have in common, for the corners of K's whole one.
struct Integrals {
  Shape4 weight = Shape4::Zero();
  Eigen::Matrix<double, 4, 8> k = Eigen::Matrix<double, 4, 8>::Zero(), n = k;
};

/// A straight facet as a part of a whole one.
struct Part {
  WholeFacet whole;
  std::array<Eigen::Vector2d, 4> places;  // of its corners in the whole one
  int corners = 0;

  Part(const AuxiliaryPlane& plane, const WholeSurface& surface, int facet)
      : whole(plane, surface.straight, surface.facet(surface.of[facet])) {
    const std::span<const std::int32_t> all = surface.facet(surface.of[facet]);
    for (const std::int32_t node : surface.straight.nodes(facet)) {
      const auto at = std::ranges::find(all, node) - all.begin();
      places[corners++] = whole.kind.place(static_cast<int>(at));
    }
  }
  Eigen::Vector2d find(const OverlapPoint& point, const Shape4& shape) const {
    Eigen::Vector2d guess = Eigen::Vector2d::Zero();
    for (int i = 0; i < corners; ++i) guess += shape[i] * places[i];
    return whole.find(point.z, guess);
  }
};

Integrals integrals_of(const std::vector<OverlapPoint>& points, const Part& k, const Part& n) {
  Integrals sum;
  Shape8 at_k, at_n;
  Slopes8 slopes;
  for (const OverlapPoint& point : points) {
    const Eigen::Vector2d in_k = k.find(point, point.at_k);
    k.whole.kind.evaluate(in_k, at_k, slopes);
    n.whole.kind.evaluate(n.find(point, point.at_n), at_n, slopes);
    const Shape4 share = point.weight * k.whole.kind.hats(in_k);
    sum.weight += share;
    sum.k += share * at_k.transpose();
    sum.n += share * at_n.transpose();
  }
  return sum;
}

void scatter(const Integrals& part, std::span<const std::int32_t> k,
             std::span<const std::int32_t> n, int corners, std::vector<Sum>& sums) {
  for (int i = 0; i < corners; ++i) {
    Sum& sum = sums[k[index(i)]];
    sum.weight += part.weight[i];
    for (std::size_t a = 0; a < k.size(); ++a)
      sum.k[k[a]] += part.k(i, static_cast<Eigen::Index>(a));
    for (std::size_t b = 0; b < n.size(); ++b)
      sum.n[n[b]] += part.n(i, static_cast<Eigen::Index>(b));
  }
}

/// Rows of little support join a neighbour's, as those of contact do; whatever their gaps are,
/// which make no difference to what is joined for good.
void merge(const WholeSurface& k, const std::vector<char>& covered, double share,
           std::vector<Sum>& sums) {
  const CornerFacets corners(k);
  const PosedSurface surface = corners.surface(k.straight);
  MortarPieces pieces;
  for (int f = 0; f < k.count(); ++f)
    if (covered[f]) pieces.facets.emplace_back().facet = f;
  std::vector<double> weight, full;
  for (const Sum& sum : sums) weight.push_back(sum.weight);
  tributary_weights(surface, full);
  const std::vector<double> gap(weight.size(), 0.0);
  MergeBuffers buffers;
  std::vector<std::int32_t> root;
  merged_rows(surface, pieces, weight, full, gap, share, 1.0, buffers, root);
  for (std::size_t j = 0; j < sums.size(); ++j) {
    if (root[j] < 0 || index(root[j]) == j) continue;
    sums[root[j]].add(sums[j]);
    sums[j] = {};
  }
}

void flush(const std::map<std::int32_t, double>& sum, double weight, SparseRows& rows) {
  for (const auto& [node, value] : sum) {
    rows.columns.push_back(node);
    rows.values.push_back(value / weight);
  }
  rows.end_row();
}

Eigen::Vector3d mean(const SparseRows& rows, int row, const PosedSurface& surface) {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::int32_t e = rows.offsets[row]; e < rows.offsets[index(row) + 1]; ++e)
    x += rows.values[e] * surface.point(rows.columns[e]);
  return x;
}

}  // namespace

CornerFacets::CornerFacets(const WholeSurface& surface) {
  for (int f = 0; f < surface.count(); ++f) {
    const std::span<const std::int32_t> nodes = surface.facet(f);
    const int corners = FacetKind(surface.straight.dim, nodes.size()).corners;
    facets.insert(facets.end(), nodes.begin(), nodes.begin() + corners);
    offsets.push_back(static_cast<std::int32_t>(facets.size()));
  }
}

PosedSurface CornerFacets::surface(const PosedSurface& straight) const {
  return {straight.dim, straight.points, facets, offsets, straight.round};
}

void whole_rows(const WholeSurface& k, const WholeSurface& n, std::span<const FacetPair> pairs,
                const MortarOptions& options, SurfaceRows& rows) {
  std::vector<Sum> sums(index(k.straight.node_count()));
  std::vector<char> covered(index(k.count()), 0);
  std::vector<OverlapPoint> points;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    const std::int32_t own = pairs[begin].k;
    const GroundFacet ground(corners(k.straight, own), k.straight.round);
    const Part own_part(ground.plane, k, own);
    for (end = begin; end < pairs.size() && pairs[end].k == own; ++end) {
      const Corners partner = corners(n.straight, pairs[end].n);
      if (!(mean_normal(partner).dot(ground.plane.normal) <= -options.facing)) continue;
      overlap_points(ground, partner, options.reach, points);
      if (points.empty()) continue;
      const Integrals part = integrals_of(points, own_part, Part(ground.plane, n, pairs[end].n));
      covered[k.of[index(own)]] = 1;
      scatter(part, k.facet(k.of[own]), n.facet(n.of[pairs[end].n]),
              own_part.whole.kind.corners, sums);
    }
  }
  merge(k, covered, options.merge, sums);
  rows.clear();
  rows.dim = k.straight.dim;
  for (std::size_t j = 0; j < sums.size(); ++j) {
    if (!(sums[j].weight > 0.0)) continue;
    rows.nodes.push_back(static_cast<std::int32_t>(j));
    rows.weights.push_back(sums[j].weight);
    flush(sums[j].k, sums[j].weight, rows.k);
    flush(sums[j].n, sums[j].weight, rows.n);
    const int row = rows.count() - 1;
    rows.gaps.push_back((mean(rows.k, row, k.straight) - mean(rows.n, row, n.straight)).norm());
  }
}

}  // namespace abut
