#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/archive.hpp"
#include "coordinator/body_hull.hpp"
#include "coordinator/coupling/joint.hpp"
#include "coordinator/record/observer.hpp"

namespace abut {

/// Looks for bodies that are in each other, whatever their ports are and whoever joins them: by
/// boxes first, then by the places that their outsides share (surface/overlap_places.hpp). Asks
/// bodies for grids and displacements, in states that the run has accepted; changes nothing.
class OverlapSearch {
 public:
  /// Pairs that overlap by more than a part of their facets and were not told before, or only half
  /// as deep. Not told: bodies that are tied to each other, and those that no interface joins and
  /// that overlapped in the reference as well. Of bodies of more than a million unknowns the
  /// largest port is looked at.
  /// `all_touch`: all bodies may touch each other.
  std::vector<Overlap> look(Bodies& bodies, std::span<const Joint> joints, double time,
                            bool all_touch);

  void state(Archive& archive);  // what was told

 private:
  void make(Bodies& bodies);
  void pose_all(Bodies& bodies);
  bool meant(std::pair<int, int> pair, std::span<const Joint> joints, bool all_touch);
  static double fit(std::pair<int, int> pair, std::span<const Joint> joints);

  bool made_ = false;
  std::vector<BodyHull> hulls_;                 // by body
  std::map<std::pair<int, int>, double> told_;  // [m] how deep
};

}  // namespace abut
