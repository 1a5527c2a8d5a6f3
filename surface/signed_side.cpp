#include "surface/signed_side.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace abut {
namespace {

using Vector = Eigen::Vector3d;
using Points = std::span<const Vector>;

Vector unit(const Vector& v) {
  const double length = v.norm();
  return length > 0.0 ? Vector(v / length) : Vector::Zero();
}

}  // namespace

SkinSides::SkinSides(const Skin& skin) : skin_(skin), offsets_(skin.group.size() + 1, 0) {
  const std::size_t corners = index(skin.facet_points());
  for (const auto& facet : skin.facets)
    for (std::size_t i = 0; i < corners; ++i) ++offsets_[index(facet[i]) + 1];
  for (std::size_t p = 1; p < offsets_.size(); ++p) offsets_[p] += offsets_[p - 1];
  facets_.resize(index(offsets_.back()));
  std::vector<std::int32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t f = 0; f < skin.facets.size(); ++f)
    for (std::size_t i = 0; i < corners; ++i)
      facets_[index(next[index(skin.facets[f][i])]++)] = static_cast<std::int32_t>(f);
}

std::span<const std::int32_t> SkinSides::around(std::int32_t point) const {
  const std::int32_t begin = offsets_[index(point)], end = offsets_[index(point) + 1];
  return std::span(facets_).subspan(index(begin), index(end - begin));
}

bool SkinSides::has(std::int32_t facet, std::int32_t point) const {
  return std::ranges::find(skin_.facets[index(facet)], point) != skin_.facets[index(facet)].end();
}

SkinSides::Place SkinSides::place(std::int32_t facet, const std::array<double, 3>& shares) const {
  Place p;
  for (int i = 0; i < skin_.facet_points(); ++i)
    if (shares[i] != 0.0) p.points[p.count++] = skin_.facets[index(facet)][i];
  return p;
}

bool SkinSides::ends_at(const Place& at) const {
  if (at.count == skin_.facet_points()) return false;
  const std::span<const std::int32_t> fan = around(at.points[0]);
  if (skin_.dim == 2) return fan.size() < 2;
  // an edge that has one facet ends the surface
  const auto facets_at = [this, fan](std::int32_t other) {
    return std::ranges::count_if(fan, [this, other](std::int32_t f) { return has(f, other); });
  };
  if (at.count == 2) return facets_at(at.points[1]) < 2;
  return std::ranges::any_of(fan, [&](std::int32_t f) {
    return std::ranges::any_of(skin_.facets[index(f)],
                               [&](std::int32_t other) { return facets_at(other) < 2; });
  });
}

Vector SkinSides::facet_normal(Points points, std::int32_t facet) const {
  const auto& f = skin_.facets[index(facet)];
  const Vector u = points[index(f[1])] - points[index(f[0])];
  if (skin_.dim == 2) return unit({u.y(), -u.x(), 0.0});
  return unit(u.cross(points[index(f[2])] - points[index(f[0])]));
}

double SkinSides::angle(Points points, std::int32_t facet, std::int32_t point) const {
  const auto& f = skin_.facets[index(facet)];
  const int i = static_cast<int>(std::ranges::find(f, point) - f.begin());
  const Vector& x = points[index(point)];
  const Vector u = points[index(f[(i + 1) % 3])] - x, v = points[index(f[(i + 2) % 3])] - x;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

Vector SkinSides::normal_at(Points points, const Place& at, std::int32_t facet) const {
  if (at.count == skin_.facet_points()) return facet_normal(points, facet);
  Vector sum = Vector::Zero();
  for (const std::int32_t f : around(at.points[0])) {
    if (at.count == 2 && !has(f, at.points[1])) continue;
    const bool by_angle = skin_.dim == 3 && at.count == 1;
    sum += (by_angle ? angle(points, f, at.points[0]) : 1.0) * facet_normal(points, f);
  }
  return unit(sum);
}

Vector SkinSides::point_normal(Points points, std::int32_t point) const {
  const std::span<const std::int32_t> fan = around(point);
  if (fan.empty()) return Vector::Zero();
  return normal_at(points, {1, {point, -1, -1}}, fan.front());
}

Vector SkinSides::normal(Points points, std::int32_t facet,
                         const std::array<double, 3>& shares) const {
  return normal_at(points, place(facet, shares), facet);
}

SignedSide SkinSides::side(Points points, const Vector& x,
                           std::span<const std::int32_t> facets) const {
  SignedSide found;
  found.normal.setZero();
  Vector difference = Vector::Zero();
  for (const std::int32_t facet : facets) {
    const auto& f = skin_.facets[index(facet)];
    const FeaturePoints places{x, points[index(f[0])], points[index(f[1])],
                               f[2] < 0 ? Vector::Zero() : points[index(f[2])]};
    const FeatureDistance d = feature_distance(FeatureKind::node_facet, skin_.dim, places);
    if (found.facet >= 0 && !(d.distance < found.gap)) continue;
    found.facet = facet;
    found.gap = d.distance;
    found.weights = d.weights;
    difference = d.difference(places);
  }
  if (found.facet < 0) return found;
  const Place at = place(found.facet, {found.weights[1], found.weights[2], found.weights[3]});
  found.normal = normal_at(points, at, found.facet);
  found.border = ends_at(at);
  const double behind = -found.normal.dot(difference);
  const double least = found.border ? std::sqrt(0.5) * found.gap : 0.0;
  if (behind > least) found.gap = -found.gap;
  return found;
}

Vector SkinSides::touching_normal(Points points, const FeaturePair& pair) const {
  const FeatureDistance d = feature_distance(pair.kind, skin_.dim, places(pair, points));
  // A facet that has all the points of one side, and their shares of it.
  const auto surface_normal = [&](std::size_t begin, std::size_t end) -> Vector {
    Place at;
    for (std::size_t i = begin; i < end; ++i)
      if (pair.points[i] >= 0 && d.weights[i] != 0.0) at.points[at.count++] = pair.points[i];
    for (const std::int32_t f : around(at.points[0])) {
      const auto its = [this, f](std::int32_t p) { return p < 0 || has(f, p); };
      if (std::ranges::all_of(at.points, its)) return normal_at(points, at, f);
    }
    return Vector::Zero();
  };
  const std::size_t first = index(pair.first_side());
  const Vector second = surface_normal(first, 4);
  if (pair.kind == FeatureKind::node_facet) {
    const auto on =
        std::count_if(d.weights.begin() + 1, d.weights.end(), [](double w) { return w != 0.0; });
    if (on == skin_.facet_points()) return second;
    return unit(second - surface_normal(0, 1));
  }
  const Vector between = second - surface_normal(0, 2);
  const auto& p = pair.points;
  const Vector u = unit(points[index(p[1])] - points[index(p[0])]);
  const Vector v = unit(points[index(p[3])] - points[index(p[2])]), n = u.cross(v);
  const bool inside = std::ranges::all_of(d.weights, [](double w) { return w != 0.0; });
  // Less turned than this, round-off of the places turns the normal by more than a millionth.
  if (!inside || !(n.norm() > 1.0e-9)) return unit(between);
  return n.dot(between) < 0.0 ? -n.normalized() : n.normalized();
}

}  // namespace abut
