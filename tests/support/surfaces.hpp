#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "surface/boxes.hpp"
#include "surface/mortar.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// A surface that a test owns.
struct SurfaceMesh {
  int dim = 3;
  std::vector<double> points;
  std::vector<std::int32_t> facets, offsets{0};

  PosedSurface pose() const { return {dim, points, facets, offsets}; }
  PosedSurface pose(std::span<const double> other) const { return {dim, other, facets, offsets}; }
  int nodes() const { return static_cast<int>(points.size()) / dim; }
  void add_facet(std::vector<std::int32_t> corners, bool flipped) {
    if (flipped) std::reverse(corners.begin(), corners.end());
    facets.insert(facets.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<std::int32_t>(facets.size()));
  }
};

using SurfaceMap = std::function<Eigen::Vector3d(double, double)>;  // of u, v in [0, 1]

/// nu x nv cells over the unit square, placed in space; normals along d/du x d/dv, or against it.
inline SurfaceMesh grid(int nu, int nv, const SurfaceMap& place, bool triangles, bool flipped) {
  SurfaceMesh mesh;
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const Eigen::Vector3d x = place(double(i) / nu, double(j) / nv);
      mesh.points.insert(mesh.points.end(), x.data(), x.data() + 3);
    }
  }
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      const std::int32_t a = j * (nu + 1) + i, b = a + 1, c = b + nu + 1, d = c - 1;
      if (triangles) {
        mesh.add_facet({a, b, c}, flipped);
        mesh.add_facet({a, c, d}, flipped);
      } else {
        mesh.add_facet({a, b, c, d}, flipped);
      }
    }
  }
  return mesh;
}

/// n segments of a line in the plane; the body on the left of the way from u = 0 to 1, or on the
/// right of it.
inline SurfaceMesh line(int n, const std::function<Eigen::Vector2d(double)>& place, bool flipped) {
  SurfaceMesh mesh;
  mesh.dim = 2;
  for (int i = 0; i <= n; ++i) {
    const Eigen::Vector2d x = place(double(i) / n);
    mesh.points.insert(mesh.points.end(), x.data(), x.data() + 2);
  }
  for (int i = 0; i < n; ++i) mesh.add_facet({i, i + 1}, flipped);
  return mesh;
}

/// The same facets with their points moved.
inline SurfaceMesh moved(SurfaceMesh mesh, const Eigen::Matrix3d& turn, const Eigen::Vector3d& by) {
  for (int i = 0; i < mesh.nodes(); ++i) {
    const Eigen::Vector3d x = turn * mesh.pose().point(i) + by;
    for (int d = 0; d < mesh.dim; ++d) mesh.points[mesh.dim * i + d] = x[d];
  }
  return mesh;
}

/// Rows by search and mortar, as a caller makes them.
struct Join {
  BoxTree k_tree, n_tree;
  std::vector<FacetPair> pairs;
  MortarBuffers buffers;
  SurfaceRows rows;

  Join(const SurfaceMesh& k, const SurfaceMesh& n, const MortarOptions& options, double margin) {
    build(k_tree, k.pose(), margin);
    build(n_tree, n.pose(), 0.0);
    overlapping_pairs(k_tree, n_tree, pairs);
    mortar_rows(k.pose(), n.pose(), pairs, options, buffers, rows);
  }
};

inline SurfaceRows mortar(const SurfaceMesh& k, const SurfaceMesh& n,
                          const MortarOptions& options = {}, double margin = 0.3) {
  return Join(k, n, options, margin).rows;
}

/// Numbers in [low, high] that are the same everywhere.
struct DrawNumbers {
  std::mt19937_64 engine;

  explicit DrawNumbers(unsigned seed) : engine(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
  std::vector<double> many(std::size_t count, double low, double high) {
    std::vector<double> values(count);
    for (double& value : values) value = (*this)(low, high);
    return values;
  }
};

/// A rotation that no axis or plane of a test keeps.
inline Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.7, 0.5).normalized()).toRotationMatrix();
}

/// Coefficients of one row as a dense list over the nodes.
inline std::vector<double> dense(const SparseRows& rows, int row, int nodes) {
  std::vector<double> values(index(nodes), 0.0);
  for (std::int32_t e = rows.offsets[row]; e < rows.offsets[row + 1]; ++e)
    values[rows.columns[e]] = rows.values[e];
  return values;
}

}  // namespace abut
