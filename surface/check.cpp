#include "surface/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <vector>

#include "base/index.hpp"

namespace abut {
namespace {

/// Far below any cell that a solver survives, far above what round-off leaves of three points on a
/// line (some 1e-16).
constexpr double least_area = 1.0e-12;
/// Cosine of the angle between the normals of two halves, 150 degrees.
constexpr double on_each_other = -0.87;

/// The defect of the surface's arrays as such, before facets can be read.
std::optional<UnsoundSurface> check_arrays(const PosedSurface& s) {
  if (s.dim != 2 && s.dim != 3) return UnsoundSurface{SurfaceDefect::dimension};
  if (s.points.size() % index(s.dim) != 0) return UnsoundSurface{SurfaceDefect::points};
  if (s.offsets.empty() && s.facets.empty()) return std::nullopt;
  if (s.offsets.empty() || s.offsets.front() != 0 ||
      s.offsets.back() != static_cast<std::ptrdiff_t>(s.facets.size()))
    return UnsoundSurface{SurfaceDefect::offsets};
  for (int f = 0; f < s.facet_count(); ++f)
    if (s.offsets[f + 1] < s.offsets[f]) return UnsoundSurface{SurfaceDefect::offsets, f};
  return std::nullopt;
}

std::optional<SurfaceDefect> check_nodes(const PosedSurface& s, int facet) {
  const std::span<const std::int32_t> nodes = s.nodes(facet);
  const bool fits = s.dim == 2 ? nodes.size() == 2 : nodes.size() == 3 || nodes.size() == 4;
  if (!fits) return SurfaceDefect::node_count;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 0 || nodes[i] >= s.node_count()) return SurfaceDefect::missing_node;
    if (std::find(nodes.begin(), nodes.begin() + i, nodes[i]) != nodes.begin() + i)
      return SurfaceDefect::repeated_node;
  }
  for (std::int32_t node : nodes)
    if (!s.point(node).allFinite()) return SurfaceDefect::not_finite;
  return std::nullopt;
}

double longest_edge_squared(const Corners& c) {
  double longest = 0.0;
  for (int i = 0; i < c.count; ++i)
    longest = std::max(longest, (c.x[(i + 1) % c.count] - c.x[i]).squaredNorm());
  return longest;
}

struct ReflexCorners {
  int count = 0, last = -1;
};

/// Of a quadrilateral in its mean plane.
ReflexCorners reflex_corners(const Corners& c, double longest) {
  ReflexCorners found;
  const Eigen::Vector3d n = mean_normal(c);
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d before = c.x[i] - c.x[(i + 3) % 4], after = c.x[(i + 1) % 4] - c.x[i];
    if (before.cross(after).dot(n) > least_area * longest) continue;
    ++found.count;
    found.last = i;
  }
  return found;
}

/// The first corner of the diagonal, 0 or 1, along which a quadrilateral's halves turn less against
/// each other; -1: they lie on each other either way, as a bow does.
int less_folded(const Corners& c) {
  std::array<double, 2> cosine{};
  for (const int i : {0, 1}) {
    const auto at = [&](int k) { return c.x[index((i + k) % 4)]; };
    const Eigen::Vector3d one = (at(1) - at(0)).cross(at(2) - at(0));
    const Eigen::Vector3d other = (at(2) - at(0)).cross(at(3) - at(0));
    cosine[index(i)] = one.normalized().dot(other.normalized());
  }
  if (std::max(cosine[0], cosine[1]) < on_each_other) return -1;
  return cosine[1] > cosine[0] ? 1 : 0;
}

std::optional<SurfaceDefect> check_shape(const Corners& c) {
  const double longest = longest_edge_squared(c);
  if (c.count == 2) return longest > 0.0 ? std::nullopt : std::optional(SurfaceDefect::no_area);
  if (!(area(c) > least_area * longest)) return SurfaceDefect::no_area;
  if (c.count == 4 && reflex_corners(c, longest).count > 0) return SurfaceDefect::folded;
  return std::nullopt;
}

/// One facet's way along an edge, nodes ascending; in the plane an edge is a node, and the way is
/// from it or to it.
struct CheckedEdge {
  std::int32_t a, b, facet;
  bool forward;

  bool same_edge(const CheckedEdge& other) const { return a == other.a && b == other.b; }
};

/// Neighbours that look to one side run along their edge in opposite ways. Where more than two
/// meet, at cells that have nothing but an edge in common, as many run either way.
std::optional<UnsoundSurface> check_orientation(const PosedSurface& s) {
  std::vector<CheckedEdge> edges;
  for (std::int32_t f = 0; f < s.facet_count(); ++f) {
    const std::span<const std::int32_t> nodes = s.nodes(f);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::int32_t a = nodes[i], b = s.dim == 2 ? a : nodes[(i + 1) % nodes.size()];
      edges.push_back({std::min(a, b), std::max(a, b), f, s.dim == 2 ? i == 0 : a < b});
    }
  }
  std::ranges::sort(edges, {}, [](const CheckedEdge& e) { return std::tuple(e.a, e.b, e.facet); });
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    int ways = 0;
    for (end = begin; end < edges.size() && edges[end].same_edge(edges[begin]); ++end)
      ways += edges[end].forward ? 1 : -1;
    if (std::abs(ways) > 1) return UnsoundSurface{SurfaceDefect::turned, edges[end - 1].facet};
  }
  return std::nullopt;
}

const char* words_of(SurfaceDefect defect) {
  switch (defect) {
    case SurfaceDefect::dimension:
      return "is neither in the plane nor in space";
    case SurfaceDefect::points:
      return "has no whole number of points";
    case SurfaceDefect::offsets:
      return "has offsets that do not grow from 0 to the list's end";
    case SurfaceDefect::node_count:
      return "has a wrong number of nodes";
    case SurfaceDefect::missing_node:
      return "has a node that is not there";
    case SurfaceDefect::repeated_node:
      return "has a node twice";
    case SurfaceDefect::not_finite:
      return "has a node whose coordinates are not finite";
    case SurfaceDefect::no_area:
      return "has no area";
    case SurfaceDefect::folded:
      return "is not convex";
    case SurfaceDefect::turned:
      return "looks the other way than its neighbour";
  }
  return "";
}

}  // namespace

std::optional<UnsoundSurface> check(const PosedSurface& surface) {
  if (const std::optional<UnsoundSurface> unsound = check_arrays(surface)) return unsound;
  for (int f = 0; f < surface.facet_count(); ++f) {
    std::optional<SurfaceDefect> defect = check_nodes(surface, f);
    if (!defect) defect = check_shape(corners(surface, f));
    if (defect) return UnsoundSurface{*defect, f};
  }
  return check_orientation(surface);
}

std::optional<std::array<std::array<int, 3>, 2>> unfolding(const Corners& c) {
  if (c.count != 4) return std::nullopt;
  const ReflexCorners found = reflex_corners(c, longest_edge_squared(c));
  if (found.count == 0) return std::nullopt;
  const int i = found.count == 1 ? found.last : less_folded(c);
  if (i < 0) return std::nullopt;
  const int next = (i + 1) % 4, opposite = (i + 2) % 4, before = (i + 3) % 4;
  return {{{{i, next, opposite}, {i, opposite, before}}}};
}

std::string words(const UnsoundSurface& unsound) {
  const std::string who =
      unsound.facet < 0 ? "the surface" : "facet " + std::to_string(unsound.facet);
  return who + " " + words_of(unsound.defect);
}

}  // namespace abut
