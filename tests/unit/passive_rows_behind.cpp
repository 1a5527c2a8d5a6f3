// Goal: what is behind a partner's surface when the passive way begins goes no deeper, not through
// the other side and not along another feature's way, and can come out. Oracles: places by hand.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/passive/near_rows.hpp"
#include "tests/support/solid_texts.hpp"

namespace abut::passive_rows_behind_tests {
namespace {

using Vector = Eigen::Vector3d;

constexpr double rounding = 1.0e-12;  // of places of about 1 m
constexpr double root = 0.5 * std::numbers::sqrt2;
constexpr double depth = 0.1;  // [m] at the begin

/// Two rigid bodies and the rows between them, in places that are told.
class Pair {
 public:
  Pair(const SolidText& one, const SolidText& other, double friction = 0.0)
      : one_(build(one)),
        other_(build(other)),
        bodies_({one_.get(), other_.get()}),
        surfaces_(std::vector<TouchingPair>{{{Side{0, 0}, Side{1, 0}}, friction}}, bodies_),
        near_(surfaces_, thickness_share * surfaces_.shortest_edge()) {}

  /// All places, with the second body moved.
  std::vector<Vector> moved(const Vector& by) const {
    std::vector<Vector> places = surfaces_.reference();
    for (Vector& place : places) place.y() *= squeezed;
    for (std::size_t p = 0; p < places.size(); ++p)
      if (surfaces_[static_cast<std::int32_t>(p)].body == 1) places[p] += by;
    return places;
  }
  std::vector<DistanceRow> begin(const Vector& by) {
    near_.begin(moved(by));
    std::vector<DistanceRow> rows;
    near_.find(moved(by), rows);
    return rows;
  }
  /// Rows of the next step, after one that ends there.
  std::vector<DistanceRow> after(const Vector& by) {
    near_.accept(moved(by));
    std::vector<DistanceRow> rows;
    near_.find(moved(by), rows);
    return rows;
  }
  int offended(const Vector& from, const Vector& to) {
    std::vector<DistanceRow> rows;
    near_.find(moved(from), rows);
    return near_.check(moved(from), moved(to), rows).pairs;
  }

  double squeezed = 1.0;  // of heights

 private:
  std::unique_ptr<Subdomain> one_, other_;
  Bodies bodies_;
  TouchingSurfaces surfaces_;
  NearRows near_;
};

SolidText rigid(const std::string& name, const std::string& side, const std::string& keys,
                const std::vector<double>& lengths, const std::vector<int>& cells) {
  return {.name = name,
          .material = unit_law("linear_elastic", 0.3),
          .integrator = "rigid_motion: {step: 0.1}",
          .side = side,
          .model = "rigid",
          .keys = keys,
          .block = {lengths, cells}};
}

/// A plate of one cell, 0.5 m thick, and a square that stands on its corner.
Pair tip_on_plate(const std::string& side, double friction = 0.0) {
  const std::string turned =
      fmt::format("map: [\"{0} * (x - y)\", \"{0} * (x + y)\"], ", number(root));
  return {rigid("plate", side, "", {4.0, 0.5}, {4, 1}),
          rigid("tip", "boundary", turned, {1.0, 1.0}, {1, 1}), friction};
}

/// Unit impulses of a row, in all of its directions, have no sum and no moment together.
void expect_balanced(const DistanceRow& row, const std::vector<Vector>& places, int dim) {
  for (int direction = 0; direction < dim; ++direction) {
    Vector sum = Vector::Zero(), moment = Vector::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      if (!row.counts(i)) continue;
      const Vector share = row.share_on(i, direction);
      sum += share;
      moment += places[index(row.features.points[i])].cross(share);
    }
    EXPECT_LT(sum.norm(), rounding) << direction;
    EXPECT_LT(moment.norm(), rounding) << direction;
  }
}

const Vector tip(2.2, 0.5 - depth, 0.0);  // of that corner

TEST(RowsBehind, HoldATipWhereItCameIn) {
  Pair pair = tip_on_plate("boundary");
  const std::vector<DistanceRow> rows = pair.begin(tip);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].behind);
  EXPECT_NEAR(rows[0].normal.y(), 1.0, rounding);
  EXPECT_NEAR(rows[0].gap, -depth, rounding);
  EXPECT_EQ(pair.offended(tip, tip + Vector(0, 0.3, 0)), 0);   // out
  EXPECT_EQ(pair.offended(tip, tip + Vector(0.1, 0, 0)), 0);   // along
  EXPECT_GT(pair.offended(tip, tip - Vector(0, 0.05, 0)), 0);  // deeper
  EXPECT_GT(pair.offended(tip, tip - Vector(0, 0.6, 0)), 0);   // through
  EXPECT_GT(pair.offended(tip, tip - Vector(3.0, 0, 0)), 0);   // a plate's node in it
}

/// Its friction acts on sides that are apart by as much as it is behind.
TEST(RowsBehind, HaveNoMomentOfFriction) {
  Pair pair = tip_on_plate("boundary", 0.5);
  const std::vector<DistanceRow> rows = pair.begin(tip);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].coupled);
  expect_balanced(rows[0], pair.moved(tip), 2);
}

/// Nothing is behind what it has come out of.
TEST(RowsBehind, EndOutside) {
  Pair pair = tip_on_plate("boundary");
  pair.begin(tip);
  const Vector outside(2.2, 0.7, 0.0);
  EXPECT_TRUE(pair.begin(outside).empty());
  EXPECT_GT(pair.offended(outside, tip), 0);
}

/// The only surface that is told looks the way that the tip goes.
TEST(RowsBehind, HoldAlongTheShortestWayWhereNothingFaces) {
  Pair pair = tip_on_plate("bottom");
  const Vector low(2.2, depth, 0.0);
  const std::vector<DistanceRow> rows = pair.begin(low);
  const auto lowest = std::ranges::max_element(rows, {}, &DistanceRow::gap);
  ASSERT_NE(lowest, rows.end());
  EXPECT_NEAR(lowest->normal.y(), -1.0, rounding);
  EXPECT_NEAR(lowest->gap, -depth, rounding);
}

/// A corner beside another one that comes up along it, with no facet before it, is as deep as
/// nothing: the lower facet of the plate's right side, whose plane goes outside of that corner as
/// the side bulges, is no way out.
TEST(RowsBehind, AreNotAsDeepAsTheBodyWhereCornersMeet) {
  const std::string bulges = "map: [\"x + 1.0e-5 * y * (0.5 - y)\", \"y\"], ";
  Pair pair{rigid("plate", "boundary", bulges, {1.0, 0.5}, {1, 2}),
            rigid("block", "boundary", "", {1.0, 0.5}, {1, 1})};
  pair.squeezed = 0.9;  // so that the lower facet is within an edge's first length
  pair.begin(Vector(1.0, 0.0, 0.0));
  for (const DistanceRow& row : pair.after(Vector(1.0 + 1.0e-7, 1.0e-6, 0.0)))
    EXPECT_GT(row.gap, -1.0e-6);
}

/// Two edges through each other, all of whose ends are outside.
TEST(RowsBehind, HoldEdgesInSpace) {
  // Local z along (0, -1, 1), the edge at x = y = 0 opposite to (0, 1, 1): see the normals below.
  const std::string turned = fmt::format(
      "map: [\"{0} * (x - y)\", \"0.5 * (x + y) - {0} * (z - 1)\", \"0.5 * (x + y) + {0} * (z - "
      "1)\"], ",
      number(root));
  Pair pair{rigid("bar", "boundary", "", {2.0, 1.0, 1.0}, {1, 1, 1}),
            rigid("other", "boundary", turned, {1.0, 1.0, 2.0}, {1, 1, 1}), 0.5};
  const Vector out(0.0, root, root);
  const Vector crossed = Vector(1.1, 1.0, 1.0) - depth * out;
  const std::vector<DistanceRow> rows = pair.begin(crossed);
  int found = 0;
  for (const DistanceRow& row : rows) {
    if (row.features.kind != FeatureKind::edge_edge || !row.behind) continue;
    ++found;
    EXPECT_NEAR(std::abs(row.normal.dot(out)), 1.0, rounding);
    EXPECT_NEAR(row.gap, -depth, rounding);
    expect_balanced(row, pair.moved(crossed), 3);
  }
  EXPECT_GT(found, 0);
  EXPECT_EQ(pair.offended(crossed, crossed + 0.3 * out), 0);
  EXPECT_EQ(pair.offended(crossed, crossed + Vector(0.1, 0, 0)), 0);
  EXPECT_GT(pair.offended(crossed, crossed - 0.1 * out), 0);
  EXPECT_GT(pair.offended(crossed, crossed - 0.8 * out), 0);
}

/// A box stands on an edge in a plate, beside a rim of it: one of its faces goes up outside of the
/// rim. What is behind must not cut the rim on its way out.
TEST(RowsBehind, KeepFacesOffRimsBesideThem) {
  const double part = 1.0 / std::sqrt(5.0);  // that face climbs by 2 on 1
  const std::string turned =
      fmt::format("map: [\"{0} * (x - 2 * z)\", \"y\", \"{0} * (2 * x + z)\"], ", number(part));
  Pair pair{rigid("plate", "boundary", "", {1.0, 1.0, 0.5}, {1, 1, 1}),
            rigid("box", "boundary", turned, {1.0, 0.5, 1.0}, {1, 1, 1})};
  const Vector inside(0.9, 0.25, 0.5 - depth);  // the rim is at x = 1, which the face passes at .6
  EXPECT_FALSE(pair.begin(inside).empty());
  EXPECT_EQ(pair.offended(inside, inside + Vector(0, 0, 0.2)), 0);
  EXPECT_GT(pair.offended(inside, inside + Vector(0.08, 0, 0)), 0);
}

}  // namespace
}  // namespace abut::passive_rows_behind_tests
