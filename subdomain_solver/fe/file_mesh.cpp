#include "subdomain_solver/fe/file_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/facet_index.hpp"
#include "subdomain_solver/fe/named_sides.hpp"
#include "subdomain_solver/fe/surface_shape.hpp"

namespace abut {
namespace {

std::span<const std::int32_t> nodes_of(const FileMesh::Elements& block, std::size_t element) {
  const auto count = index(block.type->nodes);
  return std::span(block.nodes).subspan(element * count, count);
}

class FileMeshBuilder {
 public:
  using Origins = std::vector<std::vector<std::int32_t>>;

  FileMeshBuilder(FileMesh file, double scale, int surface_in, Origins* origins)
      : file_(std::move(file)), scale_(scale), surface_in_(surface_in), origins_(origins) {}

  Mesh build() {
    for (const FileMesh::Elements& block : file_.elements)
      if (!block.tags.empty()) mesh_.dim = std::max(mesh_.dim, block.type->dim);
    if (mesh_.dim == 0)
      throw InputError("has no elements but points", file_.name,
                       "Mesh the part before the export.");
    check_names();
    if (mesh_.dim + 1 == surface_in_) return surface_shape(surface(), file_.name);
    add_points();
    add_cells();
    refuse_repeated_cells(mesh_, file_.name);
    const FacetIndex facets(mesh_);
    for (const FileMesh::Elements& block : file_.elements) {
      for (const std::string& group : groups_of(block)) {
        if (block.type->dim == mesh_.dim - 1) add_side(group, block, facets);
        if (block.type->dim != mesh_.dim - 1) add_node_set(group, block);
      }
    }
    settle_names(mesh_, file_.name);
    return std::move(mesh_);
  }

 private:
  std::string group_name(FileMesh::Entity group) const {
    const auto found = file_.group_names.find(group);
    if (found != file_.group_names.end()) return found->second;
    constexpr const char* kinds[] = {"point", "curve", "surface", "volume"};
    return fmt::format("{}_{}", kinds[group.first], group.second);
  }

  std::vector<std::string> groups_of(const FileMesh::Elements& block) const {
    std::vector<std::string> names;
    const auto found = file_.groups.find(block.entity);
    if (found == file_.groups.end()) return names;
    for (int tag : found->second) names.push_back(group_name({block.entity.first, tag}));
    return names;
  }

  void check_names() const {
    std::set<FileMesh::Entity> groups;
    for (const FileMesh::Elements& block : file_.elements) {
      const auto found = file_.groups.find(block.entity);
      if (found == file_.groups.end()) continue;
      for (int tag : found->second) groups.insert({block.entity.first, tag});
    }
    std::set<std::string> names;
    for (const FileMesh::Entity& group : groups) {
      if (!names.insert(group_name(group)).second)
        throw InputError("has two groups called '" + group_name(group) + "'", file_.name,
                         "Give them different names.");
    }
  }

  SurfaceFacets surface() {
    SurfaceFacets out;
    out.dim = surface_in_;
    for (std::size_t n = 0; n < file_.node_tags.size(); ++n)
      for (int d = 0; d < out.dim; ++d)
        out.points.push_back(scale_ * file_.points[3 * n + index(d)]);
    for (const FileMesh::Elements& block : file_.elements) {
      if (block.type->dim != mesh_.dim) continue;
      const std::vector<std::string> groups = groups_of(block);
      for (std::size_t e = 0; e < block.tags.size(); ++e)
        out.add(nodes_of(block, e), fmt::format("element {} ({})", block.tags[e], block.type->name),
                groups);
    }
    return out;
  }

  /// Nodes of cells, in the file's order.
  void add_points() {
    number_.assign(file_.node_tags.size(), -1);
    for (const FileMesh::Elements& block : file_.elements) {
      if (block.type->dim != mesh_.dim) continue;
      for (std::int32_t node : block.nodes) number_[node] = 0;
    }
    std::int32_t next = 0;
    double lowest[3] = {}, highest[3] = {}, extent = 0.0;
    for (std::size_t n = 0; n < number_.size(); ++n) {
      if (number_[n] < 0) continue;
      const double* x = &file_.points[3 * n];
      for (int d = 0; d < 3; ++d) {
        if (d < mesh_.dim) mesh_.points.push_back(scale_ * x[d]);
        lowest[d] = next == 0 ? x[d] : std::min(lowest[d], x[d]);
        highest[d] = next == 0 ? x[d] : std::max(highest[d], x[d]);
        extent = std::max(extent, highest[d] - lowest[d]);
      }
      number_[n] = next++;
    }
    for (int d = mesh_.dim; d < 3; ++d) {
      // what rotating a plane part with printed coordinates may leave
      if (highest[d] - lowest[d] <= 1e-9 * extent) continue;
      throw InputError(fmt::format("has cells of {} dimensions that leave the {}", mesh_.dim,
                                   mesh_.dim == 2 ? "plane z = constant" : "line y, z = constant"),
                       file_.name,
                       "Mesh the volume (`gmsh -3`, with a physical volume), or move the part.");
    }
  }

  void add_cells() {
    std::map<std::pair<std::string, const Element*>, std::size_t> place;
    for (const FileMesh::Elements& block : file_.elements) {
      if (block.type->dim != mesh_.dim) continue;
      const std::vector<std::string> groups = groups_of(block);
      const std::string name = groups.empty() ? "" : groups.front();
      const auto [entry, is_new] = place.try_emplace({name, block.type}, mesh_.blocks.size());
      if (is_new) mesh_.blocks.push_back({block.type, {}, name, {}});
      std::vector<std::int32_t>& cells = mesh_.blocks[entry->second].nodes;
      for (std::int32_t node : block.nodes) cells.push_back(number_[node]);
      if (origins_ == nullptr) continue;
      origins_->resize(mesh_.blocks.size());
      std::vector<std::int32_t>& own = (*origins_)[entry->second];
      own.insert(own.end(), block.origins.begin(), block.origins.end());
    }
  }

  /// Numbers in the mesh of an element's nodes; all must be nodes of cells.
  std::vector<std::int32_t> renumbered(const std::string& group, const FileMesh::Elements& block,
                                       std::size_t element) const {
    std::vector<std::int32_t> nodes;
    for (std::int32_t node : nodes_of(block, element)) {
      nodes.push_back(number_[node]);
      if (nodes.back() >= 0) continue;
      throw InputError(
          fmt::format("has element {} ({}) of group '{}' with node {}, which is in no cell",
                      block.tags[element], block.type->name, group, file_.node_tags[node]),
          block.where, "Embed the entity in the part, or drop the group.");
    }
    return nodes;
  }

  void add_node_set(const std::string& group, const FileMesh::Elements& block) {
    std::vector<std::int32_t>& set = mesh_.node_sets[group];
    for (std::size_t e = 0; e < block.tags.size(); ++e) {
      const std::vector<std::int32_t> nodes = renumbered(group, block, e);
      set.insert(set.end(), nodes.begin(), nodes.end());
    }
  }

  void add_side(const std::string& group, const FileMesh::Elements& block,
                const FacetIndex& facets) {
    std::vector<Facet>& side = mesh_.sides[group];
    for (std::size_t e = 0; e < block.tags.size(); ++e) {
      std::vector<std::int32_t> nodes = renumbered(group, block, e);
      const auto corners = index(block.type->corner_count());
      const std::vector<Facet> found = facets.find(std::span(nodes).first(corners));
      std::sort(nodes.begin(), nodes.end());
      for (const Facet& facet : found) {
        std::vector<std::int32_t> own = mesh_.nodes_of(facet);
        std::sort(own.begin(), own.end());
        if (own != nodes) refuse_side(group, block, e, "but for nodes between corners");
      }
      if (found.empty()) refuse_side(group, block, e, "");
      side.push_back(found.front());
    }
  }

  [[noreturn]] void refuse_side(const std::string& group, const FileMesh::Elements& block,
                                std::size_t element, const std::string& but) const {
    throw InputError(
        fmt::format("has element {} ({}) of group '{}', which is a facet of no cell{}",
                    block.tags[element], block.type->name, group, but.empty() ? "" : " " + but),
        block.where, "Mesh sides and inside together, in one order, and export both.");
  }

  FileMesh file_;
  double scale_;
  int surface_in_;
  Origins* origins_;
  Mesh mesh_;
  std::vector<std::int32_t> number_;  // in the mesh, of a node of the file; -1: in no cell
};

}  // namespace

Mesh mesh_of(FileMesh file, double scale, int surface_in,
             std::vector<std::vector<std::int32_t>>* origins) {
  return FileMeshBuilder(std::move(file), scale, surface_in, origins).build();
}

}  // namespace abut
