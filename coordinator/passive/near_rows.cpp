#include "coordinator/passive/near_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "surface/feature_path.hpp"

namespace abut {

namespace {

/// Rows are made of what is nearer than so many thicknesses.
constexpr double near_thicknesses = 1.5;
/// On its way a pair keeps so much of its distance, or of the thickness where it has more: a step
/// that takes more is not accepted. Of pairs that have used up most of the thickness nearly all:
/// what is left would shrink from step to step without end.
constexpr double kept = 0.3, kept_when_close = 0.9, close = 0.1;
/// Conservative advancement comes as near as this share of the distance it looks for.
constexpr double resolved = 0.02;
/// An edge whose closest point is an end: a row of a node and a facet says the same.
constexpr double at_end = 1.0e-7;
/// Rows along one normal whose weights differ by less say the same.
constexpr double same_normal = 1.0e-8, same_weights = 1.0e-3;
/// Sine of an angle to a surface's normals: a way between closest points that leaves them by more
/// is none of theirs. Below are the tilts of faces that lie on each other and of their facets.
constexpr double steep = 0.1;

FeaturePoints at(const FeaturePair& pair, const NearRows::Places& from, const NearRows::Places& to,
                 double part) {
  FeaturePoints out;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int32_t p = pair.points[i];
    out[i] = p < 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(from[p] + part * (to[p] - from[p]));
  }
  return out;
}

bool share_a_point(const FeaturePair& pair) {
  const auto first = pair.points.begin() + pair.first_side();
  return std::any_of(pair.points.begin(), first, [&](std::int32_t point) {
    return std::find(first, pair.points.end(), point) != pair.points.end();
  });
}

}  // namespace

NearRows::NearRows(const TouchingSurfaces& surfaces, double thickness)
    : surfaces_(surfaces),
      thickness_(thickness),
      trees_(surfaces.skin(), surfaces.reference()),
      surroundings_(surfaces.skin()),
      own_(surfaces, thickness),
      behind_(surfaces, thickness, own_.others()),
      crossing_(surfaces, thickness, own_.others()),
      ends_(surfaces, thickness) {}

bool NearRows::leaves_out(const FeaturePair& pair, const Places& from) const {
  return own_.leaves_out(pair) || crossing_.holds(pair) || behind_.leaves_out(trees_, pair, from);
}

void NearRows::find(const Places& from, std::vector<DistanceRow>& rows) {
  const int dim = surfaces_.skin().dim;
  name(rows);
  const double reach = near_thicknesses * thickness_;
  near_features(trees_, from, from, reach, own_.choice(trees_, from, from, reach), pairs_);
  for (const FeaturePair& pair : pairs_) {
    if (leaves_out(pair, from)) continue;
    if (feature_distance(pair.kind, dim, places(pair, from)).distance < reach)
      add_if_closest(pair, from, from, 0.0, rows);
  }
  behind_.find(trees_, from, rows);
  crossing_.find(from, rows);
  ends_.find(from, reach, rows);
}

void NearRows::find_on_ways(const Places& from, const Places& to, std::vector<DistanceRow>& rows) {
  const int dim = surfaces_.skin().dim;
  name(rows);
  near_features(trees_, from, to, thickness_, own_.choice(trees_, from, to, thickness_), pairs_);
  for (const FeaturePair& pair : pairs_) {
    if (leaves_out(pair, from)) continue;
    const FeaturePoints before = places(pair, from), after = at(pair, from, to, 1.0);
    if (feature_distance(pair.kind, dim, before).distance <= thickness_) continue;
    const double part =
        first_time_within(pair.kind, dim, before, after, thickness_, resolved * thickness_);
    if (part < 1.0) add_if_closest(pair, from, to, part, rows);
  }
  ends_.find_on_ways(from, to, rows);
}

NearRows::Crossed NearRows::check(const Places& from, const Places& to,
                                  std::vector<DistanceRow>& rows) {
  const int dim = surfaces_.skin().dim;
  name(rows);
  Crossed crossed;
  near_features(trees_, from, to, thickness_, own_.choice(trees_, from, to, thickness_), pairs_);
  for (const FeaturePair& pair : pairs_) {
    if (leaves_out(pair, from)) continue;
    const FeaturePoints before = places(pair, from), after = at(pair, from, to, 1.0);
    const double kept = least(feature_distance(pair.kind, dim, before).distance);
    const double part = first_time_within(pair.kind, dim, before, after, kept, resolved * kept);
    if (part >= 1.0 || passes_beside(pair, from, to, part)) continue;
    ++crossed.pairs;
    if (add(pair, from, to, part, rows)) ++crossed.added;
  }
  const int deeper = behind_.check(trees_, from, to, rows) + crossing_.check(from, to, rows);
  const EndRows::Crossed ends = ends_.check(from, to, rows);
  crossed.pairs += deeper + ends.pairs;
  crossed.added += deeper + ends.added;
  return crossed;
}

/// [m] that is left of a pair's distance after its step.
double NearRows::least(double distance) const {
  const double share = distance < close * thickness_ ? kept_when_close : kept;
  return share * std::min(distance, thickness_);
}

/// A corner that slides along a side past the end of that side comes as near to the facet behind
/// the end as it is to the side. What is behind a surface, or on it, is kept there by its own row,
/// but for edges with an end behind that pass outside of a rim.
bool NearRows::passes_beside(const FeaturePair& pair, const Places& from, const Places& to,
                             double part) {
  const int dim = surfaces_.skin().dim;
  if (pair.kind == FeatureKind::edge_edge && behind_.holds(pair)) return false;
  const FeaturePoints x = at(pair, from, to, part);
  const FeatureDistance found = feature_distance(pair.kind, dim, x);
  if (!(found.distance > 0.0)) return false;
  const Eigen::Vector3d way = found.difference(x) / found.distance;
  const PartOfWay then{from, to, part};
  if (!surroundings_.goes_nearer(pair, found.weights, 0, way, steep, then) &&
      !surroundings_.goes_nearer(pair, found.weights, 1, way, steep, then))
    return false;
  const FeaturePoints before = places(pair, from), after = at(pair, from, to, 1.0);
  double nearest = feature_distance(pair.kind, dim, before).distance;
  bool held_beside = false;
  surroundings_.visit_around(pair, [&](const FeaturePair& other) {
    if (share_a_point(other) || own_.leaves_out(other)) return;
    const double distance = feature_distance(other.kind, dim, places(other, from)).distance;
    if (distance >= nearest) return;
    if (behind_.holds(other))
      held_beside = true;
    else
      nearest = distance;
  });
  if (held_beside) {
    behind_.let_beside(pair);
    return true;
  }
  const double kept = least(nearest);
  return first_time_within(pair.kind, dim, before, after, kept, resolved * kept) >= 1.0;
}

void NearRows::add_if_closest(const FeaturePair& pair, const Places& from, const Places& to,
                              double part, std::vector<DistanceRow>& rows) {
  const FeaturePoints x = at(pair, from, to, part);
  const FeatureDistance found = feature_distance(pair.kind, surfaces_.skin().dim, x);
  if (!(found.distance > 0.0)) return;
  const Eigen::Vector3d way = found.difference(x) / found.distance;
  const PartOfWay places{from, to, part};
  for (const int side : {1, 0})
    if (surroundings_.goes_nearer(pair, found.weights, side, way, steep, places)) return;
  add(pair, from, to, part, rows);
}

bool NearRows::add(const FeaturePair& pair, const Places& from, const Places& to, double part,
                   std::vector<DistanceRow>& rows) {
  const int dim = surfaces_.skin().dim;
  const FeaturePoints x = at(pair, from, to, part), x0 = places(pair, from);
  const FeatureDistance found = feature_distance(pair.kind, dim, x);
  if (!(found.distance > 0.0)) return false;
  DistanceRow row;
  row.features = pair;
  row.weights = found.weights;
  if (pair.kind == FeatureKind::edge_edge &&
      std::ranges::any_of(row.weights, [](double w) { return std::abs(w) < at_end; }))
    return false;
  row.normal = found.difference(x) / found.distance;
  for (std::size_t i = 0; i < 4; ++i) row.gap += row.weights[i] * row.normal.dot(x0[i]);
  row.friction = surfaces_.holding(pair.points[0], pair.points[index(pair.first_side())]);
  row.find_tangents(dim);
  if (known(row, rows)) return false;
  named_.emplace(row.key(), rows.size());
  rows.push_back(row);
  return true;
}

bool NearRows::known(const DistanceRow& row, const std::vector<DistanceRow>& rows) const {
  const auto [first, last] = named_.equal_range(row.key());
  return std::any_of(first, last, [&](const auto& named) {
    const DistanceRow& other = rows[named.second];
    if (other.normal.dot(row.normal) < 1.0 - same_normal) return false;
    double apart = 0.0;
    if (other.features.points == row.features.points)
      for (std::size_t i = 0; i < 4; ++i)
        apart = std::max(apart, std::abs(other.weights[i] - row.weights[i]));
    return apart < same_weights;
  });
}

/// Of all rows of the step, so that those that say the same are found without a look at the others.
void NearRows::name(const std::vector<DistanceRow>& rows) {
  named_.clear();
  for (std::size_t k = 0; k < rows.size(); ++k) named_.emplace(rows[k].key(), k);
}

}  // namespace abut
