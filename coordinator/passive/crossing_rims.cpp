#include "coordinator/passive/crossing_rims.hpp"

#include <algorithm>
#include <cmath>

#include "base/one_each.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {

/// An edge whose closest point is an end: a row of a node and a facet says the same.
constexpr double at_an_end = 1.0e-7;
/// Both edges look at each other along their normal: cosine at least.
constexpr double looks = 0.1;

}  // namespace

CrossingRims::CrossingRims(const TouchingSurfaces& surfaces, double thickness, FeatureChoice choice)
    : surfaces_(surfaces),
      thickness_(thickness),
      rounding_(on_surface * surfaces.shortest_edge()),
      choice_(std::move(choice)),
      sides_(surfaces.skin()) {}

bool CrossingRims::holds(const FeaturePair& pair) const {
  return pair.kind == FeatureKind::edge_edge && !pairs_.empty() &&
         std::ranges::binary_search(pairs_, pair.points);
}

/// Whether either side's facets look at the other one's, with both edges nearest inside.
bool CrossingRims::faces(const DistanceRow& row, const Places& places) const {
  const auto& p = row.features.points;
  if (std::ranges::any_of(row.weights, [](double w) { return std::abs(w) < at_an_end; }))
    return false;
  return row.normal.dot(sides_.edge_normal(places, p[0], p[1])) < -looks &&
         row.normal.dot(sides_.edge_normal(places, p[2], p[3])) > looks;
}

void CrossingRims::begin(SkinTrees& trees, const Places& places) {
  pairs_.clear();
  see(trees, places);
}

void CrossingRims::accept(SkinTrees& trees, const Places& places) {
  if (!pairs_.empty()) see(trees, places);
}

void CrossingRims::see(SkinTrees& trees, const Places& places) {
  if (surfaces_.skin().dim != 3) return;
  std::vector<Points> held;
  for (const Points& p : pairs_) {
    const std::optional<DistanceRow> row = edge_row(sides_, {p[0], p[1]}, {p[2], p[3]}, places);
    if (row && row->gap < out_by * thickness_ && faces(*row, places)) held.push_back(p);
  }
  near_features(trees, places, places, rounding_, choice_, near_);
  for (const FeaturePair& pair : near_) {
    if (pair.kind != FeatureKind::edge_edge) continue;
    const auto& p = pair.points;
    const EdgePoints one{p[0], p[1]}, other{p[2], p[3]};
    const std::optional<DistanceRow> row = edge_row(sides_, one, other, places);
    if (!row || std::abs(row->gap) > rounding_ || !faces(*row, places)) continue;
    const Eigen::Vector3d at =
        row->weights[0] * places[index(p[0])] + row->weights[1] * places[index(p[1])];
    if (is_rim(surfaces_, sides_, trees, places, one, at) &&
        is_rim(surfaces_, sides_, trees, places, other, at))
      held.push_back(p);
  }
  keep_one_each(held);
  pairs_ = std::move(held);
}

void CrossingRims::find(const Places& from, std::vector<DistanceRow>& rows) const {
  for (const Points& p : pairs_) {
    const bool there = std::ranges::any_of(rows, [&p](const DistanceRow& row) {
      return row.features.kind == FeatureKind::edge_edge && row.features.points == p;
    });
    if (there) continue;
    const std::optional<DistanceRow> row = edge_row(sides_, {p[0], p[1]}, {p[2], p[3]}, from);
    if (row && can_press(surfaces_, *row)) rows.push_back(held_behind(surfaces_, *row, from));
  }
}

int CrossingRims::check(const Places& from, const Places& to,
                        std::vector<DistanceRow>& rows) const {
  int deeper = 0;
  for (const Points& p : pairs_) {
    const EdgePoints one{p[0], p[1]}, other{p[2], p[3]};
    const std::optional<DistanceRow> then = edge_row(sides_, one, other, to);
    if (!then || !can_press(surfaces_, *then)) continue;
    DistanceRow row = *then;
    row.gap = gap_at(row, from);
    if (then->gap > std::min(row.gap, 0.0) - deeper_by * thickness_) continue;
    ++deeper;
    rows.push_back(held_behind(surfaces_, row, from));
  }
  return deeper;
}

void CrossingRims::state(Archive& archive) {
  list(archive, "crossing", pairs_, [](Archive& a, Points& pair) {
    for (std::int32_t& point : pair) whole(a, "point", point);
  });
}

}  // namespace abut
