#include "subdomain_solver/fe/gmsh_text.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/index.hpp"

namespace abut {
namespace {

/// Elements of one type on one entity, which is in some of the named groups of its dimension.
struct Entity {
  int dim = 0;
  std::vector<int> groups;  // tags
  const Element* type = nullptr;
  std::vector<std::int32_t> nodes;  // (elements, type->nodes)
  std::size_t count() const { return nodes.size() / index(type->nodes); }
};

class Writer {
 public:
  explicit Writer(const Mesh& mesh) : mesh_(mesh) {
    for (const CellBlock& block : mesh.blocks)
      entities_.push_back({mesh.dim, {}, block.element, block.nodes});
    add_sides();
    add_node_sets();
  }

  std::string text() {
    format("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n", names_.size());
    for (std::size_t k = 0; k < names_.size(); ++k)
      format("{} {} \"{}\"\n", names_[k].first, k + 1, names_[k].second);
    format("$EndPhysicalNames\n");
    write_entities();
    write_nodes();
    write_elements();
    return std::move(text_);
  }

 private:
  template <class... Values>
  void format(fmt::format_string<const Values&...> form, const Values&... values) {
    fmt::vformat_to(std::back_inserter(text_), form, fmt::make_format_args(values...));
  }

  int group(int dim, const std::string& name) {
    names_.emplace_back(dim, name);
    return static_cast<int>(names_.size());
  }

  void add_sides() {
    for (const auto& [name, facets] : mesh_.sides) {
      std::map<const Element*, std::size_t> place;
      const int tag = group(mesh_.dim - 1, name);
      for (const Facet& facet : facets) {
        const Element& cell = *mesh_.blocks[facet.block].element;
        const Element& type = element_named(cell.facet_name);
        const auto [entry, fresh] = place.try_emplace(&type, entities_.size());
        if (fresh) entities_.push_back({mesh_.dim - 1, {tag}, &type, {}});
        const std::vector<std::int32_t> nodes = mesh_.nodes_of(facet);
        std::ranges::copy(nodes, std::back_inserter(entities_[entry->second].nodes));
      }
    }
  }

  /// In one dimension points are the sides, and a node inside is told apart by having two cells.
  void add_node_sets() {
    for (const auto& [name, nodes] : mesh_.node_sets)
      entities_.push_back({0, {group(0, name)}, &linear_element(Shape::point), nodes});
  }

  void write_entities() {
    std::size_t counts[4] = {};
    for (const Entity& entity : entities_) ++counts[entity.dim];
    format("$Entities\n{} {} {} {}\n", counts[0], counts[1], counts[2], counts[3]);
    for (int dim = 0; dim < 4; ++dim) {
      for (std::size_t e = 0; e < entities_.size(); ++e) {
        if (entities_[e].dim != dim) continue;
        format("{} {} {}", e + 1, dim == 0 ? "0 0 0" : "0 0 0 0 0 0", entities_[e].groups.size());
        for (int tag : entities_[e].groups) format(" {}", tag);
        format("{}\n", dim == 0 ? "" : " 0");
      }
    }
    format("$EndEntities\n");
  }

  void write_nodes() {
    const int count = mesh_.node_count();
    format("$Nodes\n1 {0} 1 {0}\n{1} 1 0 {0}\n", count, mesh_.dim);
    for (int node = 1; node <= count; ++node) format("{}\n", node);
    for (std::size_t k = 0; k < mesh_.points.size(); k += index(mesh_.dim)) {
      for (std::size_t d = 0; d < 3; ++d)
        format("{}{}", d < index(mesh_.dim) ? mesh_.points[k + d] : 0.0, d < 2 ? " " : "\n");
    }
    format("$EndNodes\n");
  }

  void write_elements() {
    std::size_t total = 0;
    for (const Entity& entity : entities_) total += entity.count();
    format("$Elements\n{0} {1} 1 {1}\n", entities_.size(), total);
    std::size_t tag = 0;
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      const Entity& entity = entities_[e];
      format("{} {} {} {}\n", entity.dim, e + 1, entity.type->gmsh, entity.count());
      for (std::size_t k = 0; k < entity.nodes.size(); ++k) {
        const bool first = k % index(entity.type->nodes) == 0;
        if (first) format("{}{}", k == 0 ? "" : "\n", ++tag);
        format(" {}", entity.nodes[k] + 1);
      }
      format("\n");
    }
    format("$EndElements\n");
  }

  const Mesh& mesh_;
  std::vector<std::pair<int, std::string>> names_;  // dimension and name of groups 1, 2, ...
  std::vector<Entity> entities_;
  std::string text_;
};

}  // namespace

std::string gmsh_text(const Mesh& mesh) { return Writer(mesh).text(); }

}  // namespace abut
