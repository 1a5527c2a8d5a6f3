#include "surface/mortar.hpp"

#include <cstddef>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {

void mortar_rows(const PosedSurface& k, const PosedSurface& n, std::span<const FacetPair> pairs,
                 const MortarOptions& options, MortarBuffers& buffers, SurfaceRows& rows) {
  ABUT_ASSERT(k.dim == n.dim);
  mortar_pieces(k, n, pairs, options, buffers.pieces);
  tributary_weights(k, buffers.full);
  buffers.weight.assign(index(k.node_count()), 0.0);
  for (const MortarFacet& facet : buffers.pieces.facets) {
    const std::span<const std::int32_t> nodes = k.nodes(facet.facet);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      buffers.weight[nodes[i]] += facet.weight[static_cast<Eigen::Index>(i)];
  }
  merged_rows(k, buffers.pieces, buffers.weight, buffers.full, options.merge, buffers.merge,
              buffers.root);
  assemble_rows(k, n, buffers.pieces, buffers.root, buffers.rows, rows);
}

}  // namespace abut
