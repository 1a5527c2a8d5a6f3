#pragma once

#include <array>
#include <string>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Which place of a part its `origin` is.
enum class Origin {
  corner,  // the corner of smallest coordinates
  centre,
};

// Grading is the length of the last element over that of the first in a direction; lengths between
// grow geometrically.

/// A line of bar2. Sides left (x-), right (x+), boundary.
struct BarMesh {
  double origin = 0.0;  // [m] of the left end
  double length = 0.0;  // [m]
  int elements = 0;
  double grading = 1.0;
};

/// Sides left (x-), right (x+), bottom (y-), top (y+), boundary; node sets of the corners:
/// left_bottom, right_bottom, left_top, right_top.
struct RectangleMesh {
  std::array<double, 2> origin = {0.0, 0.0};  // [m]
  Origin origin_at = Origin::corner;
  std::array<double, 2> lengths = {0.0, 0.0};  // [m]
  std::array<int, 2> elements = {0, 0};
  std::array<double, 2> grading = {1.0, 1.0};
  std::string element = "quad4";  // or another plane one; two triangles per quadrilateral
};

/// Sides left (x-), right (x+), bottom (y-), top (y+), back (z-), front (z+), boundary; node sets
/// of the corners, left_bottom_back to right_top_front.
struct BoxMesh {
  std::array<double, 3> origin = {0.0, 0.0, 0.0};  // [m]
  Origin origin_at = Origin::corner;
  std::array<double, 3> lengths = {0.0, 0.0, 0.0};  // [m]
  std::array<int, 3> elements = {0, 0, 0};
  std::array<double, 3> grading = {1.0, 1.0, 1.0};
  std::string element = "hex8";  // or another one; six tetrahedra per hexahedron
};

// Round parts are O-grids: a core of `core` elements in every direction, and `layers` layers of
// elements around it. Nodes of the surface are on it, those between corners too. An even core has
// a node, or a line of nodes, in its middle; of an odd one only some elements have.

/// Sides mantle, boundary; node set centre where a node lies there.
struct DiskMesh {
  std::array<double, 2> centre = {0.0, 0.0};  // [m]
  double radius = 0.0;                        // [m]
  int core = 0, layers = 0;
  std::string element = "quad4";  // or another plane one
};

/// Solid, along z. Sides mantle, bottom (z-), top (z+), boundary; node set axis where nodes lie
/// on it.
struct CylinderMesh {
  std::array<double, 3> origin = {0.0, 0.0, 0.0};  // [m] on the axis
  Origin origin_at = Origin::corner;               // corner: the middle of the bottom
  double radius = 0.0;                             // [m]
  double length = 0.0;                             // [m]
  int core = 0, layers = 0;
  int elements = 0;  // along the axis
  double grading = 1.0;
  std::string element = "hex8";  // or another one
};

/// Solid. Sides surface and boundary, which are the same; node set centre where a node lies there.
struct SphereMesh {
  std::array<double, 3> centre = {0.0, 0.0, 0.0};  // [m]
  double radius = 0.0;                             // [m]
  int core = 0, layers = 0;
  std::string element = "hex8";  // or another one
};

/// The mesh of a part. Throws InputError when a length is not positive and finite, a number of
/// elements is below 1 or too large, or the element does not fit; `where` is the key of the data.
Mesh generate(const BarMesh& data, const std::string& where);
Mesh generate(const RectangleMesh& data, const std::string& where);
Mesh generate(const BoxMesh& data, const std::string& where);
Mesh generate(const DiskMesh& data, const std::string& where);
Mesh generate(const CylinderMesh& data, const std::string& where);
Mesh generate(const SphereMesh& data, const std::string& where);

}  // namespace abut
