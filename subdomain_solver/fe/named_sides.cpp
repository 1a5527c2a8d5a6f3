#include "subdomain_solver/fe/named_sides.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"
#include "subdomain_solver/fe/facet_index.hpp"

namespace abut {
namespace {

bool before(const Facet& a, const Facet& b) {
  return std::tie(a.block, a.cell, a.local) < std::tie(b.block, b.cell, b.local);
}

void refuse_repeats(std::vector<Facet> side, const std::string& name, const std::string& where) {
  std::sort(side.begin(), side.end(), before);
  if (std::adjacent_find(side.begin(), side.end()) != side.end())
    throw InputError("has a facet twice in the side '" + name + "'", where,
                     "Remove the duplicate from the group.");
}

/// True when all facets of a side lie between two cells, false when none does.
bool inside(const Mesh& mesh, const FacetIndex& facets, const std::vector<Facet>& side,
            const std::string& name, const std::string& where) {
  std::size_t shared = 0;
  for (const Facet& facet : side) {
    const std::vector<std::int32_t> nodes = mesh.nodes_of(facet);
    const Element& cell = *mesh.blocks[facet.block].element;
    const auto corners = index(element_named(cell.facet_name).corner_count());
    if (facets.find(std::span(nodes).first(corners)).size() > 1) ++shared;
  }
  if (shared > 0 && shared < side.size())
    throw InputError("has the side '" + name +
                         "' partly on the boundary, and partly lies inside "
                         "the body, between cells",
                     where, "Make two groups of it.");
  return shared > 0;
}

}  // namespace

void refuse_repeated_cells(const Mesh& mesh, const std::string& where) {
  struct Place {
    std::array<std::int32_t, 8> corners;  // sorted, -1 in front where there are fewer
    std::size_t block = 0, cell = 0;
  };
  std::vector<Place> cells;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const CellBlock& block = mesh.blocks[b];
    const auto nodes = index(block.element->nodes);
    const auto corners = index(block.element->corner_count());
    for (std::size_t c = 0; c < index(block.count()); ++c) {
      Place& place = cells.emplace_back(Place{{}, b, c});
      place.corners.fill(-1);
      std::copy_n(&block.nodes[c * nodes], corners, place.corners.begin());
      std::sort(place.corners.begin(), place.corners.end());
    }
  }
  std::sort(cells.begin(), cells.end(), [](const Place& a, const Place& b) {
    return std::tie(a.corners, a.block, a.cell) < std::tie(b.corners, b.block, b.cell);
  });
  const auto twice =
      std::adjacent_find(cells.begin(), cells.end(),
                         [](const Place& a, const Place& b) { return a.corners == b.corners; });
  if (twice == cells.end()) return;
  throw InputError("has a cell twice: " + cell_text(mesh, twice->block, twice->cell) + " and " +
                       cell_text(mesh, twice[1].block, twice[1].cell) + " have the same corners",
                   where,
                   "Remove one of them: what overlaps counts twice (Gmsh: BooleanFragments of "
                   "volumes that overlap, then mesh again).");
}

void settle_names(Mesh& mesh, const std::string& where) {
  const FacetIndex facets(mesh);
  for (auto side = mesh.sides.begin(); side != mesh.sides.end();) {
    if (!inside(mesh, facets, side->second, side->first, where)) {
      refuse_repeats(side->second, side->first, where);
      ++side;
      continue;
    }
    const std::vector<std::int32_t> nodes = mesh.nodes_of(side->first);
    std::vector<std::int32_t>& set = mesh.node_sets[side->first];
    set.insert(set.end(), nodes.begin(), nodes.end());
    side = mesh.sides.erase(side);
  }
  for (auto set = mesh.node_sets.begin(); set != mesh.node_sets.end();) {
    std::vector<std::int32_t>& nodes = set->second;
    keep_one_each(nodes);
    if (!mesh.sides.contains(set->first)) {
      ++set;
      continue;
    }
    if (nodes != mesh.nodes_of(set->first))
      throw InputError("has a side and a node set called '" + set->first + "' of different nodes",
                       where, "Give them different names.");
    set = mesh.node_sets.erase(set);
  }
  if (!mesh.sides.contains("boundary") && !mesh.node_sets.contains("boundary"))
    mesh.sides["boundary"] = facets.boundary();
}

}  // namespace abut
