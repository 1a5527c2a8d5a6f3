#include "coordinator/passive/crossing_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/count.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {

/// Of the shortest edge. Rows that hold on average let single nodes of curved or unlike meshes in
/// by parts of a cell: teeth of gears by up to 0.11 of it, all other shipped scenes by less than
/// 0.05.
constexpr double deep = 0.12;
/// Within a window, whatever the way: 12 edges.
constexpr int most_looks = 100;

}  // namespace

CrossingWatch::CrossingWatch(std::vector<TouchingPair> pairs, const Bodies& bodies)
    : pairs_(std::move(pairs)), bodies_(bodies) {
  std::erase_if(pairs_,
                [](const TouchingPair& pair) { return pair.sides[0].body == pair.sides[1].body; });
}

CrossingWatch::~CrossingWatch() = default;

std::string CrossingWatch::look() {
  if (pairs_.empty()) return {};
  if (surfaces_ == nullptr) {
    surfaces_ = std::make_unique<TouchingSurfaces>(pairs_, bodies_);
    trees_ = std::make_unique<SkinTrees>(surfaces_->skin(), surfaces_->reference());
    choice_ = surfaces_->choice();
  }
  const double step = deep * surfaces_->shortest_edge();
  const int parts =
      count_within(std::ceil(surfaces_->longest_way(bodies_.responses()) / step), 1, most_looks);
  for (int part = 1; part <= parts; ++part) {
    if (part == parts)
      surfaces_->place(bodies_.responses(), places_);
    else
      surfaces_->place_within(bodies_.responses(), part / double(parts), places_);
    intersections(*trees_, places_, step, choice_, found_);
    const auto is_new = [this](const Intersection& found) {
      return !std::ranges::binary_search(known_, found);
    };
    const auto first = std::ranges::find_if(found_, is_new);
    if (first != found_.end()) return name(*first);
  }
  known_ = found_;
  return {};
}

std::string CrossingWatch::name(const Intersection& found) const {
  const Skin& skin = surfaces_->skin();
  const std::int32_t edge = skin.dim == 2 ? skin.facets[found.edge][0] : skin.edges[found.edge][0];
  return fmt::format("an edge of body '{}' passes through the surface of body '{}'",
                     bodies_.describe((*surfaces_)[edge].body).name,
                     bodies_.describe((*surfaces_)[skin.facets[found.facet][0]].body).name);
}

void CrossingWatch::state(Archive& archive) {
  list(archive, "known", known_, [](Archive& a, Intersection& found) {
    whole(a, "edge", found.edge);
    whole(a, "facet", found.facet);
  });
}

}  // namespace abut
