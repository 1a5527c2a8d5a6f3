#include "subdomain_solver/overlap/mesh_simplices.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "base/index.hpp"
#include "subdomain_solver/fe/cell_finder.hpp"

namespace abut {

namespace {

/// Of nodes of a mesh, some after each other for every simplex.
PosedSurface simplex_view(const Mesh& mesh, std::span<const std::int32_t> nodes,
                          std::span<const std::int32_t> offsets) {
  return {mesh.dim, mesh.points, nodes, offsets};
}

Simplex simplex_of(const PosedSurface& surface, int i) {
  Simplex s;
  for (const std::int32_t node : surface.nodes(i)) s.x[s.count++] = surface.point(node);
  return s;
}

/// Triangles of a facet, from its lowest node on; a segment or triangle is itself.
std::vector<std::vector<std::int32_t>> fan(const std::vector<std::int32_t>& facet) {
  if (facet.size() < 4) return {facet};
  const std::size_t first = index(std::ranges::min_element(facet) - facet.begin());
  const auto at = [&](std::size_t k) { return facet[(first + k) % facet.size()]; };
  return {{at(0), at(1), at(2)}, {at(0), at(2), at(3)}};
}

}  // namespace

MeshSimplices::MeshSimplices(const Mesh& mesh) : mesh_(mesh), offsets_({0}) {
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (int c = 0; c < mesh.blocks[b].count(); ++c)
      add_fan({static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)});
  double whole = 0.0;
  for (int i = 0; i < count(); ++i) whole += measure(simplex(i));
  spacing_ = std::pow(whole / mesh.cell_count(), 1.0 / mesh.dim);
  build(tree_, simplex_view(mesh, nodes_, offsets_), 1.0e-6 * spacing_);
}

void MeshSimplices::add_fan(CellPlace place) {
  const CellBlock& block = mesh_.blocks[place.block];
  const std::span<const std::int32_t> nodes = abut::nodes_of(block, place.cell);
  const auto add = [&](std::span<const std::int32_t> corners) {
    nodes_.insert(nodes_.end(), corners.begin(), corners.end());
    offsets_.push_back(static_cast<std::int32_t>(nodes_.size()));
    owner_.push_back(place);
  };
  if (nodes.size() == index(mesh_.dim) + 1) return add(nodes);
  const std::int32_t apex = *std::ranges::min_element(nodes);
  for (std::size_t f = 0; f < block.element->facets.size(); ++f) {
    const std::vector<std::int32_t> facet =
        mesh_.nodes_of(Facet{place.block, place.cell, static_cast<std::int32_t>(f)});
    if (std::ranges::find(facet, apex) != facet.end()) continue;
    for (std::vector<std::int32_t>& part : fan(facet)) {
      part.push_back(apex);
      add(part);
    }
  }
}

Simplex MeshSimplices::simplex(int i) const {
  return simplex_of(simplex_view(mesh_, nodes_, offsets_), i);
}

BoundarySimplices::BoundarySimplices(const Mesh& of, const std::vector<Facet>& facets) : mesh(of) {
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (const std::vector<std::int32_t>& part : fan(mesh.nodes_of(facets[f]))) {
      nodes.insert(nodes.end(), part.begin(), part.end());
      offsets.push_back(static_cast<std::int32_t>(nodes.size()));
      facet.push_back(static_cast<std::int32_t>(f));
    }
  }
  const PosedSurface surface = simplex_view(mesh, nodes, offsets);
  build(tree, surface, 1.0e-6 * longest_edge(surface));
}

Simplex BoundarySimplices::simplex(int i) const {
  return simplex_of(simplex_view(mesh, nodes, offsets), i);
}

std::vector<double> reference_place(const Mesh& mesh, CellPlace place, const Eigen::Vector3d& at) {
  return reference_coordinates(mesh, place.block, place.cell, {at.data(), index(mesh.dim)});
}

std::vector<double> shape_values(const Mesh& mesh, CellPlace place, const std::vector<double>& xi) {
  const Element& element = *mesh.blocks[place.block].element;
  std::vector<double> n(index(element.nodes)), dn(n.size() * xi.size());
  element.evaluate(xi, n, dn);
  return n;
}

}  // namespace abut
