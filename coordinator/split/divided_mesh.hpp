#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/split/cell_graph.hpp"
#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// One part of a mesh: its cells and nodes in the order of the whole, the sides and node sets that
/// reach into it, and a side for every part that it shares facets with.
struct MeshPart {
  Mesh mesh;
  std::vector<std::int32_t> nodes;     // of the whole mesh, ascending
  std::map<int, std::string> towards;  // names of the sides to other parts

  /// Of a node of the whole mesh that it has.
  std::int32_t number_of(std::int32_t node) const;
};

/// Cuts a mesh along the facets between parts (cells). `names` (parts): the side of part i towards
/// part j is called "to_" + names[j]. Sides of the whole lie in the parts that have facets of them,
/// node sets in those that have nodes of them. Throws InputError, `where` being the mesh, for a
/// side that is called so already, and for a node at which parts meet that share no facet there:
/// nothing would hold them together.
std::vector<MeshPart> divide(const Mesh& mesh, const CellGraph& graph, const std::vector<int>& part,
                             const std::vector<std::string>& names, const std::string& where);

}  // namespace abut
