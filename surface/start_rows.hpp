#pragma once

#include "surface/posed_surface.hpp"
#include "surface/surface_rows.hpp"

namespace abut {

/// A surface as it stands at the start, and the size of its facets.
struct StartSurface {
  PosedSurface surface;
  double spacing = 0.0;  // [m] typical distance of its nodes
};

/// [m] The larger of two surfaces' facets, which says what of an overlap is round-off and how deep
/// a node may lie behind a surface and still be seen.
double facet_size(const StartSurface& one, const StartSurface& other);

// Two surfaces may touch from the start when none of the following rows has a gap below 0, those of
// nodes: below their roundness. For setting up: they allocate.

/// [m] by which facets that stand for a round surface leave it, roughly: half of what their nodes
/// lie beside each other's tangent planes; 0 of flat facets and at edges that are sharp to contact.
double sag(const PosedSurface& surface);

/// How deep nodes of two such surfaces may lie behind each other where contact, which averages over
/// their surroundings, sees no overlap [m].
double roundness(const StartSurface& one, const StartSurface& other);

/// Nodes of `one` before the facets of `other`: closest-point rows.
SurfaceRows node_rows(const StartSurface& one, const StartSurface& other);

/// Rows of the nodes of `one` as contact has them, averaged over their surroundings (mortar_rows)
/// or, where edges and corners of both meet, of single points (MeetingCorners). Facets of polygons
/// that stand for round bodies overlap in them before any node does.
SurfaceRows average_rows(const StartSurface& one, const StartSurface& other);

/// Whether a surface has edges that are sharp to contact.
bool has_edges(const PosedSurface& surface);

/// Whether rows of a contact are of the other surface's nodes: it has edges that the finder's
/// facets see (edge_nodes) over the finder, no farther off than a facet and nearer than the
/// finder's own are to it [M.93]. Averages of the finder's nodes mean nothing there.
bool rows_of_other(const StartSurface& finder, const StartSurface& other);

}  // namespace abut
