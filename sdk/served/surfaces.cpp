#include "sdk/served/surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace abut {

namespace {

using Place = std::array<double, 3>;
using Corners = std::span<const std::int32_t>;

/// VTK's numbers of a point, a line, a triangle, a quadrilateral, by their points.
constexpr std::array<int, 5> kind_of_facet{0, 1, 3, 5, 9};

Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Place cross_of(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot_of(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length_of(const Place& a) { return std::sqrt(dot_of(a, a)); }

/// A surface as points in space and lists of corners.
struct Seen {
  explicit Seen(const PortGeometry& surface) : dim(surface.dim) {
    for (int p = 0; p < surface.count(); ++p) {
      points.push_back({});
      for (int i = 0; i < dim; ++i)
        points.back()[index(i)] = surface.points[index(p) * index(dim) + index(i)];
    }
    for (std::size_t f = 0; f + 1 < surface.offsets.size(); ++f)
      facets.push_back(Corners(surface.facets)
                           .subspan(index(surface.offsets[f]),
                                    index(surface.offsets[f + 1] - surface.offsets[f])));
  }
  const Place& at(std::int32_t point) const { return points[index(point)]; }

  /// Of a facet: outward, as long as the facet is large.
  Place facing(Corners facet) const {
    const Place& first = at(facet[0]);
    if (dim == 2) {
      const Place along = minus(at(facet[1]), first);
      return {along[1], -along[0], 0.0};
    }
    if (facet.size() == 3) return cross_of(minus(at(facet[1]), first), minus(at(facet[2]), first));
    return cross_of(minus(at(facet[2]), first), minus(at(facet[3]), at(facet[1])));
  }
  /// Directed edges; in the plane the facets themselves.
  std::vector<std::pair<int, int>> edges() const {
    std::vector<std::pair<int, int>> all;
    for (const Corners facet : facets)
      for (std::size_t c = 0; c + (dim == 2 ? 1 : 0) < facet.size(); ++c)
        all.emplace_back(facet[c], facet[(c + 1) % facet.size()]);
    return all;
  }
  /// Whether facets enclose a body: every edge (in the plane every point) has two sides.
  bool closed() const {
    std::vector<std::pair<int, int>> there = edges(), back;
    for (const auto& [a, b] : there) back.emplace_back(b, a);
    if (dim == 2)  // as many begin at a point as end there
      for (std::size_t e = 0; e < there.size(); ++e)
        there[e].second = there[e].first, back[e].second = back[e].first;
    std::ranges::sort(there);
    std::ranges::sort(back);
    return there == back;
  }
  /// Of closed facets: a multiple of the area or volume inside.
  double enclosed() const {
    Place middle{};
    for (const Place& point : points)
      for (std::size_t i = 0; i < 3; ++i) middle[i] += point[i] / double(points.size());
    double sum = 0.0;
    for (const Corners facet : facets) {
      Place centre{};
      for (const std::int32_t corner : facet)
        for (std::size_t i = 0; i < 3; ++i) centre[i] += at(corner)[i] / double(facet.size());
      sum += dot_of(minus(centre, middle), facing(facet));
    }
    return sum;
  }

  int dim;
  std::vector<Place> points;
  std::vector<Corners> facets;
};

void require_facets(const Seen& seen) {
  if (seen.dim != 2 && seen.dim != 3)
    throw InputError(fmt::format("is for bodies of {} dimensions", seen.dim), "",
                     "Set dim to 2 or 3 first; a body in one dimension has a point.");
  const std::size_t least = index(seen.dim), most = seen.dim == 2 ? 2 : 4;
  for (const Corners facet : seen.facets) {
    const std::set<int> corners(facet.begin(), facet.end());
    const bool some = corners.size() == facet.size() && facet.size() >= least &&
                      facet.size() <= most && *corners.begin() >= 0 &&
                      *corners.rbegin() < static_cast<int>(seen.points.size());
    if (!some)
      throw InputError(fmt::format("facet [{}] is none of {} points", fmt::join(facet, ", "),
                                   seen.points.size()),
                       "",
                       fmt::format("A facet in {} dimensions lists {} points.", seen.dim,
                                   seen.dim == 2 ? "2" : "3 or 4"));
  }
  if (seen.closed() && seen.enclosed() < 0.0)
    throw InputError("facets look into the body", "",
                     "Turn their order of points around: the body lies to the left in the plane, "
                     "points turn counterclockwise from outside in space.");
}

}  // namespace

void complete_surface(PortGeometry& surface) {
  const Seen seen(surface);
  require_facets(seen);
  std::vector<Place> normals(seen.points.size(), Place{});
  for (const Corners facet : seen.facets)
    for (const std::int32_t corner : facet)
      for (std::size_t i = 0; i < 3; ++i) normals[index(corner)][i] += seen.facing(facet)[i];
  surface.normals.clear();
  for (std::size_t p = 0; p < normals.size(); ++p) {
    const double length = length_of(normals[p]);
    if (!(length > 0.0))
      throw InputError(fmt::format("point {} has no normal", p), "",
                       "Every point belongs to a facet that has a size.");
    for (int i = 0; i < seen.dim; ++i) surface.normals.push_back(normals[p][index(i)] / length);
  }
  double edges = 0.0;
  for (const auto& [a, b] : seen.edges()) edges += length_of(minus(seen.at(b), seen.at(a)));
  surface.spacing = edges / double(seen.edges().size());
}

std::vector<double> in_space(std::span<const double> values, int dim) {
  std::vector<double> all;
  for (std::size_t v = 0; v < values.size(); v += index(dim))
    for (int i = 0; i < 3; ++i) all.push_back(i < dim ? values[v + index(i)] : 0.0);
  return all;
}

Grid surfaces_of(std::span<const Port> ports) {
  Grid grid;
  grid.offsets.push_back(0);
  for (const Port& port : ports) {
    const auto first = static_cast<std::int32_t>(grid.nodes());
    const std::vector<double> points = in_space(port.geometry.points, port.geometry.dim);
    grid.points.insert(grid.points.end(), points.begin(), points.end());
    const auto add = [&grid, first](Corners facet) {
      grid.types.push_back(kind_of_facet[facet.size()]);
      for (const std::int32_t corner : facet) grid.connectivity.push_back(first + corner);
      grid.offsets.push_back(static_cast<std::int32_t>(grid.connectivity.size()));
    };
    const std::int32_t alone = 0;
    const Seen seen(port.geometry);
    for (const Corners facet : seen.facets) add(facet);
    if (seen.facets.empty()) add(Corners(&alone, 1));
  }
  return grid;
}

}  // namespace abut
