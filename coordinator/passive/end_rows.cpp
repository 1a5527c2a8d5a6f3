#include "coordinator/passive/end_rows.hpp"

#include <algorithm>

namespace abut {

namespace {
constexpr double rounding_of_ends = 0.05;  // of the thickness: by so much rows may be missed
}

EndRows::EndRows(const TouchingSurfaces& surfaces, double thickness) : thickness_(thickness) {
  if (surfaces.skin().dim != 1) return;
  const auto count = static_cast<std::int32_t>(surfaces.count());
  for (std::int32_t a = 0; a < count; ++a)
    for (std::int32_t b = a + 1; b < count; ++b)
      if (surfaces.touch(surfaces.skin().group[index(a)], surfaces.skin().group[index(b)]))
        pairs_.push_back({a, b, surfaces.outward(a)});
}

void EndRows::find(const Places& from, double reach, std::vector<DistanceRow>& rows) const {
  for (const Pair& pair : pairs_)
    if (gap(pair, from) < reach) add(pair, from, rows);
}

void EndRows::find_on_ways(const Places& from, const Places& to,
                           std::vector<DistanceRow>& rows) const {
  for (const Pair& pair : pairs_)
    if (gap(pair, from) > thickness_ && gap(pair, to) < thickness_) add(pair, from, rows);
}

EndRows::Crossed EndRows::check(const Places& from, const Places& to,
                                std::vector<DistanceRow>& rows) const {
  Crossed crossed;
  for (const Pair& pair : pairs_) {
    const double least = std::min(0.0, gap(pair, from)) - rounding_of_ends * thickness_;
    if (gap(pair, to) >= least) continue;
    ++crossed.pairs;
    if (add(pair, from, rows)) ++crossed.added;
  }
  return crossed;
}

bool EndRows::add(const Pair& pair, const Places& from, std::vector<DistanceRow>& rows) const {
  const bool known = std::ranges::any_of(rows, [&pair](const DistanceRow& row) {
    return row.features.points[0] == pair.one && row.features.points[1] == pair.other;
  });
  if (known) return false;
  DistanceRow row;
  row.features.points = {pair.one, pair.other, -1, -1};
  row.weights = {1.0, -1.0, 0.0, 0.0};
  row.normal = {-pair.outward, 0.0, 0.0};
  row.gap = gap(pair, from);
  rows.push_back(row);
  return true;
}

}  // namespace abut
