// Goal: where sharp edges and corners of two surfaces meet, one row of single points holds them.
// Oracles: closed forms of crossing ridges, of a corner over a face, of faces on each other.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "surface/meeting_corners.hpp"
#include "tests/support/surfaces.hpp"

namespace abut::surface_meeting_corners_tests {
namespace {

constexpr double tight = 1.0e-14;  // some roundings of lengths of 1

/// A roof at 45 degrees whose ridge is the x-axis from -1 to 2: facet 0 looks to +y, facet 1 to -y.
SurfaceMesh roof() {
  SurfaceMesh mesh;
  mesh.points = {-1, 0, 0, 2, 0, 0, -1, 1, -1, 2, 1, -1, -1, -1, -1, 2, -1, -1};
  mesh.add_facet({0, 1, 3, 2}, false);
  mesh.add_facet({1, 0, 4, 5}, false);
  return mesh;
}

Eigen::Matrix3d about(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(degrees * std::acos(-1.0) / 180.0, axis).toRotationMatrix();
}

struct Meeting {
  SurfaceMesh k, n;
  Wedges of_k{k.pose()}, of_n{n.pose()};
  MeetingCorners corners;
  SurfaceRows rows;

  Meeting(SurfaceMesh one, SurfaceMesh other) : k(std::move(one)), n(std::move(other)) {
    std::vector<FacetPair> pairs;
    for (std::int32_t a = 0; a < k.pose().facet_count(); ++a)
      for (std::int32_t b = 0; b < n.pose().facet_count(); ++b) pairs.push_back({a, b});
    corners.find({k.pose(), k.pose(), &of_k}, {n.pose(), n.pose(), &of_n}, pairs, {0.4, 0.0});
    rows.clear();
    rows.dim = k.dim;
    corners.join(rows);
  }
};

void expect_row(const SparseRows& rows, const std::vector<std::int32_t>& nodes,
                const std::vector<double>& shares) {
  EXPECT_EQ(rows.columns, nodes);
  ASSERT_EQ(rows.values.size(), shares.size());
  for (std::size_t i = 0; i < shares.size(); ++i) EXPECT_NEAR(rows.values[i], shares[i], tight);
}

TEST(MeetingCorners, HoldRidgesWhereTheyCross) {
  for (const double angle : {90.0, 60.0, 30.0})
    for (const double gap : {0.01, -0.01}) {
      const Eigen::Matrix3d turn = about(angle, {0, 0, 1}) * about(180.0, {1, 0, 0});
      const Meeting m(roof(), moved(roof(), turn, {0.5, 0.0, gap}));
      ASSERT_EQ(m.corners.count(), 1) << angle;
      ASSERT_EQ(m.rows.count(), 1);
      EXPECT_NEAR(m.rows.gaps[0], gap, tight);
      EXPECT_NEAR(m.rows.normals[2], -1.0, tight);  // out of N, which is above
      expect_row(m.rows.k, {0, 1}, {0.5, 0.5});
      expect_row(m.rows.n, {0, 1}, {2.0 / 3.0, 1.0 / 3.0});
      for (const FacetPair pair : {FacetPair{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
        const Eigen::Vector3d a = mean_normal(corners(m.k.pose(), pair.k));
        const Eigen::Vector3d b = mean_normal(corners(m.n.pose(), pair.n));
        EXPECT_EQ(m.corners.drops(pair), a.dot(b) <= -0.4) << angle;
      }
    }
}

TEST(MeetingCorners, LeaveFacesThatLieOnEachOtherToAverages) {
  // N's ridge lies on K's flank, and one of its flanks on it.
  const Meeting m(roof(), moved(roof(), about(180.0, {1, 0, 0}), {0.0, 0.5, -0.5}));
  EXPECT_EQ(m.corners.count(), 0);
  EXPECT_FALSE(m.corners.drops({0, 0}));
  EXPECT_FALSE(m.corners.drops({0, 1}));
}

TEST(MeetingCorners, LeaveEdgesThatAreFarAlone) {
  const Eigen::Matrix3d turn = about(90.0, {0, 0, 1}) * about(180.0, {1, 0, 0});
  const Meeting m(roof(), moved(roof(), turn, {0.5, 0.0, 0.5}));
  EXPECT_EQ(m.corners.count(), 0);
  // Beside each other: the crossing is beyond the ends of both.
  EXPECT_EQ(Meeting(roof(), moved(roof(), turn, {9.0, 0.0, 0.01})).corners.count(), 0);
}

TEST(MeetingCorners, HoldACornerBeforeAFaceThatEndsInOne) {
  SurfaceMesh needle, square;
  needle.dim = square.dim = 2;
  for (const double gap : {0.02, -0.02}) {
    needle.points = {0.1 - 0.36, 1.0 + gap, 0.1, gap, 0.1 + 0.36, 1.0 + gap};
    needle.facets = {0, 1, 1, 2};
    square.points = {1, 0, 0, 0, 0, -1};
    square.facets = {0, 1, 1, 2};
    needle.offsets = square.offsets = {0, 2, 4};
    const Meeting finds(needle, square), found(square, needle);
    ASSERT_EQ(finds.rows.count(), 1);
    EXPECT_NEAR(finds.rows.gaps[0], gap, tight);
    EXPECT_NEAR(finds.rows.normals[1], 1.0, tight);
    expect_row(finds.rows.k, {1}, {1.0});
    expect_row(finds.rows.n, {0, 1}, {0.1, 0.9});
    ASSERT_EQ(found.rows.count(), 1);
    EXPECT_NEAR(found.rows.gaps[0], gap, tight);
    EXPECT_NEAR(found.rows.normals[1], -1.0, tight);
    expect_row(found.rows.k, {0, 1}, {0.1, 0.9});
    expect_row(found.rows.n, {1}, {1.0});
  }
}

/// The looks at one substep's end have its begin in common: planes of it are looked for once, and
/// rows are to the last bit those that a look by itself finds.
TEST(MeetingCorners, LookForPlanesOfOnePlaceOnce) {
  const Eigen::Matrix3d turn = about(60.0, {0, 0, 1}) * about(180.0, {1, 0, 0});
  const SurfaceMesh k = roof(), before = moved(roof(), turn, {0.5, 0.0, 0.03});
  const Wedges of_k(k.pose()), of_n(before.pose());
  std::vector<FacetPair> pairs;
  for (std::int32_t a = 0; a < 2; ++a)
    for (std::int32_t b = 0; b < 2; ++b) pairs.push_back({a, b});
  const auto look = [&](MeetingCorners& corners, double now, double from) {
    const SurfaceMesh n = moved(roof(), turn, {0.5, 0.0, now}),
                      began = moved(roof(), turn, {0.5, 0.0, from});
    SurfaceRows rows;
    rows.clear();
    rows.dim = 3;
    corners.find({k.pose(), k.pose(), &of_k}, {n.pose(), began.pose(), &of_n}, pairs, {0.4, 0.05});
    corners.join(rows);
    EXPECT_EQ(rows.count(), 1);
    std::vector<double> told = rows.gaps;
    told.insert(told.end(), rows.normals.begin(), rows.normals.end());
    told.insert(told.end(), rows.n.values.begin(), rows.n.values.end());
    return told;
  };
  MeetingCorners several;
  look(several, 0.02, 0.03);
  const std::size_t searches = several.searches();
  EXPECT_GT(searches, 0u);
  for (const double now : {0.01, -0.01, 0.0}) {
    MeetingCorners alone;
    EXPECT_EQ(look(several, now, 0.03), look(alone, now, 0.03)) << now;
    EXPECT_EQ(several.searches(), searches) << now;
  }
  MeetingCorners alone;
  EXPECT_EQ(look(several, 0.02, 0.01), look(alone, 0.02, 0.01));  // of another place
  EXPECT_EQ(several.searches(), 2 * searches);
}

}  // namespace
}  // namespace abut::surface_meeting_corners_tests
