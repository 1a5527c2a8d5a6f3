#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/boxes.hpp"
#include "surface/facet_overlap.hpp"
#include "surface/mortar_options.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// What one facet of N adds to the rows of the nodes (i) of one facet of K [m^(dim-1)].
struct MortarPiece {
  std::int32_t facet = 0;  // of N
  Eigen::Matrix4d p;       // int Phi_i N_j, j the nodes of the facet of N
  Shape4 share;            // int Phi_i
  Eigen::Vector3d normal;  // of the facet of N, unit
};

/// A facet of K that N covers, wholly or in part.
struct MortarFacet {
  std::int32_t facet = 0;            // of K
  std::int32_t first = 0, last = 0;  // its pieces
  bool dual = true;                  // t is diagonal
  Eigen::Matrix4d t;                 // int Phi_i N_i'
  Shape4 weight;                     // int Phi_i
};

struct MortarPieces {
  std::vector<MortarFacet> facets;
  std::vector<MortarPiece> pieces;
};

/// Overlaps of all pairs, and the dual functions Phi = diag(w) D^-1 N of every facet of K, with
/// w = int N and D = int N N^T over what N covers of it.
void mortar_pieces(const PosedSurface& k, const PosedSurface& n, std::span<const FacetPair> pairs,
                   const MortarOptions& options, MortarPieces& out);

}  // namespace abut
