#include "coordinator/passive/own_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {

namespace {

/// Of the thickness: what is nearer in the reference is a slit, or a sliver's height.
constexpr double slit = 2.0;
/// Searches before a body that was too near to itself is measured again: each costs as much.
constexpr int searches_between = 10;

}  // namespace

OwnGaps::OwnGaps(const TouchingSurfaces& surfaces, double thickness)
    : surfaces_(surfaces), others_(surfaces.choice()) {
  find_bodies();
  choice_ = others_;
  if (bodies_.empty()) return;
  SkinTrees trees(surfaces.skin(), surfaces.reference());
  const Places places = surfaces.reference();
  const double least = slit * thickness;
  for (const Body& body : bodies_) {
    near_features(trees, places, places, least, body.choice, pairs_);
    for (const FeaturePair& pair : pairs_)
      if (feature_distance(pair.kind, surfaces.skin().dim, abut::places(pair, places)).distance <
          least)
        left_out_.push_back(pair);
  }
  std::ranges::sort(left_out_);
}

/// Takes pairs of groups of one body out of the choice.
void OwnGaps::find_bodies() {
  const Skin& skin = surfaces_.skin();
  const FeatureChoice all = others_;
  std::vector<int> known;  // by place in bodies_
  for (int g = 0; g < skin.groups; ++g) {
    for (int h = 0; h < skin.groups; ++h) {
      const int body = surfaces_.port(g).body;
      const std::size_t at = index(g) * index(skin.groups) + index(h);
      if (surfaces_.port(h).body != body || all.allowed[at] == 0) continue;
      const auto found = std::ranges::find(known, body);
      const auto k = index(found - known.begin());
      if (found == known.end()) {
        known.push_back(body);
        Body& fresh = bodies_.emplace_back();
        fresh.choice.allowed.assign(all.allowed.size(), 0);
        fresh.choice.prescribed = all.prescribed;
      }
      bodies_[k].choice.allowed[at] = 1;
      bodies_[k].allowed.push_back(at);
      others_.allowed[at] = 0;
    }
  }
  for (std::size_t k = 0; k < known.size(); ++k) {
    Body& body = bodies_[k];
    const auto is_its = [&](std::int32_t point) { return surfaces_[point].body == known[k]; };
    std::ranges::copy_if(skin.nodes, std::back_inserter(body.nodes), is_its);
    body.edge = std::numeric_limits<double>::infinity();
    const auto see = [&](std::int32_t a, std::int32_t b) {
      const std::vector<Eigen::Vector3d>& x = surfaces_.reference();
      if (is_its(a)) body.edge = std::min(body.edge, (x[index(a)] - x[index(b)]).norm());
    };
    for (const auto& edge : skin.edges) see(edge[0], edge[1]);
    if (skin.dim == 2)
      for (const auto& facet : skin.facets) see(facet[0], facet[1]);
  }
}

const FeatureChoice& OwnGaps::choice(SkinTrees& trees, Places from, Places to, double reach) {
  for (Body& body : bodies_) {
    const auto may = static_cast<std::uint8_t>(may_meet(body, trees, from, to, reach) ? 1 : 0);
    for (const std::size_t at : body.allowed) choice_.allowed[at] = may;
  }
  return choice_;
}

bool OwnGaps::leaves_out(const FeaturePair& pair) const {
  return !left_out_.empty() && std::ranges::binary_search(left_out_, pair);
}

bool OwnGaps::may_meet(Body& body, SkinTrees& trees, Places from, Places to, double reach) {
  if (body.near > 0) return --body.near >= 0;
  if (!reaches(body, from, reach) && !reaches(body, to, reach)) return false;
  look(body, trees, from);
  if (!reaches(body, from, reach) && !reaches(body, to, reach)) return false;
  body.near = searches_between;
  return true;
}

/// Whether points may have come within reach of each other since the last look.
bool OwnGaps::reaches(const Body& body, Places places, double reach) {
  if (body.looked.empty()) return true;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < body.nodes.size(); ++k)
    mean += places[index(body.nodes[k])] - body.looked[k];
  mean /= static_cast<double>(body.nodes.size());
  double most = 0.0;
  for (std::size_t k = 0; k < body.nodes.size(); ++k)
    most = std::max(most, (places[index(body.nodes[k])] - body.looked[k] - mean).squaredNorm());
  return 2.0 * std::sqrt(most) + reach >= body.apart;
}

void OwnGaps::look(Body& body, SkinTrees& trees, Places places) {
  near_features(trees, places, places, body.edge, body.choice, pairs_);
  body.apart = body.edge;
  for (const FeaturePair& pair : pairs_) {
    if (leaves_out(pair)) continue;
    const FeatureDistance found =
        feature_distance(pair.kind, surfaces_.skin().dim, abut::places(pair, places));
    body.apart = std::min(body.apart, found.distance);
  }
  body.looked.clear();
  for (const std::int32_t node : body.nodes) body.looked.push_back(places[index(node)]);
}

}  // namespace abut
