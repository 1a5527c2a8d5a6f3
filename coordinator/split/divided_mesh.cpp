#include "coordinator/split/divided_mesh.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"

namespace abut {

namespace {

class Divider {
 public:
  Divider(const Mesh& mesh, const CellGraph& graph, const std::vector<int>& part,
          const std::vector<std::string>& names, const std::string& where)
      : mesh_(mesh),
        graph_(graph),
        part_(part),
        names_(names),
        where_(where),
        parts_(names.size()),
        cell_(part.size()),
        block_(names.size(), std::vector<std::int32_t>(mesh.blocks.size(), -1)) {
    std::int32_t first = 0;
    for (const CellBlock& block : mesh.blocks) {
      first_.push_back(first);
      first += block.count();
    }
  }

  std::vector<MeshPart> divide() {
    add_cells();
    for (MeshPart& part : parts_) number_nodes(part);
    for (const auto& [name, facets] : mesh_.sides)
      for (const Facet& facet : facets) add_facet(name, facet);
    for (MeshPart& part : parts_) add_node_sets(part);
    add_cuts();
    check_meetings();
    return std::move(parts_);
  }

 private:
  std::size_t cell_of(const Facet& facet) const { return index(first_[facet.block] + facet.cell); }

  /// Nodes are those of the whole at first.
  void add_cells() {
    std::size_t cell = 0;
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b) {
      const CellBlock& block = mesh_.blocks[b];
      for (int own = 0; own < block.count(); ++own, ++cell) {
        const std::size_t p = index(part_[cell]);
        std::vector<CellBlock>& blocks = parts_[p].mesh.blocks;
        if (block_[p][b] < 0) {
          block_[p][b] = static_cast<std::int32_t>(blocks.size());
          blocks.push_back({block.element, {}, block.name, {}});
        }
        CellBlock& to = blocks[block_[p][b]];
        cell_[cell] = to.count();
        const std::span<const std::int32_t> nodes = nodes_of(block, own);
        to.nodes.insert(to.nodes.end(), nodes.begin(), nodes.end());
      }
    }
  }

  void number_nodes(MeshPart& part) const {
    for (const CellBlock& block : part.mesh.blocks)
      part.nodes.insert(part.nodes.end(), block.nodes.begin(), block.nodes.end());
    keep_one_each(part.nodes);
    for (CellBlock& block : part.mesh.blocks)
      for (std::int32_t& node : block.nodes) node = part.number_of(node);
    const std::size_t dim = index(mesh_.dim);
    part.mesh.dim = mesh_.dim;
    for (std::int32_t node : part.nodes) {
      const auto at = mesh_.points.begin() + static_cast<std::ptrdiff_t>(index(node) * dim);
      part.mesh.points.insert(part.mesh.points.end(), at, at + mesh_.dim);
    }
  }

  void add_facet(const std::string& side, const Facet& facet) {
    const std::size_t cell = cell_of(facet), p = index(part_[cell]);
    parts_[p].mesh.sides[side].push_back({block_[p][facet.block], cell_[cell], facet.local});
  }

  void add_node_sets(MeshPart& part) const {
    for (const auto& [name, nodes] : mesh_.node_sets) {
      std::vector<std::int32_t> own;
      std::ranges::set_intersection(nodes, part.nodes, std::back_inserter(own));
      if (own.empty()) continue;
      for (std::int32_t& node : own) node = part.number_of(node);
      part.mesh.node_sets[name] = std::move(own);
    }
  }

  void add_cuts() {
    for (std::size_t c = 0; c < part_.size(); ++c) {
      for (std::int32_t k = graph_.begin[c]; k < graph_.begin[c + 1]; ++k) {
        const int other = part_[graph_.next[index(k)]];
        if (other == part_[c]) continue;
        MeshPart& part = parts_[part_[c]];
        const auto [entry, fresh] = part.towards.emplace(other, "to_" + names_[other]);
        const std::string& side = entry->second;
        if (fresh && (mesh_.sides.contains(side) || mesh_.node_sets.contains(side))) {
          throw InputError(fmt::format("has the name '{}' already", side), where_,
                           "Give the body or that group another name.");
        }
        add_facet(side, graph_.facets[k]);
      }
    }
  }

  /// What ties are to hold together at a node hangs together by facets that have this node.
  void check_meetings() const {
    std::vector<std::vector<int>> meeting(index(mesh_.node_count()));  // parts of a node
    std::vector<std::vector<std::pair<int, int>>> joined(meeting.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (std::int32_t node : parts_[p].nodes) meeting[node].push_back(static_cast<int>(p));
      for (const auto& [other, side] : parts_[p].towards)
        for (std::int32_t node : parts_[p].mesh.nodes_of(side))
          joined[parts_[p].nodes[index(node)]].emplace_back(static_cast<int>(p), other);
    }
    std::vector<int> root(parts_.size());
    for (std::size_t node = 0; node < meeting.size(); ++node) {
      if (meeting[node].size() < 2) continue;
      std::iota(root.begin(), root.end(), 0);
      const auto root_of = [&root](int p) {
        while (root[p] != p) p = root[p];
        return p;
      };
      for (const auto& [p, other] : joined[node]) root[root_of(p)] = root_of(other);
      for (int p : meeting[node])
        if (root_of(p) != root_of(meeting[node].front())) refuse_meeting(node);
    }
  }

  [[noreturn]] void refuse_meeting(std::size_t node) const {
    const double* at = mesh_.points.data() + node * index(mesh_.dim);
    throw InputError(
        fmt::format("would come apart at ({:.10g}) m, where cells share a node and no facet",
                    fmt::join(at, at + mesh_.dim, ", ")),
        where_, "Ask for another number of bodies, or let cells there share facets.");
  }

  const Mesh& mesh_;
  const CellGraph& graph_;
  const std::vector<int>& part_;
  const std::vector<std::string>& names_;
  const std::string& where_;
  std::vector<MeshPart> parts_;
  std::vector<std::int32_t> first_;               // (blocks) number of their first cell
  std::vector<std::int32_t> cell_;                // (cells) their number in the part's block
  std::vector<std::vector<std::int32_t>> block_;  // (parts, blocks) their place in the part; or -1
};

}  // namespace

std::int32_t MeshPart::number_of(std::int32_t node) const {
  return static_cast<std::int32_t>(std::ranges::lower_bound(nodes, node) - nodes.begin());
}

std::vector<MeshPart> divide(const Mesh& mesh, const CellGraph& graph, const std::vector<int>& part,
                             const std::vector<std::string>& names, const std::string& where) {
  return Divider(mesh, graph, part, names, where).divide();
}

}  // namespace abut
