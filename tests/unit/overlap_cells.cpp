// Goal: what two meshes have in common is found exactly, however one crosses the cells of the
// other. Oracles: volumes of boxes, integrals of linear fields, and linear fields themselves.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/fe/facet_index.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/overlap/cell_shares.hpp"
#include "subdomain_solver/overlap/embed.hpp"

namespace abut::overlap_cells_tests {
namespace {

/// A block of unit height from one x to another.
Mesh block(int dim, double from, double to, int across, const std::string& element) {
  Mesh mesh;
  if (dim == 2) {
    RectangleMesh shape;
    shape.lengths = {to - from, 1.0};
    shape.elements = {across, across};
    shape.element = element;
    mesh = generate(shape, "mesh");
  } else {
    BoxMesh shape;
    shape.lengths = {to - from, 1.0, 1.0};
    shape.elements = {across, across, across};
    shape.element = element;
    mesh = generate(shape, "mesh");
  }
  for (std::size_t k = 0; k < mesh.points.size(); k += index(dim)) mesh.points[k] += from;
  return mesh;
}

double linear(const double* x, int dim) { return x[0] - 2.0 * x[1] + (dim == 3 ? x[2] : 0.0); }

struct Kind {
  int dim;
  std::string own, other;
};
const std::vector<Kind> kinds = {{2, "quad4", "quad4"},
                                 {2, "tri3", "quad4"},
                                 {3, "hex8", "hex8"},
                                 {3, "tet4", "hex8"},
                                 {3, "hex8", "tet4"}};

/// Rounding of some hundred parts.
constexpr double rounding = 1.0e-12;

TEST(OverlapCells, CommonPartsHaveTheirVolume) {
  for (const Kind& kind : kinds) {
    for (const double to : {0.5, 0.83, 1.5}) {
      const Mesh own = block(kind.dim, 0.0, 1.0, 3, kind.own);
      const Mesh other = block(kind.dim, 0.31, to, 2, kind.other);
      const CommonParts common = common_parts(MeshSimplices(own), MeshSimplices(other));
      EXPECT_NEAR(common.volume, std::min(1.0, to) - 0.31, rounding) << kind.own << kind.other;
    }
  }
}

TEST(OverlapCells, BodiesThatOnlyMeetHaveNothingInCommon) {
  for (const Kind& kind : kinds) {
    const Mesh own = block(kind.dim, 0.0, 1.0, 3, kind.own);
    const Mesh other = block(kind.dim, 1.0, 2.0, 2, kind.other);
    EXPECT_TRUE(common_parts(MeshSimplices(own), MeshSimplices(other)).parts.empty());
  }
}

/// A side in the cells of another mesh: its whole area, turned, and points that reproduce linear
/// fields.
TEST(OverlapCells, SidesInsideFollowLinearFields) {
  for (const Kind& kind : kinds) {
    const Mesh own = block(kind.dim, 0.0, 1.0, 3, kind.own);
    for (const double from : {0.31, 1.0 / 3.0}) {  // across cells, and between them
      const Mesh other = block(kind.dim, from, 2.0, 2, kind.other);
      StickingOut out;
      const EmbeddedSurface inside =
          embed(BoundarySimplices(other, other.side("left")), MeshSimplices(own),
                BoundarySimplices(own, FacetIndex(own).boundary()), out);
      EXPECT_EQ(out.distance, 0.0);
      const PosedSurface surface{kind.dim, inside.points, inside.facets, inside.offsets};
      Eigen::Vector3d area = Eigen::Vector3d::Zero();
      for (int f = 0; f < surface.facet_count(); ++f) area += area_vector(corners(surface, f));
      EXPECT_NEAR((area - Eigen::Vector3d::UnitX()).norm(), 0.0, rounding);
      for (int k = 0; k < inside.count(); ++k) {
        double value = 0.0;
        for (std::int32_t e = inside.rows.offsets[k]; e < inside.rows.offsets[index(k) + 1];
             ++e)
          value += inside.rows.values[e] *
                   linear(&own.points[inside.rows.columns[index(e)] * kind.dim], kind.dim);
        EXPECT_NEAR(value, linear(&inside.points[k * kind.dim], kind.dim), rounding);
      }
    }
  }
}

TEST(OverlapCells, TellHowFarASideSticksOut) {
  const Mesh own = block(2, 0.0, 1.0, 3, "quad4");
  Mesh other = block(2, 0.5, 2.0, 2, "quad4");
  for (std::size_t k = 1; k < other.points.size(); k += 2) other.points[k] += 0.4;
  StickingOut out;
  embed(BoundarySimplices(other, other.side("left")), MeshSimplices(own),
        BoundarySimplices(own, FacetIndex(own).boundary()), out);
  EXPECT_NEAR(out.distance, 0.4, rounding);
  EXPECT_NEAR(out.at.y(), 1.4, rounding);
}

}  // namespace
}  // namespace abut::overlap_cells_tests
