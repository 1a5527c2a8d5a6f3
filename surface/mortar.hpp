#pragma once

#include <span>
#include <vector>

#include "surface/boxes.hpp"
#include "surface/mortar_merge.hpp"
#include "surface/mortar_options.hpp"
#include "surface/mortar_pieces.hpp"
#include "surface/posed_surface.hpp"
#include "surface/row_assembly.hpp"
#include "surface/surface_rows.hpp"

namespace abut {

/// Memory that calls of mortar_rows use again; its contents mean nothing between them.
struct MortarBuffers {
  MortarPieces pieces;
  std::vector<double> full;    // (nodes of K) tributary weights
  std::vector<double> weight;  // (nodes of K) their part that N covers
  std::vector<double> gap;     // [m] (nodes of K) of rows as they are
  std::vector<std::int32_t> root;
  MergeBuffers merge;
  RowBuffers rows;
};

/// The rows of the dual mortar method, segment based, for K against N (x and y: nodes of K and N).
/// With dual functions Phi_j on what N covers of K, in the auxiliary planes of the facets of K:
///   w_j = int Phi_j,   (P y)_j = (1/w_j) int Phi_j y,   (T x)_j = (1/w_j) int Phi_j x = x_j,
///   n_j = (1/w_j) int Phi_j n_N, normalised,
/// so T is the identity, except where rows with little support are merged with a neighbour, and
/// where the overlap with a facet is too small for a dual basis: there Phi_j = N_j, and T holds the
/// integrals of N_j N_i, so that it is as exact. On flat faces T x = P y for any meshes and any
/// linear field, and f = p w n passes a constant pressure to the consistent nodal forces of both
/// sides. `pairs` are candidates, ordered by facets of K (overlapping_pairs, with boxes that know
/// the reach). No allocation once `buffers` and `rows` have grown.
void mortar_rows(const PosedSurface& k, const PosedSurface& n, std::span<const FacetPair> pairs,
                 const MortarOptions& options, MortarBuffers& buffers, SurfaceRows& rows);

}  // namespace abut
