#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/boxes.hpp"
#include "surface/mortar_options.hpp"
#include "surface/posed_surface.hpp"
#include "surface/surface_rows.hpp"

namespace abut {

/// A surface whose facets are of second order, some of them at least, and its straight facets.
struct WholeSurface {
  PosedSurface straight;
  std::span<const std::int32_t> nodes, offsets;  // of whole facets (FacetKind), one after the other
  std::span<const std::int32_t> of;              // (straight facets) which of the whole ones

  int count() const { return offsets.empty() ? 0 : static_cast<int>(offsets.size()) - 1; }
  std::span<const std::int32_t> facet(int whole) const {
    const std::size_t begin = index(offsets[whole]);
    return nodes.subspan(begin, index(offsets[index(whole) + 1]) - begin);
  }
};

/// The whole facets with their corners alone.
struct CornerFacets {
  std::vector<std::int32_t> facets, offsets = {0};

  explicit CornerFacets(const WholeSurface& surface);
  PosedSurface surface(const PosedSurface& straight) const;  // of the same points
};

/// Rows for faces that are joined for good [M.118]: for every corner r of K's facets that N covers,
///   T_ra = (1/w_r) int L_r N_a,   P_rb = (1/w_r) int L_r N_b,   w_r = int L_r,
/// L_r linear, or bilinear, on K's facets, N the shape functions of either side's elements where
/// these are seen in the planes of K's straight facets. `gaps`: how far apart (T x - P y)_r is,
/// `normals` are empty. `pairs`: of straight facets, ordered by K's (overlapping_pairs).
void whole_rows(const WholeSurface& k, const WholeSurface& n, std::span<const FacetPair> pairs,
                const MortarOptions& options, SurfaceRows& rows);

}  // namespace abut
