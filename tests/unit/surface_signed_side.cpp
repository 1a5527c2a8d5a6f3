// Goal: a place is told to be inside of a body's surface or outside of it, whatever edge or corner
// is closest, and how deep; surfaces that touch tell the way that parts them.
// Oracles: the distance of a block in closed form; rays (surface/inside.hpp) for bodies with sharp
// corners outward and inward; normals of touching blocks.

#include "surface/signed_side.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "surface/inside.hpp"
#include "tests/support/feature_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_signed_side_tests {
namespace {

using Vector = Eigen::Vector3d;

std::vector<std::int32_t> all_facets(const Skin& skin) {
  std::vector<std::int32_t> all(skin.facets.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Of a block from 0 to 1: outside the norm of what is beyond, inside the nearest face.
double block_gap(const Vector& x, int dim) {
  double square = 0.0, deepest = -10.0;
  for (int d = 0; d < dim; ++d) {
    const double beyond = std::max(-x[d], x[d] - 1.0);
    square += std::pow(std::max(0.0, beyond), 2);
    deepest = std::max(deepest, beyond);
  }
  return deepest > 0.0 ? std::sqrt(square) : deepest;
}

TEST(SignedSide, OfABlockIsItsGap) {
  DrawNumbers draw(1);
  for (const int dim : {2, 3}) {
    const Eigen::Matrix3d turn =
        dim == 3 ? some_rotation() : Eigen::AngleAxisd(0.7, Vector::UnitZ()).toRotationMatrix();
    const Vector by(0.1, 0.2, dim == 3 ? 0.3 : 0.0);
    const std::vector<SurfaceMesh> meshes{
        moved(block(dim, Vector::Zero(), Vector::Ones()), turn, by)};
    const Skin skin = skin_of(meshes);
    const std::vector<Vector> points = points_of(meshes);
    const SkinSides sides(skin);
    for (int k = 0; k < 3000; ++k) {
      Vector x = 0.5 * (dim == 3 ? Vector(1, 1, 1) : Vector(1, 1, 0)) + drawn_point(draw, dim, 1.0);
      if (k % 3 == 0)  // beside an edge or a corner
        for (int d = 0; d < dim; ++d)
          x[d] = draw(0, 1) < 0.7 ? std::round(x[d]) + draw(-1e-3, 1e-3) : x[d];
      const SignedSide side = sides.side(points, turn * x + by, all_facets(skin));
      EXPECT_NEAR(side.gap, block_gap(x, dim), roundoff(100.0, 1.0));
      EXPECT_EQ(side.inside(), block_gap(x, dim) < 0.0);
      EXPECT_FALSE(side.border);
      EXPECT_NEAR(side.normal.norm(), 1.0, roundoff(10.0, 1.0));
    }
  }
}

/// A sphere whose nodes are thrown in and out: corners of all shapes, some sharper than a right
/// angle, and fans of unlike facets.
SurfaceMesh urchin(DrawNumbers& draw, double low) {
  // a block whose faces are divided, blown up
  SurfaceMesh mesh;
  const SurfaceMesh cube = block(3, {-1, -1, -1}, {1, 1, 1});
  constexpr int n = 3;
  std::vector<Vector> nodes;
  const auto node_at = [&nodes](const Vector& x) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if ((nodes[i] - x).norm() < 1e-9) return static_cast<std::int32_t>(i);
    nodes.push_back(x);
    return static_cast<std::int32_t>(nodes.size() - 1);
  };
  for (int f = 0; f < 6; ++f) {
    const Corners c = corners(cube.pose(), f);
    const auto at = [&c](int i, int j) -> Vector {
      return c.x[0] + (c.x[1] - c.x[0]) * (double(i) / n) + (c.x[3] - c.x[0]) * (double(j) / n);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const std::int32_t a = node_at(at(i, j)), b = node_at(at(i + 1, j)),
                           d = node_at(at(i, j + 1)), e = node_at(at(i + 1, j + 1));
        mesh.add_facet({a, b, e}, false);
        mesh.add_facet({a, e, d}, false);
      }
  }
  for (const Vector& x : nodes) {
    const Vector y = draw(low, 1.0) * x.normalized();
    mesh.points.insert(mesh.points.end(), y.data(), y.data() + 3);
  }
  return mesh;
}

SurfaceMesh star(DrawNumbers& draw, double low) {
  SurfaceMesh mesh;
  mesh.dim = 2;
  constexpr int n = 20;
  for (int i = 0; i < n; ++i) {
    const double r = draw(low, 1.0), a = 2.0 * M_PI * i / n;
    mesh.points.insert(mesh.points.end(), {r * std::cos(a), r * std::sin(a)});
    mesh.add_facet({i, (i + 1) % n}, false);
  }
  return mesh;
}

TEST(SignedSide, IsThatOfRaysWhateverTheCorners) {
  DrawNumbers draw(2);
  for (const int dim : {2, 3}) {
    for (const double low : {0.9, 0.5, 0.1}) {
      const std::vector<SurfaceMesh> meshes{dim == 2 ? star(draw, low) : urchin(draw, low)};
      ASSERT_TRUE(is_closed(meshes[0].pose()));
      const Skin skin = skin_of(meshes);
      const std::vector<Vector> points = points_of(meshes);
      BoxTree tree;
      build(tree, meshes[0].pose(), 0.0);
      const SkinSides sides(skin);
      int in = 0;
      for (int k = 0; k < 2000; ++k) {
        // all over, and about nodes, where the closest feature is any
        const Vector x = k % 2 == 0 ? drawn_point(draw, dim, 1.2)
                                    : points[k / 2 % points.size()] +
                                          drawn_point(draw, dim, k % 4 == 1 ? 0.1 : 1e-6);
        const SignedSide side = sides.side(points, x, all_facets(skin));
        EXPECT_EQ(side.inside(), inside(meshes[0].pose(), tree, x)) << dim << " " << low;
        in += side.inside();
      }
      EXPECT_GT(in, 100);
    }
  }
}

/// A needle of which one side is cut into many facets at the tip: their number must not matter.
SurfaceMesh needle(int parts) {
  SurfaceMesh mesh;
  const auto add = [&mesh](const Vector& x) {
    mesh.points.insert(mesh.points.end(), x.data(), x.data() + 3);
    return static_cast<std::int32_t>(mesh.nodes() - 1);
  };
  const std::int32_t tip = add({0, 0, 2}), behind = add({-0.3, 0, 0}), first = add({0.3, -0.4, 0});
  for (int i = 1; i <= parts; ++i) add({0.3, -0.4 + 0.8 * i / parts, 0});
  const std::int32_t last = first + parts;
  for (std::int32_t i = first; i < last; ++i) {
    mesh.add_facet({tip, i, i + 1}, false);
    mesh.add_facet({behind, i + 1, i}, false);
  }
  mesh.add_facet({tip, last, behind}, false);
  mesh.add_facet({tip, behind, first}, false);
  return mesh;
}

TEST(SignedSide, OfATipDoesNotDependOnTheNumberOfItsFacets) {
  DrawNumbers draw(3);
  for (const int parts : {1, 3, 30}) {
    const std::vector<SurfaceMesh> meshes{needle(parts)};
    ASSERT_TRUE(is_closed(meshes[0].pose()));
    const Skin skin = skin_of(meshes);
    const std::vector<Vector> points = points_of(meshes);
    BoxTree tree;
    build(tree, meshes[0].pose(), 0.0);
    const SkinSides sides(skin);
    for (int k = 0; k < 1000; ++k) {
      const Vector x = points[0] + drawn_point(draw, 3, 0.1);
      EXPECT_EQ(sides.side(points, x, all_facets(skin)).inside(),
                inside(meshes[0].pose(), tree, x));
    }
  }
}

TEST(SignedSide, WhereASurfaceEnds) {
  const std::vector<SurfaceMesh> meshes{grid(
      2, 2, [](double u, double v) { return Vector(u, v, 0); }, false, false)};
  const Skin skin = skin_of(meshes);
  const std::vector<Vector> points = points_of(meshes);
  const SkinSides sides(skin);
  const auto side = [&](double x, double z) {
    return sides.side(points, Vector(x, 0.4, z), all_facets(skin));
  };
  EXPECT_EQ(side(0.6, -0.2).gap, -0.2);
  EXPECT_FALSE(side(0.6, -0.2).border);
  EXPECT_LT(side(1.01, -0.2).gap, 0.0);  // hardly beside it, behind it
  EXPECT_TRUE(side(1.01, -0.2).border);
  EXPECT_GT(side(1.3, -0.2).gap, 0.0);  // rather beside it
  EXPECT_GT(side(1.3, 0.2).gap, 0.0);
}

}  // namespace
}  // namespace abut::surface_signed_side_tests
