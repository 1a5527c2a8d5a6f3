#include "surface/row_assembly.hpp"

#include <algorithm>
#include <cstddef>

#include "base/index.hpp"

namespace abut {
namespace {

/// Which corners of which facets go into which row: a counting sort.
void sort_parts(const PosedSurface& k, const MortarPieces& pieces,
                std::span<const std::int32_t> root, RowBuffers& b) {
  b.begin.assign(index(k.node_count()) + 1, 0);
  const auto each_part = [&k, &pieces, &root](const auto& visit) {
    for (std::size_t f = 0; f < pieces.facets.size(); ++f) {
      const std::span<const std::int32_t> nodes = k.nodes(pieces.facets[f].facet);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (root[nodes[i]] >= 0) visit(f, i, index(root[nodes[i]]));
    }
  };
  each_part([&b](std::size_t, std::size_t, std::size_t row) { ++b.begin[row]; });
  std::int32_t sum = 0;
  for (std::int32_t& begin : b.begin) {
    sum += begin;
    begin = sum;  // the end of the row; filled from there downwards
  }
  b.parts.resize(index(sum));
  each_part([&b](std::size_t f, std::size_t i, std::size_t row) {
    b.parts[--b.begin[row]] = {static_cast<std::int32_t>(f), static_cast<std::int32_t>(i)};
  });
}

/// Adds one corner's part of a facet: to T, to P, to the normal. Returns its weight.
double add_part(const PosedSurface& k, const PosedSurface& n, const MortarPieces& pieces,
                const RowBuffers::Part& part, RowBuffers& b, Eigen::Vector3d& normal) {
  const MortarFacet& facet = pieces.facets[part.facet];
  const std::span<const std::int32_t> own = k.nodes(facet.facet);
  if (facet.dual) {
    b.k.add(own[part.corner], facet.weight[part.corner]);
  } else {
    for (std::size_t i = 0; i < own.size(); ++i) b.k.add(own[i], facet.t(part.corner, i));
  }
  for (std::int32_t at = facet.first; at < facet.last; ++at) {
    const MortarPiece& piece = pieces.pieces[at];
    const std::span<const std::int32_t> partner = n.nodes(piece.facet);
    for (std::size_t j = 0; j < partner.size(); ++j)
      b.n.add(partner[j], piece.p(part.corner, static_cast<Eigen::Index>(j)));
    normal += piece.share[part.corner] * piece.normal;
  }
  return facet.weight[part.corner];
}

}  // namespace

void RowSum::resize(int nodes) {
  values.resize(index(nodes));
  used.assign(index(nodes), 0);
  columns.clear();
}

void RowSum::add(std::int32_t column, double value) {
  if (!used[column]) {
    used[column] = 1;
    values[column] = 0.0;
    columns.push_back(column);
  }
  values[column] += value;
}

void RowSum::flush(double weight, SparseRows& rows) {
  std::sort(columns.begin(), columns.end());
  for (std::int32_t column : columns) {
    rows.columns.push_back(column);
    rows.values.push_back(values[column] / weight);
    used[column] = 0;
  }
  columns.clear();
  rows.end_row();
}

void assemble_rows(const PosedSurface& k, const PosedSurface& n, const MortarPieces& pieces,
                   std::span<const std::int32_t> root, RowBuffers& buffers, SurfaceRows& rows) {
  rows.clear();
  rows.dim = k.dim;
  sort_parts(k, pieces, root, buffers);
  buffers.k.resize(k.node_count());
  buffers.n.resize(n.node_count());
  for (int node = 0; node < k.node_count(); ++node) {
    const std::int32_t begin = buffers.begin[node], end = buffers.begin[node + 1];
    if (begin == end) continue;
    double weight = 0.0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (std::int32_t at = begin; at < end; ++at)
      weight += add_part(k, n, pieces, buffers.parts[at], buffers, normal);
    normal.normalize();
    rows.nodes.push_back(node);
    rows.weights.push_back(weight);
    rows.normals.insert(rows.normals.end(), normal.data(), normal.data() + k.dim);
    buffers.k.flush(weight, rows.k);
    buffers.n.flush(weight, rows.n);
  }
  rows.gaps.resize(rows.nodes.size());
  gaps(rows, k.points, n.points, rows.gaps);
}

}  // namespace abut
