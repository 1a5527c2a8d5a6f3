#include "surface/overlap_points.hpp"

#include <cmath>
#include <numbers>

namespace abut {
namespace {

/// Gauss's points of [-1, 1] and their weights: degree 11 on segments, 10 on triangles that are
/// squares with one side drawn together.
struct Gauss {
  double at, weight;
};
constexpr Gauss six[] = {{-0.9324695142031520278, 0.1713244923791703450},
                         {-0.6612093864662645137, 0.3607615730481386076},
                         {-0.2386191860831969086, 0.4679139345726910474},
                         {0.2386191860831969086, 0.4679139345726910474},
                         {0.6612093864662645137, 0.3607615730481386076},
                         {0.9324695142031520278, 0.1713244923791703450}};

/// Pieces below this share of the ground facet are round-off of facets that only touch.
constexpr double least_points_share = 1.0e-13;

/// The partner where it is seen at z, if that is within reach.
bool is_near(const GroundFacet& ground, const Corners& partner, const PlaneFacet& seen,
             const Eigen::Vector2d& z, double reach) {
  const Shape4 shape = seen.shape(z);
  double height = 0.0;
  for (int j = 0; j < partner.count; ++j) height += shape[j] * ground.plane.height(partner.x[j]);
  return std::abs(height) <= reach;
}

Interval points_interval(const PlaneFacet& segment) {
  const double a = segment.x[0].x(), b = segment.x[1].x();
  return a < b ? Interval{a, b} : Interval{b, a};
}

void points_of_segments(const GroundFacet& ground, const Corners& partner, double reach,
                        std::vector<OverlapPoint>& points) {
  const PlaneFacet seen = seen_in(ground.plane, partner);
  const Interval common = clip(points_interval(ground.seen), points_interval(seen));
  if (!(common.length() > least_points_share * ground.area)) return;
  const double middle = 0.5 * (common.low + common.high), half = 0.5 * common.length();
  if (!is_near(ground, partner, seen, {middle, 0.0}, reach)) return;
  for (const Gauss& g : six) {
    const Eigen::Vector2d z(middle + half * g.at, 0.0);
    const Shape4 at_k = ground.seen.shape(z);
    double weight = half * g.weight;
    if (ground.round) {
      const double radius = at_k[0] * ground.corners.x[0].x() + at_k[1] * ground.corners.x[1].x();
      weight *= 2.0 * std::numbers::pi * radius;
    }
    points.push_back({z, weight, at_k, seen.shape(z)});
  }
}

void points_of_surfaces(const GroundFacet& ground, const Corners& partner, double reach,
                        std::vector<OverlapPoint>& points) {
  const PlaneFacet seen = seen_in(ground.plane, partner);
  const Polygon common = clip(seen.polygon(), ground.polygon);
  if (!(signed_area(common) > least_points_share * ground.area)) return;
  Eigen::Vector2d middle = common.x[0];
  for (int i = 1; i < common.count; ++i) middle += common.x[i];
  middle /= common.count;
  if (!is_near(ground, partner, seen, middle, reach)) return;
  for (int i = 0; i < common.count; ++i) {
    const Eigen::Vector2d a = common.x[i] - middle;
    const Eigen::Vector2d b = common.x[i + 1 == common.count ? 0 : i + 1] - middle;
    const double twice = a.x() * b.y() - a.y() * b.x();
    if (!(twice > 0.0)) continue;
    for (const Gauss& out : six) {
      for (const Gauss& across : six) {
        const double s = 0.5 * (1.0 + out.at), t = 0.5 * (1.0 + across.at);
        const Eigen::Vector2d z = middle + s * ((1.0 - t) * a + t * b);
        const double weight = 0.25 * out.weight * across.weight * s * twice;
        points.push_back({z, weight, ground.seen.shape(z), seen.shape(z)});
      }
    }
  }
}

}  // namespace

void overlap_points(const GroundFacet& ground, const Corners& partner, double reach,
                    std::vector<OverlapPoint>& points) {
  points.clear();
  if (ground.corners.count == 2) {
    points_of_segments(ground, partner, reach, points);
  } else {
    points_of_surfaces(ground, partner, reach, points);
  }
}

}  // namespace abut
