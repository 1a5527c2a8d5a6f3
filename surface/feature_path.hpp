#pragma once

#include "surface/feature_distance.hpp"

namespace abut {

/// The first part of a step, from 0 to 1, at which straight ways of the points from x0 to x1 bring
/// the features within `distance` [m]; 1: never. Never late: until then they are farther apart than
/// `distance`, and the time that is told is the one, up to `tolerance` [m], at which they no longer
/// are farther apart than distance + tolerance (at least 64 roundings of the largest coordinate).
/// So features that begin within this are told at 0.
///
/// By conservative advancement along the direction d of the closest points: as the distance is at
/// least the smallest d.(x_i - x_j) over points i of the first side and j of the second, and as
/// these are linear in time, the time until the first of them comes down is free. Exact in one step
/// where a translation brings a node to the inside of a facet or two edges to each other's inside,
/// and where features part.
double first_time_within(FeatureKind kind, int dim, const FeaturePoints& x0,
                         const FeaturePoints& x1, double distance, double tolerance);

}  // namespace abut
