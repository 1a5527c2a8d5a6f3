#include "coordinator/passive/touching_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace abut {

namespace {

Eigen::Vector3d vector_at(const std::vector<double>& values, std::size_t point, int dim) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int i = 0; i < dim; ++i) out(i) = values[point * index(dim) + index(i)];
  return out;
}

/// Of all pairs, once or more, in an order that is that of no list of the scene: where impulses
/// are not unique, as at a corner that two joined bodies share, it chooses. What deforms comes
/// first, as it gives back what it takes; then names.
std::vector<Side> sides_by_name(std::span<const TouchingPair> pairs, const Bodies& bodies) {
  std::vector<Side> sides;
  for (const TouchingPair& pair : pairs)
    sides.insert(sides.end(), pair.sides.begin(), pair.sides.end());
  std::ranges::sort(sides, {}, [&bodies](const Side& side) {
    const bool rigid = !(bodies.port(side).geometry.transit > 0.0);
    return std::tuple(rigid, bodies.describe(side.body).name, bodies.port(side).name);
  });
  return sides;
}

}  // namespace

TouchingSurfaces::TouchingSurfaces(std::span<const TouchingPair> pairs, const Bodies& bodies)
    : bodies_(bodies) {
  if (!pairs.empty()) dim_ = bodies.port(pairs.front().sides[0]).geometry.dim;
  for (const Side& side : sides_by_name(pairs, bodies)) group_of(side, bodies);
  std::vector<std::array<int, 2>> groups;
  for (const TouchingPair& pair : pairs)
    groups.push_back({group_of(pair.sides[0], bodies), group_of(pair.sides[1], bodies)});
  std::vector<PosedSurface> surfaces;
  for (const Side& side : ports_) surfaces.push_back(posed(bodies.port(side).geometry));
  skin_ = skin_of(surfaces);
  skin_.dim = dim_;
  pair_friction_.assign(ports_.size() * ports_.size(), -1.0);
  pair_static_.assign(pair_friction_.size(), 0.0);
  pair_restitution_ = pair_static_;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::size_t one = index(groups[k][0]), other = index(groups[k][1]);
    for (const std::size_t place : {one * ports_.size() + other, other * ports_.size() + one}) {
      pair_friction_[place] = pairs[k].friction;
      pair_static_[place] = pairs[k].holding;
      pair_restitution_[place] = pairs[k].restitution;
    }
  }
  find_shortest_edge(bodies);
}

/// Of a port; it is added when it is asked for first.
int TouchingSurfaces::group_of(const Side& side, const Bodies& bodies) {
  for (std::size_t g = 0; g < ports_.size(); ++g)
    if (ports_[g].body == side.body && ports_[g].port == side.port) return static_cast<int>(g);
  const int group = static_cast<int>(ports_.size());
  ports_.push_back(side);
  const PortGeometry& geometry = bodies.port(side).geometry;
  const bool stands = std::isinf(bodies.describe(side.body).mass);
  for (int p = 0; p < geometry.count(); ++p) {
    points_.push_back({side.body, side.port, p});
    reference_.push_back(vector_at(geometry.points, index(p), dim_));
    stands_.push_back(stands ? 1 : 0);
  }
  return group;
}

void TouchingSurfaces::find_shortest_edge(const Bodies& bodies) {
  double soft = std::numeric_limits<double>::infinity(), any = soft;
  const auto see = [&](std::int32_t a, std::int32_t b) {
    const double length = (reference_[a] - reference_[b]).norm();
    any = std::min(any, length);
    if (bodies.port({points_[a].body, points_[a].port, 0}).geometry.spacing > 0.0)
      soft = std::min(soft, length);
  };
  for (const auto& edge : skin_.edges) see(edge[0], edge[1]);
  if (dim_ == 2)
    for (const auto& facet : skin_.facets) see(facet[0], facet[1]);
  for (const Side& side : ports_) {
    const double spacing = bodies.port(side).geometry.spacing;
    if (dim_ == 1 && spacing > 0.0) soft = std::min(soft, spacing);
  }
  shortest_edge_ = std::isfinite(soft) ? soft : std::isfinite(any) ? any : 0.0;
}

void TouchingSurfaces::move(std::span<const PassiveReply> replies,
                            std::span<const Eigen::Vector3d> from,
                            std::vector<Eigen::Vector3d>& to) const {
  to.resize(points_.size());
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Point& at = points_[k];
    const PassiveReply::Port& port = replies[index(at.body)].ports[index(at.port)];
    to[k] = from[k] + vector_at(port.displacement, index(at.point), dim_);
  }
}

void TouchingSurfaces::place(std::span<const Response> responses,
                             std::vector<Eigen::Vector3d>& places) const {
  places.resize(points_.size());
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Point& at = points_[k];
    const Waveform& trace = responses[index(at.body)].ports[index(at.port)].trace;
    const std::size_t values = trace.u.size() - index(trace.width);
    places[k] = reference_[k] + vector_at(trace.u, values / index(dim_) + index(at.point), dim_);
  }
}

void TouchingSurfaces::place(std::span<const Response> responses, std::size_t instant,
                             std::vector<Eigen::Vector3d>& places) const {
  places.resize(points_.size());
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Point& at = points_[k];
    const Waveform& trace = responses[index(at.body)].ports[index(at.port)].trace;
    const std::size_t before = instant * index(trace.width) / index(dim_);
    places[k] = reference_[k] + vector_at(trace.u, before + index(at.point), dim_);
  }
}

void TouchingSurfaces::place_within(std::span<const Response> responses, double part,
                                    std::vector<Eigen::Vector3d>& places) const {
  std::vector<std::vector<double>> moved(ports_.size());
  for (std::size_t g = 0; g < ports_.size(); ++g) {
    const Waveform& trace = responses[index(ports_[g].body)].ports[index(ports_[g].port)].trace;
    const double begin = trace.time.front(), end = trace.time.back();
    moved[g].resize(index(trace.width));
    trace.interpolate(trace.u, std::min(end, begin + part * (end - begin)), moved[g]);
  }
  places.resize(points_.size());
  for (std::size_t k = 0; k < points_.size(); ++k)
    places[k] =
        reference_[k] + vector_at(moved[index(skin_.group[k])], index(points_[k].point), dim_);
}

double TouchingSurfaces::longest_way(std::span<const Response> responses) const {
  double longest = 0.0;
  for (const Side& side : ports_) {
    const Waveform& trace = responses[index(side.body)].ports[index(side.port)].trace;
    const std::size_t width = index(trace.width), dim = index(dim_);
    for (std::size_t v = width; v + dim <= trace.u.size(); v += dim) {
      double square = 0.0;
      for (std::size_t d = 0; d < dim; ++d) {
        const double way = trace.u[v + d] - trace.u[(v + d) % width];
        square += way * way;
      }
      longest = std::max(longest, square);
    }
  }
  return std::sqrt(longest);
}

FeatureChoice TouchingSurfaces::choice() const {
  FeatureChoice choice;
  for (int a = 0; a < groups(); ++a)
    for (int b = 0; b < groups(); ++b) choice.allowed.push_back(touch(a, b) ? 1 : 0);
  choice.prescribed = stands_;
  return choice;
}

}  // namespace abut
