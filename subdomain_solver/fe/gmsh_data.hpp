#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "subdomain_solver/fe/element.hpp"

namespace abut {

/// What a Gmsh file says, in its own terms but with nodes numbered from 0 in the file's order.
struct GmshData {
  using Entity = std::pair<int, int>;  // dimension and tag

  /// Elements of one type on one entity.
  struct Elements {
    const Element* type = nullptr;
    Entity entity;
    std::string where;                // in the file, for messages
    std::vector<std::uint64_t> tags;  // (elements)
    std::vector<std::int32_t> nodes;  // (elements, type->nodes)
  };

  std::string name;                           // of the file
  std::map<Entity, std::string> group_names;  // of physical groups
  std::map<Entity, std::vector<int>> groups;  // tags of the physical groups of an entity
  std::vector<double> points;                 // (nodes, 3), in the file's unit
  std::vector<std::uint64_t> node_tags;       // (nodes)
  std::vector<Elements> elements;
};

/// Reads the bytes of a file in Gmsh's format MSH 4.1, text or binary of this machine's byte order,
/// or 2.2, text. Throws InputError with line or byte: other versions, partitioned meshes, elements
/// that we do not have, damage.
GmshData parse_gmsh(std::string bytes, const std::string& name);

}  // namespace abut
