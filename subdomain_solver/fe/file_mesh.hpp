#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

struct DividedShape;

/// What a mesh file says: nodes, numbered from 0 in the file's order, elements of all dimensions,
/// and the named groups that they are in.
struct FileMesh {
  using Entity = std::pair<int, int>;  // dimension and tag

  /// Elements of one type that are in the same groups.
  struct Elements {
    const Element* type = nullptr;
    Entity entity;
    std::string where;                // in the file, for messages
    std::vector<std::uint64_t> tags;  // (elements)
    std::vector<std::int32_t> nodes;  // (elements, type->nodes)
    // (elements) numbers by which their reader knows them; empty: it does not
    std::vector<std::int32_t> origins = {};
  };
  /// Cells that are divided into those that we have (divide_cells.hpp).
  struct Divided {
    const DividedShape* shape = nullptr;
    bool quadratic = false;  // with a node on every edge
    Entity entity;
    std::string where;
    std::vector<std::uint64_t> tags;
    std::vector<std::int32_t> nodes;         // (cells, corners and edges)
    std::vector<std::int32_t> origins = {};  // (cells) as above
  };

  std::string name;                           // of the file
  std::map<Entity, std::string> group_names;  // of groups
  std::map<Entity, std::vector<int>> groups;  // tags of the groups of an entity
  std::vector<double> points;                 // (nodes, 3), in the file's unit
  std::vector<std::uint64_t> node_tags;       // (nodes)
  std::vector<Elements> elements;
  std::vector<Divided> divided;
  std::vector<std::string> notes;  // for people: what was divided or left out
};

/// The mesh, with coordinates times `scale` [m per unit of the file]. The elements of the highest
/// dimension are the cells; meshes in the plane or on a line must have constant other coordinates.
/// Groups become names: of cells, blocks and node sets; of their facets, sides; of facets between
/// cells, and of lower dimensions, node sets. A group without a name is called after its dimension
/// and tag: volume_3, surface_2, curve_1, point_7. Nodes of no cell are dropped. `surface_in`: as
/// read_gmsh (gmsh_file.hpp). `origins`: gets those of the cells, by block. Throws InputError.
Mesh mesh_of(FileMesh file, double scale, int surface_in,
             std::vector<std::vector<std::int32_t>>* origins = nullptr);

}  // namespace abut
