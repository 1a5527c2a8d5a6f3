#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coordinator/passive/own_gaps.hpp"

namespace abut {

/// Looks whether bodies come upon themselves in accurate windows and flights, which know of no
/// contact of a body with itself [M.135].
class FoldWatch {
 public:
  /// Of the pairs those of a body with itself are watched.
  FoldWatch(std::vector<TouchingPair> pairs, const Bodies& bodies);
  ~FoldWatch();

  /// Of the latest replies: which body's surface came within its thickness of itself on straight
  /// ways between the instants of their traces, in words; empty: none. Precondition: traces hold
  /// displacements of all points.
  std::string look();
  /// Whether no surface comes upon itself while all points go on for `times` as far as they went in
  /// the latest replies.
  bool apart(double times);
  /// Since then, of replies of bodies that have left their passive forms: whether no surface came
  /// upon itself. Nodes without mass go to where they are in balance.
  bool still_apart();
  bool any() const { return !pairs_.empty(); }

 private:
  struct Watched;
  bool meets(Watched& body) const;

  std::vector<TouchingPair> pairs_;
  const Bodies& bodies_;
  std::vector<std::unique_ptr<Watched>> watched_;  // by body that has own pairs
  mutable std::vector<Eigen::Vector3d> from_, to_;
  mutable std::vector<FeaturePair> found_;
};

}  // namespace abut
