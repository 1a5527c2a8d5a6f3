#include "coordinator/passive/edge_row.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace abut {

std::optional<DistanceRow> edge_row(const SkinSides& sides, const EdgePoints& first,
                                    const EdgePoints& second,
                                    const std::vector<Eigen::Vector3d>& places) {
  const auto& [a, b] = first;
  const auto& [c, d] = second;
  DistanceRow row;
  row.features = {FeatureKind::edge_edge, {a, b, c, d}};
  const FeaturePoints x = abut::places(row.features, places);
  const FeatureDistance found = feature_distance(FeatureKind::edge_edge, 3, x);
  if (std::ranges::any_of(found.weights, [](double w) { return w == 0.0; })) return std::nullopt;
  const Eigen::Vector3d apart = sides.edge_normal(places, c, d) - sides.edge_normal(places, a, b);
  Eigen::Vector3d normal = (x[1] - x[0]).cross(x[3] - x[2]);
  if (!(normal.norm() > 0.0)) return std::nullopt;
  normal *= (normal.dot(apart) < 0.0 ? -1.0 : 1.0) / normal.norm();
  row.weights = found.weights;
  row.normal = normal;
  row.gap = normal.dot(found.difference(x));
  return row;
}

bool is_rim(const TouchingSurfaces& surfaces, const SkinSides& sides, const SkinTrees& trees,
            const std::vector<Eigen::Vector3d>& places, const EdgePoints& edge,
            const Eigen::Vector3d& at) {
  const std::int32_t facet = trees.closest_facet(surfaces.skin().group[index(edge[0])], places, at,
                                                 surfaces.shortest_edge());
  return facet >= 0 &&
         sides.facet_normal(places, facet).dot(sides.edge_normal(places, edge[0], edge[1])) <
             half_a_rim;
}

double gap_at(const DistanceRow& row, const std::vector<Eigen::Vector3d>& places) {
  const FeaturePoints x = abut::places(row.features, places);
  double gap = 0.0;
  for (std::size_t i = 0; i < 4; ++i) gap += row.weights[i] * row.normal.dot(x[i]);
  return gap;
}

bool can_press(const TouchingSurfaces& surfaces, const DistanceRow& row) {
  return std::ranges::any_of(row.features.points, [&surfaces](std::int32_t point) {
    return point >= 0 && !surfaces.stands(point);
  });
}

DistanceRow held_behind(const TouchingSurfaces& surfaces, DistanceRow row,
                        const std::vector<Eigen::Vector3d>& places) {
  const auto& p = row.features.points;
  row.friction = surfaces.holding(p[0], p[index(row.features.first_side())]);
  row.find_tangents(surfaces.skin().dim);
  row.behind = true;
  if (row.friction > 0.0) row.find_couples(surfaces.skin().dim, abut::places(row.features, places));
  return row;
}

}  // namespace abut
