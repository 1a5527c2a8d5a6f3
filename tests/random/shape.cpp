#include "tests/random/shape.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace abut {

namespace {

using Facet = std::vector<int>;

/// Facets of a cell by its corners, as they look outwards.
std::vector<Facet> facets_of(const std::string& element) {
  if (element.starts_with("tri")) return {{0, 1}, {1, 2}, {2, 0}};
  if (element == "quad4") return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  if (element.starts_with("tet")) return {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}};
  return {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {0, 3, 2, 1}, {4, 5, 6, 7}};
}

}  // namespace

std::vector<std::array<int, 2>> edges_of(const std::string& element) {
  if (element == "bar2") return {{0, 1}};
  if (element.starts_with("tri")) return {{0, 1}, {1, 2}, {2, 0}};
  if (element == "quad4") return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  if (element.starts_with("tet")) return {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}};
  return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
          {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
}

std::vector<Facet> Shape::outside() const {
  std::map<Facet, int> seen;
  std::vector<Facet> all;
  for (const std::vector<int>& cell : cells)
    for (Facet facet : facets_of(element)) {
      for (int& node : facet) node = cell[node];
      all.push_back(facet);
      std::ranges::sort(facet);
      ++seen[facet];
    }
  std::erase_if(all, [&seen](Facet facet) {
    std::ranges::sort(facet);
    return seen[facet] > 1;
  });
  return all;
}

bool Shape::is_cut(const Facet& facet) const {
  return std::ranges::any_of(cuts, [&](const auto& cut) {
    return std::ranges::find(cut.second, facet) != cut.second.end();
  });
}

double Shape::shortest_edge() const {
  double out = std::numeric_limits<double>::infinity();
  for (const std::vector<int>& cell : cells)
    for (const auto& [a, b] : edges_of(element))
      out = std::min(out, (points[cell[a]] - points[cell[b]]).norm());
  return out;
}

double Shape::size() const {
  Eigen::Vector3d low = points[0], high = points[0];
  for (const Eigen::Vector3d& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return (high - low).maxCoeff();
}

std::vector<Facet> Shape::bottom() const {
  double low = points[0](1), high = low;
  for (const Eigen::Vector3d& x : points) {
    low = std::min(low, x(1));
    high = std::max(high, x(1));
  }
  std::vector<Facet> out = outside();
  std::erase_if(out, [&](const Facet& facet) {
    return std::ranges::any_of(facet,
                               [&](int n) { return points[n](1) > low + 0.1 * (high - low); }) ||
           is_cut(facet);
  });
  return out;
}

}  // namespace abut
