#include "surface/clip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.hpp"

namespace abut {
namespace {

/// Distances from a line are sums of few products: this many units of round-off of the polygons'
/// size are no distance. A corner so near lies on the line, so that noise cuts nothing.
constexpr double round_off = 8.0 * std::numeric_limits<double>::epsilon();

/// Extent of a polygon around a point, in the larger coordinate.
double reach_from(const Eigen::Vector2d& p, const Polygon& polygon) {
  double most = 0.0;
  for (int i = 0; i < polygon.count; ++i)
    most = std::max(most, (polygon.x[i] - p).cwiseAbs().maxCoeff());
  return most;
}

/// The part of `from` on the left of the line from p along the unit vector t.
void cut(const Polygon& from, const Eigen::Vector2d& p, const Eigen::Vector2d& t, double noise,
         Polygon& to) {
  const auto distance = [&p, &t, noise](const Eigen::Vector2d& x) {
    const double d = t.x() * (x.y() - p.y()) - t.y() * (x.x() - p.x());
    return std::abs(d) <= noise ? 0.0 : d;
  };
  to.count = 0;
  if (from.count == 0) return;
  double d = distance(from.x[0]);
  const double first = d;
  for (int i = 0; i < from.count; ++i) {
    const bool last = i + 1 == from.count;
    const Eigen::Vector2d &a = from.x[i], &b = from.x[last ? 0 : i + 1];
    const double next = last ? first : distance(b);
    if (d >= 0.0) to.add(a);
    if ((d > 0.0 && next < 0.0) || (d < 0.0 && next > 0.0)) to.add(a + (b - a) * (d / (d - next)));
    d = next;
  }
}

}  // namespace

void Polygon::add(const Eigen::Vector2d& corner) {
  ABUT_ASSERT(count < capacity);
  x[count++] = corner;
}

double signed_area(const Polygon& polygon) {
  double twice = 0.0;
  for (int i = 2; i < polygon.count; ++i) {
    const Eigen::Vector2d a = polygon.x[i - 1] - polygon.x[0], b = polygon.x[i] - polygon.x[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

Polygon clip(const Polygon& subject, const Polygon& clipper) {
  if (subject.count == 0 || clipper.count == 0) return {};
  const double scale =
      std::max(reach_from(clipper.x[0], clipper), reach_from(clipper.x[0], subject));
  const double noise = round_off * scale;
  std::array<Polygon, 2> parts;
  const Polygon* part = &subject;
  int next = 0;
  for (int e = 0; e < clipper.count && part->count > 0; ++e) {
    const Eigen::Vector2d& p = clipper.x[e];
    const Eigen::Vector2d side = clipper.x[e + 1 == clipper.count ? 0 : e + 1] - p;
    const double length = side.norm();
    if (!(length > noise)) continue;  // a repeated corner
    cut(*part, p, side / length, noise, parts[next]);
    part = &parts[next];
    next = 1 - next;
  }
  // What is no wider than the noise has no area; a clipper without any edge cuts nothing off.
  if (part == &subject || part->count < 3 || !(signed_area(*part) > noise * scale)) return {};
  return *part;
}

Interval clip(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

}  // namespace abut
