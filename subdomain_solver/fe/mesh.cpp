#include "subdomain_solver/fe/mesh.hpp"

#include <algorithm>
#include <cstddef>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"

namespace abut {
namespace {

template <typename Map>
void append_names(const Map& map, std::string& names) {
  for (const auto& [name, members] : map) names += (names.empty() ? "" : ", ") + name;
}

[[noreturn]] void refuse(const std::string& what, const std::string& name,
                         const std::string& names) {
  throw InputError("has no " + what + " called '" + name + "'", "mesh",
                   names.empty() ? "It has no names at all: give its boundary some."
                                 : "Choose one of " + names + ".");
}

}  // namespace

int CellBlock::count() const { return static_cast<int>(nodes.size() / index(element->nodes)); }

int Mesh::node_count() const { return dim == 0 ? 0 : static_cast<int>(points.size()) / dim; }

int Mesh::cell_count() const {
  int count = 0;
  for (const CellBlock& block : blocks) count += block.count();
  return count;
}

std::vector<std::int32_t> Mesh::nodes_of(const std::string& name) const {
  const auto found = sides.find(name);
  if (found == sides.end()) {
    const auto set = node_sets.find(name);
    if (set != node_sets.end()) return set->second;
    std::string names;
    append_names(sides, names);
    append_names(node_sets, names);
    refuse("side or node set", name, names);
  }
  std::vector<std::int32_t> nodes;
  for (const Facet& facet : found->second) {
    const std::vector<std::int32_t> more = nodes_of(facet);
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
  keep_one_each(nodes);
  return nodes;
}

const std::vector<Facet>& Mesh::side(const std::string& name) const {
  const auto found = sides.find(name);
  if (found != sides.end()) return found->second;
  std::string names;
  append_names(sides, names);
  if (node_sets.contains(name)) {
    throw InputError("has no side called '" + name +
                         "', but nodes of that name: it lies inside the "
                         "body, or is of points or lines alone",
                     "mesh",
                     (names.empty() ? std::string() : "Choose one of " + names + ". ") +
                         "Constraints, ports and points take nodes as they are.");
  }
  refuse("side", name, names);
}

std::vector<std::int32_t> Mesh::nodes_of(const Facet& facet) const {
  const CellBlock& block = blocks[facet.block];
  const std::size_t first = index(facet.cell) * index(block.element->nodes);
  const std::vector<int>& local = block.element->facets[facet.local];
  std::vector<std::int32_t> nodes;
  nodes.reserve(local.size());
  for (int node : local) nodes.push_back(block.nodes[first + index(node)]);
  return nodes;
}

}  // namespace abut
