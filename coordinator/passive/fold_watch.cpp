#include "coordinator/passive/fold_watch.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/passive/near_rows.hpp"
#include "surface/feature_path.hpp"

namespace abut {

namespace {

/// Of the thickness: how exactly the moment is found at which a way comes within it.
constexpr double resolved_fold = 0.02;

}  // namespace

struct FoldWatch::Watched {
  Watched(std::span<const TouchingPair> pairs, const Bodies& bodies)
      : surfaces(pairs, bodies),
        thickness(thickness_share * surfaces.shortest_edge()),
        trees(surfaces.skin(), surfaces.reference()),
        gaps(surfaces, thickness) {}

  TouchingSurfaces surfaces;
  double thickness;  // [m]
  SkinTrees trees;
  OwnGaps gaps;
  std::vector<Eigen::Vector3d> left;  // [m] where its points were at the last look ahead
};

FoldWatch::FoldWatch(std::vector<TouchingPair> pairs, const Bodies& bodies)
    : pairs_(std::move(pairs)), bodies_(bodies) {
  std::erase_if(pairs_,
                [](const TouchingPair& pair) { return pair.sides[0].body != pair.sides[1].body; });
}

FoldWatch::~FoldWatch() = default;

std::string FoldWatch::look() {
  for (std::size_t begin = 0, end = 0; watched_.empty() && begin < pairs_.size(); begin = end) {
    while (end < pairs_.size() && pairs_[end].sides[0].body == pairs_[begin].sides[0].body) ++end;
    watched_.push_back(
        std::make_unique<Watched>(std::span(pairs_).subspan(begin, end - begin), bodies_));
  }
  for (const auto& body : watched_) {
    const Side& side = body->surfaces.port(0);
    const Waveform& trace = bodies_.response(side.body).ports[index(side.port)].trace;
    body->surfaces.place(bodies_.responses(), 0, from_);
    for (std::size_t k = 1; k < trace.size(); ++k, std::swap(from_, to_)) {
      body->surfaces.place(bodies_.responses(), k, to_);
      if (meets(*body))
        return fmt::format("the surface of body '{}' comes upon itself",
                           bodies_.describe(side.body).name);
    }
  }
  return {};
}

bool FoldWatch::apart(double times) {
  for (const auto& body : watched_) {
    const Side& side = body->surfaces.port(0);
    const Waveform& trace = bodies_.response(side.body).ports[index(side.port)].trace;
    body->surfaces.place(bodies_.responses(), 0, to_);
    body->surfaces.place(bodies_.responses(), trace.size() - 1, from_);
    for (std::size_t p = 0; p < to_.size(); ++p) to_[p] = from_[p] + times * (from_[p] - to_[p]);
    body->left = from_;
    if (meets(*body)) return false;
  }
  return true;
}

bool FoldWatch::still_apart() {
  for (const auto& body : watched_) {
    from_ = body->left;
    body->surfaces.place(bodies_.responses(), 0, to_);
    if (meets(*body)) return false;
  }
  return true;
}

/// Whether a surface comes within its thickness of itself, on its ways.
bool FoldWatch::meets(Watched& body) const {
  const int dim = body.surfaces.skin().dim;
  const FeatureChoice& choice = body.gaps.choice(body.trees, from_, to_, body.thickness);
  if (std::ranges::find(choice.allowed, 1) == choice.allowed.end()) return false;
  near_features(body.trees, from_, to_, body.thickness, choice, found_);
  return std::ranges::any_of(found_, [&](const FeaturePair& pair) {
    return !body.gaps.leaves_out(pair) &&
           first_time_within(pair.kind, dim, places(pair, from_), places(pair, to_), body.thickness,
                             resolved_fold * body.thickness) < 1.0;
  });
}

}  // namespace abut
