#include "coordinator/passive/behind_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "base/one_each.hpp"
#include "coordinator/coupling/state_fields.hpp"
#include "coordinator/passive/edge_row.hpp"

namespace abut {

namespace {

/// A facet faces a point where its normal and the point's are apart by more than that: cosine.
constexpr double facing = -0.1;
/// Of how deep a point is behind a facet: one that is as far beside it is not behind it.
constexpr double beside = 0.5;
/// The way out of the step before goes on where directions are apart by less than that: cosine.
constexpr double same_way = 0.3;
/// Ways out that go on so are before those through facets that face the point, and others.
constexpr int same_way_rank = 3;
/// Ways out are looked for so many times as far as the deepest goes: the nearest facet need not be
/// the one through which something came.
constexpr double farther = 2.0;

using Edge = EdgePoints;

/// Groups whose surfaces end nowhere: all sides of facets are shared.
std::vector<std::uint8_t> closed_groups(const Skin& skin) {
  std::vector<std::uint8_t> closed(index(skin.groups), 1);
  std::vector<Edge> sides;
  for (const auto& f : skin.facets) {
    if (skin.dim == 2) {
      sides.insert(sides.end(), {{f[0], -1}, {f[1], -1}});
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i)
      sides.push_back({std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3])});
  }
  std::ranges::sort(sides);
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    while (next < sides.size() && sides[next] == sides[i]) ++next;
    if (next - i < 2) closed[index(skin.group[index(sides[i][0])])] = 0;
  }
  return closed;
}

/// Of a pair's facet; as long as that is large.
Eigen::Vector3d facet_normal(int dim, const FeaturePoints& x) {
  const Eigen::Vector3d u = x[2] - x[1];
  return dim == 2 ? Eigen::Vector3d(u.y(), -u.x(), 0.0) : u.cross(x[3] - x[1]);
}

}  // namespace

BehindRows::BehindRows(const TouchingSurfaces& surfaces, double thickness, FeatureChoice choice)
    : surfaces_(surfaces),
      thickness_(thickness),
      rounding_(on_surface * surfaces.shortest_edge()),
      choice_(std::move(choice)),
      sides_(surfaces.skin()),
      closed_(closed_groups(surfaces.skin())) {}

const BehindRows::Behind* BehindRows::known(Edge points, std::int32_t group) const {
  if (flags_[index(points[0])] == 0) return nullptr;
  const auto found = std::ranges::lower_bound(behind_, std::pair(points, group), {}, &Behind::key);
  const bool is_it = found != behind_.end() && found->key() == std::pair(points, group);
  return is_it ? &*found : nullptr;
}

bool BehindRows::leaves_out(Edge edge, std::int32_t group) const {
  return known({edge[0], -1}, group) != nullptr || known({edge[1], -1}, group) != nullptr ||
         (any_edges_ && known(edge, group) != nullptr);
}

bool BehindRows::holds(const FeaturePair& pair) const {
  if (behind_.empty()) return false;
  const auto& p = pair.points;
  const std::vector<std::int32_t>& group = surfaces_.skin().group;
  if (pair.kind == FeatureKind::node_facet) return known({p[0], -1}, group[index(p[1])]) != nullptr;
  return leaves_out({p[0], p[1]}, group[index(p[2])]) ||
         leaves_out({p[2], p[3]}, group[index(p[0])]);
}

void BehindRows::let_beside(const FeaturePair& pair) {
  const auto& p = pair.points;
  const std::int32_t other = pair.kind == FeatureKind::node_facet ? -1 : p[1];
  const std::int32_t group = surfaces_.skin().group[index(p[index(pair.first_side())])];
  beside_.push_back({.points = {p[0], other}, .group = group, .comes = true});
}

/// Of a point those to facets that look along its way out, or aside: it is not to leave through the
/// other side, where what it belongs to would stay stuck. Of an edge those to edges that it does
/// not pass on their outer side: one with an end behind would cut deeper into a rim beside it.
bool BehindRows::leaves_out(const SkinTrees& trees, const FeaturePair& pair,
                            const Places& places) const {
  if (behind_.empty()) return false;
  if (pair.kind == FeatureKind::edge_edge)
    return holds(pair) && !passes_outside(trees, pair, places);
  const auto& p = pair.points;
  const Behind* what = known({p[0], -1}, surfaces_.skin().group[index(p[1])]);
  if (what == nullptr) return false;
  const FeaturePoints x = abut::places(pair, places);
  const Eigen::Vector3d normal = facet_normal(surfaces_.skin().dim, x);
  if (normal.dot(what->out) > -same_way * normal.norm()) return true;
  return feature_distance(pair.kind, surfaces_.skin().dim, x).distance <= rounding_;
}

/// Whether an edge with an end behind a surface passes a rim of that one outside of it: on both
/// ways between them, where they are nearest to each other.
bool BehindRows::passes_outside(const SkinTrees& trees, const FeaturePair& pair,
                                const Places& places) const {
  const Edge first{pair.points[0], pair.points[1]}, second{pair.points[2], pair.points[3]};
  const std::int32_t one = surfaces_.skin().group[index(first[0])];
  const std::int32_t other = surfaces_.skin().group[index(second[0])];
  if (known(first, other) != nullptr || known(second, one) != nullptr) return false;
  const FeaturePoints x = abut::places(pair, places);
  const FeatureDistance found = feature_distance(pair.kind, 3, x);
  if (found.distance <= rounding_) return false;
  const auto& w = found.weights;
  const Eigen::Vector3d at = w[0] * x[0] + w[1] * x[1], there = -w[2] * x[2] - w[3] * x[3];
  const bool rim =
      (leaves_out(first, other) && is_rim(surfaces_, sides_, trees, places, second, there)) ||
      (leaves_out(second, one) && is_rim(surfaces_, sides_, trees, places, first, at));
  return rim && side_of(trees, places, at, other).gap > rounding_ &&
         side_of(trees, places, there, one).gap > rounding_;
}

// ---- what is behind -----------------------------------------------------------------------------

void BehindRows::begin(SkinTrees& trees, const Places& places) {
  behind_.clear();
  flags_.assign(surfaces_.count(), 0);
  trees.refit(places, places);
  add_points(trees, places);
  std::vector<Behind> all = behind_;
  if (surfaces_.skin().dim == 3) {
    take(all);
    const std::vector<Behind> edges = edges_through(trees, places, rounding_);
    all.insert(all.end(), edges.begin(), edges.end());
  }
  reach_ = surfaces_.shortest_edge();
  for (const Behind& each : all) reach_ = std::max(reach_, farther * std::abs(each.gap));
  take(std::move(all));
}

void BehindRows::add_points(const SkinTrees& trees, const Places& places) {
  const Skin& skin = surfaces_.skin();
  for (const std::int32_t node : skin.nodes) {
    for (int group = 0; group < skin.groups; ++group) {
      const int own = skin.group[index(node)];
      if (group == own || !choice_.allows(own, group, skin.groups)) continue;
      Behind what{.points = {node, -1}, .group = group};
      const SignedSide side = side_of(trees, places, what);
      if (!(side.gap < rounding_) || is_before_another(trees, places, what, -side.gap)) continue;
      what.gap = side.gap;
      behind_.push_back(what);
    }
  }
}

/// What is behind the outer surface of a ring may be in its hole: before the inner one, which is
/// nearer.
bool BehindRows::is_before_another(const SkinTrees& trees, const Places& places, Behind what,
                                   double depth) const {
  const int body = surfaces_.port(what.group).body, behind = what.group;
  for (what.group = 0; what.group < surfaces_.groups(); ++what.group) {
    if (what.group == behind || surfaces_.port(what.group).body != body) continue;
    if (closed_[index(what.group)] == 0) continue;
    const double gap = side_of(trees, places, what).gap;
    if (gap > 0.0 && gap < depth) return true;
  }
  return false;
}

/// Of a surface that ends somewhere only so far as its facets are long: what is behind it is not
/// always in its body.
SignedSide BehindRows::side_of(const SkinTrees& trees, const Places& places,
                               const Eigen::Vector3d& x, std::int32_t group) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double reach = closed_[index(group)] != 0 ? infinity : surfaces_.shortest_edge();
  const std::int32_t facet = trees.closest_facet(group, places, x, reach);
  SignedSide side;
  side.gap = infinity;
  if (facet < 0) return side;
  side = sides_.side(places, x, std::span(&facet, 1));
  if (side.border && side.gap > rounding_) side.gap = infinity;
  return side;
}

SignedSide BehindRows::side_of(const SkinTrees& trees, const Places& places,
                               const Behind& what) const {
  return side_of(trees, places, places[index(what.points[0])], what.group);
}

/// Whether a point is inside, or nearer than `least`, or has passed to another side than that
/// through which it came.
bool BehindRows::stays(const SkinTrees& trees, const Places& places, const Behind& what,
                       const WayOut& way, double least) const {
  const SignedSide side = side_of(trees, places, what);
  if (side.gap < least) return true;
  return side.facet >= 0 && way.rank == same_way_rank && way.row.gap < -rounding_ &&
         side.normal.dot(what.out) < -same_way;
}

void BehindRows::take(std::vector<Behind> behind) {
  behind_ = std::move(behind);
  std::ranges::sort(behind_, {}, &Behind::key);
  flags_.assign(surfaces_.count(), 0);
  any_edges_ = false;
  for (const Behind& each : behind_) {
    for (const std::int32_t point : each.points)
      if (point >= 0) flags_[index(point)] = 1;
    any_edges_ = any_edges_ || each.is_edge();
  }
}

/// Edges that pass through facets, or come nearer to edges than `least`, with no end behind.
std::vector<BehindRows::Behind> BehindRows::edges_through(SkinTrees& trees, const Places& places,
                                                          double least) {
  const Skin& skin = surfaces_.skin();
  std::vector<Behind> edges;
  const auto add = [&](const Edge& edge, std::int32_t group) {
    if (leaves_out(edge, group)) return;
    edges.push_back({.points = edge, .group = group});
  };
  intersections(trees, places, rounding_, choice_, crossing_);
  for (const Intersection& each : crossing_)
    add(skin.edges[index(each.edge)], skin.group[index(skin.facets[index(each.facet)][0])]);
  near_features(trees, places, places, least, choice_, pairs_);
  for (const FeaturePair& pair : pairs_) {
    if (pair.kind != FeatureKind::edge_edge || leaves_out(trees, pair, places)) continue;
    if (feature_distance(pair.kind, skin.dim, abut::places(pair, places)).distance > least)
      continue;
    add({pair.points[0], pair.points[1]}, skin.group[index(pair.points[2])]);
  }
  keep_one_each(edges, &Behind::key);
  return edges;
}

void BehindRows::accept(SkinTrees& trees, const Places& places) {
  if (behind_.empty()) return;
  const Skin& skin = surfaces_.skin();
  keep_one_each(beside_, &Behind::key);
  std::erase_if(beside_,
                [this](const Behind& each) { return known(each.points, each.group) != nullptr; });
  behind_.insert(behind_.end(), beside_.begin(), beside_.end());
  beside_.clear();
  take(std::move(behind_));
  gather(trees, places, places);
  std::vector<Behind> still;
  for (std::size_t k = 0; k < behind_.size(); ++k) {
    Behind& what = behind_[k];
    const WayOut way = way_out(k, places);
    const double least = what.comes ? rounding_ : out_by * thickness_;
    const bool inside = !what.is_edge() && stays(trees, places, what, way, least);
    what.comes = false;
    hold(what, way);
    if (inside) still.push_back(what);
  }
  if (skin.dim == 2) return take(std::move(still));
  std::vector<Behind> before = behind_;
  take(still);
  std::vector<Behind> edges = edges_through(trees, places, out_by * thickness_);
  take(std::move(before));
  std::erase_if(edges, [this](const Behind& edge) { return !leaves_out(edge.points, edge.group); });
  for (Behind& edge : edges)
    if (const Behind* same = known(edge.points, edge.group)) edge = *same;
  still.insert(still.end(), edges.begin(), edges.end());
  take(std::move(still));
}

// ---- ways out -----------------------------------------------------------------------------------

/// Facets and edges that are near what is behind them.
void BehindRows::gather(SkinTrees& trees, const Places& from, const Places& to) {
  const Skin& skin = surfaces_.skin();
  around_.resize(std::max(around_.size(), behind_.size()));
  for (std::vector<std::int32_t>& features : around_) features.clear();
  trees.refit(from, to);
  const auto put = [this](const Behind* what, std::int32_t feature) {
    if (what != nullptr) around_[index(what - behind_.data())].push_back(feature);
  };
  for (int a = 0; a < skin.groups; ++a) {
    for (int b = 0; b < skin.groups; ++b) {
      if (a == b || !choice_.allows(a, b, skin.groups)) continue;
      trees.visit(SkinTrees::nodes, a, SkinTrees::facets, b, reach_,
                  [&](std::int32_t node, std::int32_t facet) {
                    put(known({skin.nodes[index(node)], -1}, b), facet);
                  });
      if (any_edges_)
        trees.visit(SkinTrees::edges, a, SkinTrees::edges, b, reach_,
                    [&](std::int32_t one, std::int32_t other) {
                      put(known(skin.edges[index(one)], b), other);
                    });
    }
  }
  for (std::size_t k = 0; k < behind_.size(); ++k) std::ranges::sort(around_[k]);
}

/// That of the step before as long as there is one like it; else through a facet that faces the
/// point; else the shortest one, unless a nearer facet has the point on it or before it.
BehindRows::WayOut BehindRows::way_out(std::size_t k, const Places& places) const {
  WayOut best;
  for (const std::int32_t feature : around_[k]) {
    if (behind_[k].is_edge())
      see_edge(behind_[k], surfaces_.skin().edges[index(feature)], places, best);
    else
      see_facet(behind_[k], feature, places, best);
  }
  // A corner that lies on another one has no facet before it, and is not as deep as the body is.
  if (best.rank == 1 && !behind_[k].is_edge() && best.distance > best.nearest + rounding_)
    best.rank = 0;
  return best;
}

void BehindRows::see_facet(const Behind& what, std::int32_t facet, const Places& places,
                           WayOut& best) const {
  const Skin& skin = surfaces_.skin();
  const auto& f = skin.facets[index(facet)];
  WayOut way;
  way.row.features = {FeatureKind::node_facet, {what.points[0], f[0], f[1], f[2]}};
  const FeaturePoints x = abut::places(way.row.features, places);
  const FeatureDistance found = feature_distance(FeatureKind::node_facet, skin.dim, x);
  const Eigen::Vector3d normal = sides_.facet_normal(places, facet);
  const Eigen::Vector3d difference = found.difference(x);
  way.distance = found.distance;
  way.nearest = best.nearest = std::min(best.nearest, found.distance);
  way.row.weights = found.weights;
  way.row.normal = normal;
  way.row.gap = normal.dot(difference);
  if (way.row.gap > thickness_ || normal.isZero()) return;
  way.against = sides_.point_normal(places, what.points[0]).dot(normal);
  const double aside = (difference - way.row.gap * normal).norm();
  const bool beyond = aside > std::max(rounding_, beside * std::abs(way.row.gap));
  if (!beyond && normal.dot(what.out) > same_way) {
    way.rank = same_way_rank;
  } else if (!beyond && way.against <= facing) {
    way.rank = 2;
  } else if (way.row.gap < -rounding_) {
    way.rank = 1;
    way.row.normal = -difference / way.distance;
    way.row.gap = -way.distance;
  } else {
    return;  // on it, side by side
  }
  const bool farther_off = way.distance > best.distance + rounding_;
  const bool as_far = way.distance > best.distance - rounding_;
  if (way.rank < best.rank ||
      (way.rank == best.rank && (farther_off || (as_far && way.against >= best.against))))
    return;
  best = way;
}

void BehindRows::see_edge(const Behind& what, const std::array<std::int32_t, 2>& edge,
                          const Places& places, WayOut& best) const {
  if (edge[1] < 0) return;  // none is known yet
  const std::optional<DistanceRow> row = edge_row(sides_, what.points, edge, places);
  if (!row || row->gap > thickness_) return;
  // Nothing leaves a body over the line between two facets of a flat face.
  if (row->gap < -thickness_ && sides_.fold(places, edge[0], edge[1]) > half_a_rim) return;
  WayOut way;
  way.row = *row;
  way.distance = std::abs(row->gap);
  way.rank = row->normal.dot(what.out) > same_way ? same_way_rank : 1;
  if (way.rank < best.rank || (way.rank == best.rank && way.distance >= best.distance)) return;
  best = way;
}

void BehindRows::find(SkinTrees& trees, const Places& from, std::vector<DistanceRow>& rows) {
  beside_.clear();
  if (behind_.empty()) return;
  gather(trees, from, from);
  for (std::size_t k = 0; k < behind_.size(); ++k) {
    const WayOut way = way_out(k, from);
    hold(behind_[k], way);
    if (way.rank > 0 && can_press(surfaces_, way.row))
      rows.push_back(held_behind(surfaces_, way.row, from));
  }
}

void BehindRows::hold(Behind& what, const WayOut& way) {
  if (way.rank == 0) return;
  what.gap = way.row.gap;
  what.out = way.row.normal;
  what.edge = {way.row.features.points[2], way.row.features.points[3]};
}

int BehindRows::check(SkinTrees& trees, const Places& from, const Places& to,
                      std::vector<DistanceRow>& rows) {
  if (behind_.empty()) return 0;
  gather(trees, from, to);
  int deeper = 0;
  for (std::size_t k = 0; k < behind_.size(); ++k) {
    const Behind& what = behind_[k];
    WayOut way;
    if (what.is_edge())
      see_edge(what, what.edge, to, way);
    else
      way = way_out(k, to);
    if (way.rank == 0 || !can_press(surfaces_, way.row)) continue;
    if (!what.is_edge() && !stays(trees, to, what, way, 0.0)) continue;
    const double gap = way.row.gap;
    way.row.gap = gap_at(way.row, from);
    if (gap > std::min(way.row.gap, 0.0) - deeper_by * thickness_) continue;
    ++deeper;
    rows.push_back(held_behind(surfaces_, way.row, from));
  }
  return deeper;
}

void BehindRows::state(Archive& archive) {
  archive.field("reach", reach_);
  std::vector<Behind> all = behind_;
  list(archive, "behind", all, [](Archive& a, Behind& what) {
    for (std::int32_t& point : what.points) whole(a, "point", point);
    whole(a, "group", what.group);
    a.field("gap", what.gap);
    for (double& part : what.out) a.field("out", part);
  });
  if (!archive.writing()) take(std::move(all));
}

}  // namespace abut
