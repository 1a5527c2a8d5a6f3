#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace abut {

/// A segment, triangle or tetrahedron, in the plane z = 0 or in space.
struct Simplex {
  int count = 0;                     // corners: 2, 3 or 4
  std::array<Eigen::Vector3d, 4> x;  // [m]
};

/// The places with normal . x <= offset.
struct HalfSpace {
  Eigen::Vector3d normal;  // unit
  double offset = 0.0;     // [m]

  /// [m] above 0: outside
  double distance(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
};

/// [m], [m^2] or [m^3]
double measure(const Simplex& simplex);

/// The half-spaces whose common part a simplex of a space's full dimension is: a triangle in the
/// plane, a tetrahedron in space.
std::vector<HalfSpace> sides_of(const Simplex& simplex);

/// Parts of a simplex of any dimension, each with the sense of the whole: those within all
/// half-spaces replace what `inside` held, the others are added to `outside`, which may be null.
/// Corners nearer to a bounding plane than `near` [m] are on it.
void divide(const Simplex& simplex, const std::vector<HalfSpace>& sides, double near,
            std::vector<Simplex>& inside, std::vector<Simplex>* outside);

}  // namespace abut
