#pragma once

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "tests/support/surfaces.hpp"

namespace abut {

/// Two flat surfaces on each other, which do not match. K looks down, N looks up.
struct FlatCase {
  std::string name;
  SurfaceMesh k, n;
  bool straight;  // all facets are segments, triangles or parallelograms: integrals are exact
  bool inside;    // N covers all of K
};

inline void PrintTo(const FlatCase& c, std::ostream* out) { *out << c.name; }

inline Eigen::Vector3d turned(const Eigen::Vector3d& x, double degrees, double cx, double cy) {
  const double a = degrees * std::acos(-1.0) / 180.0, c = std::cos(a), s = std::sin(a);
  return {cx + c * (x.x() - cx) - s * (x.y() - cy), cy + s * (x.x() - cx) + c * (x.y() - cy),
          x.z()};
}

/// A rectangle, turned around the middle of the unit square.
inline SurfaceMap rectangle(double low, double high, double degrees = 0.0) {
  return [low, high, degrees](double u, double v) {
    return turned({low + (high - low) * u, low + (high - low) * v, 0.0}, degrees, 0.5, 0.5);
  };
}

/// The unit square, its inside turned by up to 30 degrees in the middle and not at all at its rim.
inline SurfaceMap swirl() {
  return [](double u, double v) {
    const double bump = 16.0 * u * (1.0 - u) * v * (1.0 - v);
    return turned({u, v, 0.0}, 30.0 * bump, 0.5, 0.5);
  };
}

inline SurfaceMap shifted(double du, double dv) {
  return [du, dv](double u, double v) { return Eigen::Vector3d(u + du, v + dv, 0.0); };
}

inline std::vector<FlatCase> flat_cases() {
  const SurfaceMap unit = rectangle(0.0, 1.0);
  const auto k = [](int cells, const SurfaceMap& place, bool triangles) {
    return grid(cells, cells, place, triangles, true);
  };
  const auto n = [&unit](int cells, bool triangles) {
    return grid(cells, cells, unit, triangles, false);
  };
  const auto bottom = [](double from, double to) {
    return [from, to](double u) { return Eigen::Vector2d(from + (to - from) * u, 0.0); };
  };
  return {
      {"segments_match", line(6, bottom(0, 1), false), line(6, bottom(0, 1), true), true, true},
      {"segments_17_on_23", line(17, bottom(0, 1), false), line(23, bottom(0, 1), true), true,
       true},
      {"segments_4_on_40", line(4, bottom(0, 1), false), line(40, bottom(0, 1), true), true, true},
      {"segments_overhang", line(7, bottom(-0.313, 1.2), false), line(5, bottom(0, 1), true), true,
       false},
      {"segments_touch_1e-9", line(4, bottom(-1, 1e-9), false), line(5, bottom(0, 1), true), true,
       false},
      {"quads_match", k(5, unit, false), n(5, false), true, true},
      {"quads_6_on_4", k(6, unit, false), n(4, false), true, true},
      {"quads_4_on_6", k(4, unit, false), n(6, false), true, true},
      {"quads_on_triangles", k(5, unit, false), n(4, true), true, true},
      {"triangles_on_quads", k(4, unit, true), n(5, false), true, true},
      {"triangles_on_triangles", k(5, unit, true), n(4, true), true, true},
      {"swirled_quads", k(6, swirl(), false), n(6, false), false, true},
      {"swirled_quads_on_triangles", k(5, swirl(), false), n(7, true), false, true},
      {"turned_30_inside", k(4, rectangle(0.25, 0.75, 30.0), false), n(6, false), true, true},
      {"turned_30_overhanging", k(6, rectangle(-0.3, 1.3, 30.0), false), n(5, false), true, false},
      {"triangles_turned_30_overhanging", k(6, rectangle(-0.3, 1.3, 30.0), true), n(5, true), true,
       false},
      {"offset_1e-1", k(6, shifted(0.1, 0.07), false), n(4, false), true, false},
      {"offset_1e-3", k(6, shifted(1e-3, 7e-4), false), n(4, false), true, false},
      {"offset_1e-5", k(6, shifted(1e-5, 7e-6), false), n(4, false), true, false},
      {"corner_of_1e-4", k(4, shifted(0.7499, 0.7499), false), n(4, false), true, false},
      {"corner_of_1e-12", k(4, shifted(1.0 - 2.5e-7, 1.0 - 2.5e-7), false), n(4, false), true,
       false},
      // dual functions would reach out from N to the corners of its facet of K, 37 times its size
      {"partner_inside_one_facet", k(3, unit, false),
       grid(2, 2, rectangle(0.48, 0.51), false, false), true, false},
  };
}

}  // namespace abut
