#include "subdomain_solver/fe/lattice_mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/facet_index.hpp"

namespace abut {
namespace {

/// The middle of some of the corners, which has a place in the lattice.
LatticePoint middle(std::span<const LatticePoint> corners, const std::vector<int>& which) {
  const int count = static_cast<int>(which.size());
  LatticePoint sum;
  for (const int corner : which)
    for (std::size_t d = 0; d < sum.at.size(); ++d) sum.at[d] += corners[corner].at[d];
  for (int& number : sum.at) {
    ABUT_ASSERT(number % count == 0);
    number /= count;
  }
  return sum;
}

std::uint64_t packed(const LatticePoint& point) {
  std::uint64_t key = 0;
  for (int number : point.at) key = (key << 16) | static_cast<std::uint64_t>(number);
  return key;
}

}  // namespace

std::vector<LatticePoint> cell_corners(int dim, const LatticePoint& lowest) {
  constexpr int around[4][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  std::vector<LatticePoint> corners(std::size_t{1} << dim, lowest);
  for (std::size_t a = 0; a < corners.size(); ++a) {
    corners[a].at[0] += around[a % 4][0];
    corners[a].at[1] += around[a % 4][1];
    corners[a].at[2] += a < 4 ? 0 : 2;
  }
  return corners;
}

LatticeMesh::LatticeMesh(const Element& element, Mapping mapping)
    : element_(element), mapping_(std::move(mapping)) {
  mesh_.dim = element.dim;
  mesh_.blocks.push_back({&element, {}, "", {}});
}

std::int32_t LatticeMesh::node(const LatticePoint& point) {
  const auto next = static_cast<std::int32_t>(places_.size());
  const auto [entry, is_new] = numbers_.try_emplace(packed(point), next);
  if (is_new) {
    places_.push_back(point);
    const std::array<double, 3> x = mapping_(point);
    mesh_.points.insert(mesh_.points.end(), x.begin(), x.begin() + mesh_.dim);
  }
  return entry->second;
}

void LatticeMesh::add_element(std::span<const LatticePoint> corners) {
  std::vector<std::int32_t>& nodes = mesh_.blocks.front().nodes;
  for (const LatticePoint& corner : corners) nodes.push_back(node(corner));
  for (const std::vector<int>& between : element_.between)
    nodes.push_back(node(middle(corners, between)));
}

void LatticeMesh::add_cell(std::span<const LatticePoint> corners) {
  if (element_.shape == Shape::triangle) {
    split(linear_element(Shape::quadrilateral), corners);
  } else if (element_.shape == Shape::tetrahedron) {
    split(linear_element(Shape::hexahedron), corners);
  } else {
    add_element(corners);
  }
}

/// Cones from the smallest corner over the facets that do not touch it, each facet cut from its
/// own smallest corner.
void LatticeMesh::split(const Element& whole, std::span<const LatticePoint> corners) {
  ABUT_ASSERT(corners.size() == index(whole.nodes));
  const LatticePoint tip = *std::min_element(corners.begin(), corners.end());
  for (const std::vector<int>& facet : whole.facets) {
    std::vector<LatticePoint> base;
    for (int a : facet) base.push_back(corners[a]);
    if (std::find(base.begin(), base.end(), tip) != base.end()) continue;
    if (whole.dim == 2) {
      add_element(std::array{base[0], base[1], tip});
      continue;
    }
    std::rotate(base.begin(), std::min_element(base.begin(), base.end()), base.end());
    // the normal of the facet points away from the tip, that of a tetrahedron's first face to it
    add_element(std::array{base[0], base[2], base[1], tip});
    add_element(std::array{base[0], base[3], base[2], tip});
  }
}

const std::vector<Facet>& LatticeMesh::boundary() {
  const auto [entry, is_new] = mesh_.sides.try_emplace("boundary");
  if (is_new) entry->second = FacetIndex(mesh_).boundary();
  return entry->second;
}

void LatticeMesh::name_side(const std::string& name, const Predicate& contains) {
  std::vector<Facet> side;
  for (const Facet& facet : boundary()) {
    const std::vector<std::int32_t> nodes = mesh_.nodes_of(facet);
    if (std::all_of(nodes.begin(), nodes.end(),
                    [this, &contains](std::int32_t n) { return contains(places_[n]); }))
      side.push_back(facet);
  }
  mesh_.sides[name] = std::move(side);
}

void LatticeMesh::name_nodes(const std::string& name, const Predicate& contains) {
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < places_.size(); ++n)
    if (contains(places_[n])) nodes.push_back(static_cast<std::int32_t>(n));
  if (!nodes.empty()) mesh_.node_sets[name] = std::move(nodes);
}

Mesh LatticeMesh::finish() {
  boundary();
  return std::move(mesh_);
}

}  // namespace abut
