#pragma once

#include <array>
#include <optional>
#include <vector>

#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/touching_surfaces.hpp"
#include "surface/signed_side.hpp"

namespace abut {

/// Facets of a rim look apart by more than 4 degrees, each by half of that from their mean: cosine.
inline constexpr double half_a_rim = 0.9995;

/// Of the shortest edge: roundings of places; less is on a surface.
inline constexpr double on_surface = 1.0e-6;
/// Of the thickness: what came out so far is out.
inline constexpr double out_by = 0.1;
/// Of the thickness: steps that bring something deeper by more are not accepted. Rows are met to a
/// tenth of that, so steps that are short enough are.
inline constexpr double deeper_by = 0.5;

using EdgePoints = std::array<std::int32_t, 2>;

/// Along the shortest way between two edges, each of which is behind the other one's facets or on
/// them, with its signed gap [m]. Nothing where they are parallel, or nearest at an end.
std::optional<DistanceRow> edge_row(const SkinSides& sides, const EdgePoints& first,
                                    const EdgePoints& second,
                                    const std::vector<Eigen::Vector3d>& places);

/// Whether the facets of an edge look apart there. Across others what is behind may slide.
bool is_rim(const TouchingSurfaces& surfaces, const SkinSides& sides, const SkinTrees& trees,
            const std::vector<Eigen::Vector3d>& places, const EdgePoints& edge,
            const Eigen::Vector3d& at);

/// [m] of a row, along its normal, where its points are in `places`.
double gap_at(const DistanceRow& row, const std::vector<Eigen::Vector3d>& places);

/// Whether a row presses on anything that moves.
bool can_press(const TouchingSurfaces& surfaces, const DistanceRow& row);

/// A row of what is behind, with its friction, its tangents and what these turn.
DistanceRow held_behind(const TouchingSurfaces& surfaces, DistanceRow row,
                        const std::vector<Eigen::Vector3d>& places);

}  // namespace abut
