#include "surface/facet_overlap.hpp"

#include <cmath>
#include <numbers>
#include <span>

namespace abut {
namespace {

/// A point of a triangle: barycentric coordinates and its share of the area.
struct TrianglePoint {
  double l1, l2, weight;
};

/// Degree 2: products of linear functions.
constexpr TrianglePoint three[] = {{1.0 / 6.0, 1.0 / 6.0, 1.0 / 3.0},
                                   {2.0 / 3.0, 1.0 / 6.0, 1.0 / 3.0},
                                   {1.0 / 6.0, 2.0 / 3.0, 1.0 / 3.0}};

/// Degree 5 (Radon's rule): products of bilinear functions need 4.
constexpr double root15 = 3.872983346207416885;
constexpr double near = (6.0 - root15) / 21.0, far = (6.0 + root15) / 21.0;
constexpr double near_weight = (155.0 - root15) / 1200.0, far_weight = (155.0 + root15) / 1200.0;
constexpr TrianglePoint seven[] = {{1.0 / 3.0, 1.0 / 3.0, 9.0 / 40.0},
                                   {near, near, near_weight},
                                   {1.0 - 2.0 * near, near, near_weight},
                                   {near, 1.0 - 2.0 * near, near_weight},
                                   {far, far, far_weight},
                                   {1.0 - 2.0 * far, far, far_weight},
                                   {far, 1.0 - 2.0 * far, far_weight}};

/// Pieces below this share of the ground facet are round-off of facets that only touch.
constexpr double least_overlap_share = 1.0e-13;

struct Integrand {
  const PlaneFacet &ground, &partner;
  FacetOverlap& overlap;

  void add(const Eigen::Vector2d& z, double weight) const {
    const Shape4 at_k = ground.shape(z), at_n = partner.shape(z), share = weight * at_k;
    overlap.moments += share;
    overlap.own += share * at_k.transpose();
    overlap.mixed += share * at_n.transpose();
  }
};

void add_triangle(const Integrand& integrand, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                  const Eigen::Vector2d& c, std::span<const TrianglePoint> rule) {
  const Eigen::Vector2d u = b - a, v = c - a;
  const double size = 0.5 * (u.x() * v.y() - u.y() * v.x());
  if (!(size > 0.0)) return;
  for (const TrianglePoint& p : rule) integrand.add(a + u * p.l1 + v * p.l2, size * p.weight);
}

void add_four(const Integrand& integrand, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
              const Eigen::Vector2d& c, std::span<const TrianglePoint> rule) {
  const Eigen::Vector2d ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  add_triangle(integrand, a, ab, ca, rule);
  add_triangle(integrand, ab, b, bc, rule);
  add_triangle(integrand, ca, bc, c, rule);
  add_triangle(integrand, ab, bc, ca, rule);
}

Eigen::Vector2d middle(const Polygon& polygon) {
  Eigen::Vector2d sum = polygon.x[0];
  for (int i = 1; i < polygon.count; ++i) sum += polygon.x[i];
  return sum / polygon.count;
}

/// Height of the partner over a point of the plane.
double height_at(const GroundFacet& ground, const Corners& partner, const Shape4& shape) {
  double height = 0.0;
  for (int j = 0; j < partner.count; ++j) height += shape[j] * ground.plane.height(partner.x[j]);
  return height;
}

/// Polynomials are exact however the polygon is parted; other functions like small triangles.
void integrate_polygon(const Integrand& integrand, const Polygon& polygon,
                       const Eigen::Vector2d& centre, PieceQuadrature quadrature) {
  const bool exact = integrand.ground.affine && integrand.partner.affine;
  const bool linear = integrand.ground.count == 3 && integrand.partner.count == 3;
  if (exact) {
    const std::span<const TrianglePoint> rule =
        linear ? std::span<const TrianglePoint>(three) : seven;
    for (int i = 2; i < polygon.count; ++i)
      add_triangle(integrand, polygon.x[0], polygon.x[i - 1], polygon.x[i], rule);
    return;
  }
  for (int i = 0; i < polygon.count; ++i) {
    const Eigen::Vector2d &a = polygon.x[i], &b = polygon.x[i + 1 == polygon.count ? 0 : i + 1];
    if (quadrature == PieceQuadrature::four_times_seven)
      add_four(integrand, centre, a, b, seven);
    else
      add_triangle(integrand, centre, a, b, seven);
  }
}

/// Whether the partner's extent in the plane tells that it has nothing in common with the ground:
/// so for most candidates, because their boxes are larger than they.
bool is_beside(const GroundFacet& ground, const Corners& partner) {
  Eigen::Vector2d low = ground.plane.project(partner.x[0]), high = low;
  for (int i = 1; i < partner.count; ++i) {
    const Eigen::Vector2d x = ground.plane.project(partner.x[i]);
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return low.x() >= ground.high.x() || low.y() >= ground.high.y() || high.x() <= ground.low.x() ||
         high.y() <= ground.low.y();
}

bool integrate_surfaces(const GroundFacet& ground, const Corners& partner, double reach,
                        PieceQuadrature quadrature, FacetOverlap& overlap) {
  if (is_beside(ground, partner)) return false;
  const PlaneFacet seen = seen_in(ground.plane, partner);
  const Polygon common = clip(seen.polygon(), ground.polygon);
  overlap.area = signed_area(common);
  if (!(overlap.area > least_overlap_share * ground.area)) return false;
  const Eigen::Vector2d centre = middle(common);
  overlap.gap = height_at(ground, partner, seen.shape(centre));
  if (!(std::abs(overlap.gap) <= reach)) return false;
  integrate_polygon({ground.seen, seen, overlap}, common, centre, quadrature);
  return true;
}

Interval overlap_interval(const PlaneFacet& segment) {
  const double a = segment.x[0].x(), b = segment.x[1].x();
  return a < b ? Interval{a, b} : Interval{b, a};
}

bool integrate_segments(const GroundFacet& ground, const Corners& partner, double reach,
                        FacetOverlap& overlap) {
  const PlaneFacet seen = seen_in(ground.plane, partner);
  const Interval common = clip(overlap_interval(ground.seen), overlap_interval(seen));
  overlap.area = common.length();
  if (!(overlap.area > least_overlap_share * ground.area)) return false;
  const Eigen::Vector2d centre(0.5 * (common.low + common.high), 0.0);
  overlap.gap = height_at(ground, partner, seen.shape(centre));
  if (!(std::abs(overlap.gap) <= reach)) return false;
  const Integrand integrand{ground.seen, seen, overlap};
  // two points of Gauss: degree 3, which rings need; segments need 2
  constexpr double root3 = 1.732050807568877294;
  for (const double at : {-1.0 / root3, 1.0 / root3}) {
    const Eigen::Vector2d z(centre.x() + 0.5 * at * overlap.area, 0.0);
    double weight = 0.5 * overlap.area;
    if (ground.round) {
      const Shape4 shape = ground.seen.shape(z);
      weight *= 2.0 * std::numbers::pi *
                (shape[0] * ground.corners.x[0].x() + shape[1] * ground.corners.x[1].x());
    }
    integrand.add(z, weight);
  }
  return true;
}

}  // namespace

GroundFacet::GroundFacet(const Corners& facet, bool is_round)
    : corners(facet),
      plane(auxiliary_plane(facet)),
      seen(seen_in(plane, facet)),
      polygon(seen.polygon()),
      low(polygon.x[0]),
      high(polygon.x[0]),
      area(abut::area(facet)),
      round(is_round) {
  for (int i = 1; i < polygon.count; ++i) {
    low = low.cwiseMin(polygon.x[i]);
    high = high.cwiseMax(polygon.x[i]);
  }
}

bool integrate(const GroundFacet& ground, const Corners& partner, double reach,
               PieceQuadrature quadrature, FacetOverlap& overlap) {
  overlap = {};
  return ground.corners.count == 2
             ? integrate_segments(ground, partner, reach, overlap)
             : integrate_surfaces(ground, partner, reach, quadrature, overlap);
}

}  // namespace abut
