#pragma once

#include <span>
#include <vector>

#include "surface/feature_distance.hpp"
#include "surface/skin_trees.hpp"

namespace abut {

/// All pairs of features, of which the choice allows the groups, that may come nearer to each other
/// than `reach` [m] on straight ways between two poses, and some more: those whose boxes over the
/// ways are no farther apart along any axis. Pairs that share a point are left out. Ascending,
/// whatever the trees are like; of two edges the one that the skin lists first is the first side.
/// What `pairs` held is dropped, its memory is used again. Renews the trees' boxes.
void near_features(SkinTrees& trees, std::span<const Eigen::Vector3d> from,
                   std::span<const Eigen::Vector3d> to, double reach, const FeatureChoice& choice,
                   std::vector<FeaturePair>& pairs);

}  // namespace abut
