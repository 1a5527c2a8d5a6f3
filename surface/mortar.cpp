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
  const int nodes = k.node_count();
  buffers.root.resize(index(nodes));
  bool merges = false;
  for (int j = 0; j < nodes; ++j) {
    const double weight = buffers.weight[j];
    buffers.root[j] = weight > 0.0 ? j : -1;
    merges = merges || (weight > 0.0 && is_light(weight, buffers.full[j], options.merge));
  }
  assemble_rows(k, n, buffers.pieces, buffers.root, buffers.rows, rows);
  if (!merges) return;
  buffers.gap.assign(index(nodes), 0.0);
  for (std::size_t r = 0; r < rows.nodes.size(); ++r) buffers.gap[rows.nodes[r]] = rows.gaps[r];
  merged_rows(k, buffers.pieces, buffers.weight, buffers.full, buffers.gap, options.merge,
              options.level, buffers.merge, buffers.root);
  assemble_rows(k, n, buffers.pieces, buffers.root, buffers.rows, rows);
}

}  // namespace abut
