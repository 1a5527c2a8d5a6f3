#include "surface/feature_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {
namespace {

using Vector = Eigen::Vector3d;

/// x_i - x_j over the first side's and the second side's points, at the step's begin and its change
/// over the step: all that the pair's distance depends on. Common motion drops out exactly where it
/// is the same number for all points.
struct Differences {
  int count = 0;
  std::array<Vector, 4> begin, change;
  double size = 0.0;  // [m] of the numbers that were subtracted
};

Differences differences(FeatureKind kind, int dim, const FeaturePoints& x0,
                        const FeaturePoints& x1) {
  Differences d;
  const int first = kind == FeatureKind::node_facet ? 1 : 2, end = dim == 2 ? 3 : 4;
  for (int i = 0; i < first; ++i) {
    for (int j = first; j < end; ++j) {
      d.begin[d.count] = x0[i] - x0[j];
      d.change[d.count++] = (x1[i] - x0[i]) - (x1[j] - x0[j]);
    }
  }
  for (int i = 0; i < end; ++i)
    d.size = std::max({d.size, x0[i].cwiseAbs().maxCoeff(), x1[i].cwiseAbs().maxCoeff()});
  return d;
}

/// The pair's places at a time, one point of it as the origin: what is left of them is as exact as
/// their differences.
FeaturePoints places_at(int points, const FeaturePoints& x0, const FeaturePoints& x1, double t) {
  FeaturePoints x{Vector::Zero(), Vector::Zero(), Vector::Zero(), Vector::Zero()};
  for (int i = 1; i < points; ++i) x[i] = (x0[i] - x0[0]) + t * ((x1[i] - x0[i]) - (x1[0] - x0[0]));
  return x;
}

/// Time for which the pair is known to stay farther apart than `until`, from t on, by the direction
/// of its difference then. `lower`: the bound of its distance at t.
double free_time(const Differences& d, const Vector& direction, double t, double until,
                 double& lower) {
  double time = std::numeric_limits<double>::infinity();
  lower = std::numeric_limits<double>::infinity();
  for (int i = 0; i < d.count; ++i) {
    const double apart = direction.dot(d.begin[i] + t * d.change[i]);
    const double approach = -direction.dot(d.change[i]);
    lower = std::min(lower, apart);
    if (approach > 0.0) time = std::min(time, (apart - until) / approach);
  }
  return time;
}

/// Of the size of the numbers: over the length of a facet a direction found from a difference as
/// short as that is off by a notable share of it.
constexpr double hardly_apart = 1.0e-6;

/// The normal of what the closest points lie in, a facet or two edges, towards the first side: as a
/// direction that says how far apart the pair is at least it is as good as the difference, and does
/// not know how near they are. Zero: there is none.
Vector normal_towards(FeatureKind kind, int dim, const FeaturePoints& x, const Vector& difference) {
  Vector normal;
  if (dim == 2) {
    normal = Vector(x[1].y() - x[2].y(), x[2].x() - x[1].x(), 0.0);
  } else if (kind == FeatureKind::node_facet) {
    normal = (x[2] - x[1]).cross(x[3] - x[1]);
  } else {
    normal = (x[1] - x[0]).cross(x[3] - x[2]);
  }
  return (normal.dot(difference) < 0.0 ? -1.0 : 1.0) * normal.normalized();
}

}  // namespace

double first_time_within(FeatureKind kind, int dim, const FeaturePoints& x0,
                         const FeaturePoints& x1, double distance, double tolerance) {
  const Differences d = differences(kind, dim, x0, x1);
  // Roundings of a dot product of differences, with its unit vector's: fewer than 16.
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * d.size;
  const double margin = std::max(tolerance, 4.0 * rounding);
  // Steps end half a margin above the distance, so that roundings never make them late, and those
  // that begin less than a margin above it are the last ones: every step is of some length. Where
  // features roll past each other hardly above it there may be many; then the time is early.
  constexpr int most_steps = 10000;
  const double until = distance + 0.5 * margin;
  double t = 0.0;
  for (int step = 0; step < most_steps; ++step) {
    const FeaturePoints x = places_at(dim == 2 ? 3 : 4, x0, x1, t);
    const Vector difference = feature_distance(kind, dim, x).difference(x);
    const double length = difference.norm();
    if (!(length > 0.0)) return t;
    double lower;
    double time = free_time(d, difference / length, t, until, lower);
    if (!(lower >= distance + margin) && length < hardly_apart * d.size)
      time = free_time(d, normal_towards(kind, dim, x, difference), t, until, lower);
    if (!(lower >= distance + margin)) return t;
    t += time;
    if (!(t < 1.0)) return 1.0;
  }
  return t;
}

}  // namespace abut
