#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "surface/feature_distance.hpp"
#include "surface/skin.hpp"
#include "tests/support/surfaces.hpp"

namespace abut {

struct FeatureCase {
  FeatureKind kind;
  int dim;
};

/// All that there are.
constexpr FeatureCase feature_cases[] = {
    {FeatureKind::node_facet, 2}, {FeatureKind::node_facet, 3}, {FeatureKind::edge_edge, 3}};

inline Eigen::Vector3d drawn_point(DrawNumbers& draw, int dim, double size) {
  const double x = draw(-size, size), y = draw(-size, size);
  return {x, y, dim == 3 ? draw(-size, size) : 0.0};
}

inline FeaturePoints drawn_points(DrawNumbers& draw, int dim, double size) {
  FeaturePoints x;
  for (Eigen::Vector3d& point : x) point = drawn_point(draw, dim, size);
  return x;
}

inline FeaturePoints on_the_way(const FeaturePoints& x0, const FeaturePoints& x1, double t) {
  FeaturePoints x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = x0[i] + t * (x1[i] - x0[i]);
  return x;
}

/// Points of a skin's surfaces as the skin numbers them.
inline std::vector<Eigen::Vector3d> points_of(const std::vector<SurfaceMesh>& meshes) {
  std::vector<Eigen::Vector3d> points;
  for (const SurfaceMesh& mesh : meshes)
    for (int i = 0; i < mesh.nodes(); ++i) points.push_back(mesh.pose().point(i));
  return points;
}

inline Skin skin_of(const std::vector<SurfaceMesh>& meshes) {
  std::vector<PosedSurface> poses;
  for (const SurfaceMesh& mesh : meshes) poses.push_back(mesh.pose());
  return skin_of(std::span<const PosedSurface>(poses));
}

/// A block between two corners, its facets outward; in the plane a rectangle.
inline SurfaceMesh block(int dim, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  SurfaceMesh mesh;
  mesh.dim = dim;
  const int corners = dim == 2 ? 4 : 8;
  for (int i = 0; i < corners; ++i)
    for (int d = 0; d < dim; ++d) mesh.points.push_back(i >> d & 1 ? high[d] : low[d]);
  if (dim == 2) {
    for (const std::vector<std::int32_t>& f :
         {std::vector<std::int32_t>{0, 1}, {1, 3}, {3, 2}, {2, 0}})
      mesh.add_facet(f, false);
    return mesh;
  }
  for (const std::vector<std::int32_t>& f : {std::vector<std::int32_t>{0, 2, 3, 1},
                                             {4, 5, 7, 6},
                                             {0, 1, 5, 4},
                                             {2, 6, 7, 3},
                                             {0, 4, 6, 2},
                                             {1, 3, 7, 5}})
    mesh.add_facet(f, false);
  return mesh;
}

}  // namespace abut
