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

template <class Visit>
void SkinSides::visit_facets(const Place& at, const Visit& visit) const {
  const auto is_here = [this](std::int32_t f, std::int32_t p) { return p < 0 || has(f, p); };
  for (const std::int32_t f : around(at.points[0]))
    if (is_here(f, at.points[1]) && is_here(f, at.points[2])) visit(f);
}

Vector SkinSides::normal_at(Points points, const Place& at) const {
  Vector sum = Vector::Zero();
  const bool by_angle = skin_.dim == 3 && at.count == 1;
  visit_facets(at, [&](std::int32_t f) {
    sum += (by_angle ? angle(points, f, at.points[0]) : 1.0) * facet_normal(points, f);
  });
  return unit(sum);
}

Vector SkinSides::point_normal(Points points, std::int32_t point) const {
  return normal_at(points, {1, {point, -1, -1}});
}

Vector SkinSides::edge_normal(Points points, std::int32_t one, std::int32_t other) const {
  return normal_at(points, {2, {one, other, -1}});
}

double SkinSides::fold(Points points, std::int32_t one, std::int32_t other) const {
  const Place edge{2, {one, other, -1}};
  const Vector normal = normal_at(points, edge);
  double least = 1.0;
  visit_facets(edge, [&](std::int32_t facet) {
    least = std::min(least, facet_normal(points, facet).dot(normal));
  });
  return least;
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
  found.normal = normal_at(points, at);
  found.border = ends_at(at);
  const double behind = -found.normal.dot(difference);
  const double least = found.border ? std::sqrt(0.5) * found.gap : 0.0;
  if (behind > least) found.gap = -found.gap;
  return found;
}

}  // namespace abut
