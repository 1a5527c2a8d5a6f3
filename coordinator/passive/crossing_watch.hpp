#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "coordinator/passive/touching_surfaces.hpp"
#include "surface/intersections.hpp"

namespace abut {

/// Looks whether surfaces pass through each other in accurate windows, at their ends and at as many
/// instants before as the way of points asks for: rows of facets look at facets that face each
/// other, and sharp edges and spikes may face nothing.
class CrossingWatch {
 public:
  /// Of the pairs those of different bodies are watched (FoldWatch: the others).
  CrossingWatch(std::vector<TouchingPair> pairs, const Bodies& bodies);
  ~CrossingWatch();

  /// Of the latest replies: which bodies pass through each other by more than single nodes do
  /// between rows that hold on average, in words; empty: none, beside those that did at the last
  /// look. Precondition: traces hold displacements.
  std::string look();
  void state(Archive& archive);

 private:
  std::string name(const Intersection& found) const;

  std::vector<TouchingPair> pairs_;
  const Bodies& bodies_;
  std::unique_ptr<TouchingSurfaces> surfaces_;
  std::unique_ptr<SkinTrees> trees_;
  FeatureChoice choice_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<Intersection> found_, known_;
};

}  // namespace abut
