#include "coordinator/overlap_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/archive_lists.hpp"
#include "base/index.hpp"
#include "coordinator/coupling/tied_wholes.hpp"
#include "surface/overlap_places.hpp"

namespace abut {

namespace {

/// Of a facet: what contact leaves, which averages over them, is less by far; round bodies whose
/// facets stand for them end up to 3 % of one in each other (shipped scenes).
constexpr double least_share = 0.1;
/// Facets behind an open surface: what is in its body is not farther off, as at the start.
constexpr double behind = 2.0;
/// Times what was told: told again.
constexpr double much_deeper = 2.0;
/// Unknowns of a body whose fields still fit into one reply.
constexpr std::int64_t most_unknowns = 1'000'000;

struct Depth {
  double depth = 0.0;                               // [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // [m]
};

double least_depth(const BodyHull& one, const BodyHull& other) {
  return least_share * std::min(one.size, other.size);
}

Depth depth_of(const BodyHull& one, const BodyHull& other) {
  Depth deepest;
  if (one.dim != other.dim || one.dim == 0 || !overlap(one.box, other.box)) return deepest;
  if (one.dim == 1) {
    const double low = std::max(one.box.low[0], other.box.low[0]);
    const double high = std::min(one.box.high[0], other.box.high[0]);
    return {high - low, {0.5 * (low + high), 0.0, 0.0}};
  }
  const double least = least_depth(one, other), reach = behind * std::max(one.size, other.size);
  const std::vector<OverlapPlace> places =
      overlap_places(one.surface(), other.surface(), {{least, least}, reach});
  if (!places.empty()) deepest = {places.front().depth, places.front().place};
  return deepest;
}

bool joins(const Joint& joint, std::pair<int, int> pair) {
  return std::minmax(joint.sides[0].body, joint.sides[1].body) ==
         std::pair<const int&, const int&>(pair.first, pair.second);
}

}  // namespace

void OverlapSearch::make(Bodies& bodies) {
  if (std::exchange(made_, true)) return;
  for (int b = 0; b < bodies.count(); ++b) {
    const Description& body = bodies.describe(b);
    const bool asked = !body.fields.empty() && body.dofs <= most_unknowns;
    hulls_.push_back(hull_of(body, asked ? bodies[b].grid() : Grid{}));
  }
}

void OverlapSearch::pose_all(Bodies& bodies) {
  for (int b = 0; b < bodies.count(); ++b) {
    BodyHull& hull = hulls_[b];
    if (hull.dim == 0) continue;
    if (hull.nodes.empty()) {
      const Waveform& trace = bodies.response(b).ports[hull.port].trace;
      const std::size_t width = hull.reference.size();
      pose(hull, std::span(trace.u).last(width));
      continue;
    }
    const std::vector<FieldInfo>& told = bodies.describe(b).fields;
    const auto field = std::ranges::find_if(told, [](const FieldInfo& info) {
      return info.name == "displacement" && info.place == FieldPlace::nodes && info.components == 3;
    });
    if (field == told.end()) {
      hull.dim = 0;
      continue;
    }
    pose(hull, bodies[b].fields().at(index(static_cast<int>(field - told.begin()))));
  }
}

/// Whether two bodies may overlap: they are one where they are tied, and what nothing joins, and
/// does not touch everything, may lie in one place from the start, as variants of one body do.
bool OverlapSearch::meant(std::pair<int, int> pair, std::span<const Joint> joints, bool all_touch) {
  bool joined = false;
  for (const Joint& joint : joints) {
    if (!joins(joint, pair)) continue;
    if (joint.tied()) return true;
    joined = true;
  }
  if (joined) return false;
  if (all_touch) {
    const std::vector<int> whole = tied_wholes(joints, static_cast<int>(hulls_.size()));
    if (whole[index(pair.first)] != whole[index(pair.second)]) return false;
  }
  BodyHull one = hulls_[pair.first], other = hulls_[pair.second];
  pose(one, {});
  pose(other, {});
  return depth_of(one, other).depth > least_depth(one, other);
}

/// [m] Wanted interference, not or not yet pressed in.
double OverlapSearch::fit(std::pair<int, int> pair, std::span<const Joint> joints) {
  constexpr double rounding = 1.01;  // places are of nodes, the fit is of averages
  double most = 0.0;
  for (const Joint& joint : joints)
    if (joins(joint, pair)) most = std::max(most, rounding * joint.fit);
  return most;
}

std::vector<Overlap> OverlapSearch::look(Bodies& bodies, std::span<const Joint> joints, double time,
                                         bool all_touch) {
  std::vector<Overlap> found;
  if (bodies.count() < 2) return found;
  make(bodies);
  pose_all(bodies);
  for (int a = 0; a < bodies.count(); ++a) {
    for (int b = a + 1; b < bodies.count(); ++b) {
      const BodyHull &one = hulls_[a], &other = hulls_[b];
      const Depth deepest = depth_of(one, other);
      if (!(deepest.depth > least_depth(one, other))) continue;
      if (deepest.depth <= fit({a, b}, joints)) continue;
      const auto told = told_.find({a, b});
      if (told != told_.end() && deepest.depth <= much_deeper * told->second) continue;
      if (told == told_.end() && meant({a, b}, joints, all_touch)) continue;
      told_[{a, b}] = deepest.depth;
      const Eigen::Vector3d& x = deepest.place;
      found.push_back({{a, b}, deepest.depth, {x[0], x[1], x[2]}, time});
    }
  }
  return found;
}

void OverlapSearch::state(Archive& archive) {
  std::vector<std::pair<std::pair<int, int>, double>> told(told_.begin(), told_.end());
  list(archive, "told", told, [](Archive& a, auto& overlap) {
    whole(a, "body", overlap.first.first);
    whole(a, "body", overlap.first.second);
    a.field("depth", overlap.second);
  });
  told_ = {told.begin(), told.end()};
}

}  // namespace abut
