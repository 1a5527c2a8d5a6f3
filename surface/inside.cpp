#include "surface/inside.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/assert.hpp"

namespace abut {

namespace {

/// Two rays in no direction that meshes have: what one of them finds by grazing an edge, the other
/// does not.
std::array<Eigen::Vector3d, 2> directions(int dim) {
  if (dim == 2) return {{{0.8191520, 0.5735764, 0.0}, {-0.3583679, 0.9335804, 0.0}}};
  return {{{0.5773215, 0.6137941, 0.5385237}, {-0.4712389, 0.3314159, 0.8173645}}};
}

bool meets(const Box& box, const Eigen::Vector3d& x, const Eigen::Vector3d& ray, int dim) {
  double from = 0.0, to = std::numeric_limits<double>::infinity();
  for (int i = 0; i < dim; ++i) {  // no component of a ray is zero
    const double a = (box.low[i] - x[i]) / ray[i], b = (box.high[i] - x[i]) / ray[i];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  constexpr double rounding = 1.0e-9;  // of the way: a box is never missed
  return from <= to + rounding * std::abs(to);
}

double area_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool meets_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& ray) {
  const double side_a = area_of(ray, a), side_b = area_of(ray, b);
  if ((side_a > 0.0) == (side_b > 0.0)) return false;
  return ray.dot(a + (b - a) * (side_a / (side_a - side_b))) > 0.0;
}

/// Signs are those of the edges, which neighbours see alike: no ray slips through between two.
bool meets_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    const Eigen::Vector3d& ray) {
  const double u = ray.dot(a.cross(b)), v = ray.dot(b.cross(c)), w = ray.dot(c.cross(a));
  if ((u > 0.0) != (v > 0.0) || (v > 0.0) != (w > 0.0)) return false;
  const double along = u + v + w;
  return along != 0.0 && a.dot((b - a).cross(c - a)) / along > 0.0;
}

int crossings(Corners facet, const Eigen::Vector3d& x, const Eigen::Vector3d& ray) {
  for (int i = 0; i < facet.count; ++i) facet.x[i] -= x;
  const auto& [a, b, c, d] = facet.x;
  if (facet.count == 2) return meets_segment(a, b, ray) ? 1 : 0;
  const int first = meets_triangle(a, b, c, ray) ? 1 : 0;
  return facet.count == 3 ? first : first + (meets_triangle(a, c, d, ray) ? 1 : 0);
}

int crossings(const PosedSurface& surface, const BoxTree& tree, const Eigen::Vector3d& x,
              const Eigen::Vector3d& ray) {
  constexpr int capacity = 64;  // a tree of less than 2^31 facets has at most 31 levels
  std::array<int, capacity> stack;
  int count = 0, found = 0;
  if (!tree.empty()) stack[count++] = 0;
  while (count > 0) {
    const int at = stack[--count];
    if (!meets(tree.boxes[at], x, ray, surface.dim)) continue;
    if (tree.is_leaf(at)) {
      found += crossings(corners(surface, tree.facet(at)), x, ray);
      continue;
    }
    ABUT_ASSERT(count + 2 <= capacity);
    stack[count++] = tree.second[at];
    stack[count++] = at + 1;
  }
  return found;
}

}  // namespace

bool is_closed(const PosedSurface& surface) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;  // in the plane: nodes
  for (int f = 0; f < surface.facet_count(); ++f) {
    const std::span<const std::int32_t> nodes = surface.nodes(f);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::int32_t next = surface.dim == 2 ? nodes[i] : nodes[(i + 1) % nodes.size()];
      edges.push_back(std::minmax(nodes[i], next));
    }
  }
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size(); i += 2)
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
  return !edges.empty();
}

bool inside(const PosedSurface& surface, const BoxTree& tree, const Eigen::Vector3d& x) {
  return std::ranges::all_of(directions(surface.dim), [&](const Eigen::Vector3d& ray) {
    return crossings(surface, tree, x, ray) % 2 == 1;
  });
}

}  // namespace abut
