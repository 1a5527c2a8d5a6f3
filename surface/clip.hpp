#pragma once

#include <Eigen/Core>
#include <array>

namespace abut {

/// A polygon in a plane, corners counterclockwise; it lives on the stack.
struct Polygon {
  static constexpr int capacity = 24;
  int count = 0;
  std::array<Eigen::Vector2d, capacity> x;  // [m]

  void add(const Eigen::Vector2d& corner);
};

/// [m^2] area, negative when the corners turn clockwise; 0 below three corners.
double signed_area(const Polygon& polygon);

/// What two convex polygons have in common (Sutherland-Hodgman: the subject is cut along every edge
/// of the clipper). Empty when they share no area beyond round-off: polygons that touch in an edge
/// or a corner, clippers that are a line or a point. Repeated and collinear corners do no harm.
/// Together the two may have `Polygon::capacity` corners.
Polygon clip(const Polygon& subject, const Polygon& clipper);

/// Part of a line; empty when high <= low.
struct Interval {
  double low = 0.0, high = 0.0;  // [m]

  bool empty() const { return !(low < high); }
  double length() const { return empty() ? 0.0 : high - low; }
};

/// What two parts of a line have in common.
Interval clip(const Interval& a, const Interval& b);

}  // namespace abut
