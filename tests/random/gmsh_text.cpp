// A part as the text of a mesh file.

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/random/shape.hpp"

namespace abut {

namespace {

using Facet = std::vector<int>;

/// Nodes on edges, by the nodes at their ends.
class Middles {
 public:
  explicit Middles(const Shape& shape) {
    const auto edges = edges_of(shape.element);
    for (const std::vector<int>& cell : shape.cells) {
      if (cell.size() < edges.size() + index_of_first(shape)) continue;
      for (std::size_t e = 0; e < edges.size(); ++e)
        middle_[key(cell[edges[e][0]], cell[edges[e][1]])] = cell[index_of_first(shape) + e];
    }
  }
  bool any() const { return !middle_.empty(); }
  /// A facet with the nodes on its edges.
  Facet whole(Facet facet) const {
    const std::size_t corners = facet.size();
    for (std::size_t i = 0; any() && i < (corners == 2 ? 1 : corners); ++i)
      facet.push_back(middle_.at(key(facet[i], facet[(i + 1) % corners])));
    return facet;
  }

 private:
  static std::size_t index_of_first(const Shape& shape) {
    return shape.element == "tri6" ? 3 : shape.element == "tet10" ? 4 : 99;
  }
  static std::array<int, 2> key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }
  std::map<std::array<int, 2>, int> middle_;
};

std::string box_of(const Shape& shape) {
  Eigen::Vector3d low = shape.points[0], high = low;
  for (const Eigen::Vector3d& x : shape.points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}", low(0), low(1), low(2),
                     high(0), high(1), high(2));
}

/// A line per element of one entity.
std::string block(int dim, int entity, int type, const std::vector<std::vector<int>>& elements,
                  std::size_t& tag) {
  std::string out = fmt::format("{} {} {} {}\n", dim, entity, type, elements.size());
  for (std::vector<int> nodes : elements) {
    for (int& node : nodes) ++node;
    out += fmt::format("{} {}\n", ++tag, fmt::join(nodes, " "));
  }
  return out;
}

int facet_type(std::size_t nodes, int dim) {
  if (dim == 2) return nodes == 2 ? 1 : 8;
  return nodes == 3 ? 2 : nodes == 4 ? 3 : 9;
}

/// Facets of one entity, and the numbers of the physical groups that it is of.
struct Part {
  std::string name;
  std::vector<int> groups;
  std::vector<Facet> facets;
};

constexpr int skin_group = 1, bottom_group = 2, body_group = 3, first_cut_group = 4;

std::string head_of(const Shape& shape, const std::vector<Part>& parts, bool bottom) {
  const int facet_dim = shape.dim - 1;
  std::string out = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n";
  out += fmt::format("{}\n{} 1 \"skin\"\n", shape.cuts.size() + (bottom ? 3 : 2), facet_dim);
  if (bottom) out += fmt::format("{} 2 \"bottom\"\n", facet_dim);
  int group = first_cut_group;
  for (const auto& [name, facets] : shape.cuts)
    out += fmt::format("{} {} \"{}\"\n", facet_dim, group++, name);
  out += fmt::format("{} {} \"body\"\n$EndPhysicalNames\n$Entities\n", shape.dim, body_group);
  const std::string box = box_of(shape);
  out += shape.dim == 2 ? fmt::format("0 {} 1 0\n", parts.size())
                        : fmt::format("0 0 {} 1\n", parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k)
    out += fmt::format("{} {} {} {} 0\n", k + 1, box, parts[k].groups.size(),
                       fmt::join(parts[k].groups, " "));
  return out + fmt::format("1 {} 1 {} 0\n$EndEntities\n", box, body_group);
}

/// Facets at the bottom are of both groups.
std::vector<Part> gmsh_parts(const Shape& shape) {
  const std::vector<Facet> low = shape.bottom();
  const Middles middles(shape);
  std::vector<Part> parts = {{"skin", {skin_group}, {}}};
  if (!low.empty()) parts.push_back({"bottom", {skin_group, bottom_group}, {}});
  for (const Facet& facet : shape.outside()) {
    if (shape.is_cut(facet)) continue;
    const bool below = std::ranges::find(low, facet) != low.end();
    parts[below ? 1 : 0].facets.push_back(middles.whole(facet));
  }
  int group = first_cut_group;
  for (const auto& [name, facets] : shape.cuts) {
    parts.push_back({name, {group++}, {}});
    if (shape.closed) parts.back().groups.insert(parts.back().groups.begin(), skin_group);
    for (const Facet& facet : facets) parts.back().facets.push_back(middles.whole(facet));
  }
  return parts;
}

}  // namespace

std::string Shape::gmsh() const {
  const std::vector<Part> parts = gmsh_parts(*this);
  std::string out = head_of(*this, parts, has_bottom());
  out += fmt::format("$Nodes\n1 {0} 1 {0}\n{1} 1 0 {0}\n", points.size(), dim);
  for (std::size_t n = 1; n <= points.size(); ++n) out += fmt::format("{}\n", n);
  for (const Eigen::Vector3d& x : points)
    out += fmt::format("{:.17g} {:.17g} {:.17g}\n", x(0), x(1), x(2));
  std::size_t count = cells.size();
  for (const Part& part : parts) count += part.facets.size();
  out += fmt::format("$EndNodes\n$Elements\n{0} {1} 1 {1}\n", parts.size() + 1, count);
  std::size_t tag = 0;
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (!parts[k].facets.empty())
      out += block(dim - 1, static_cast<int>(k) + 1, facet_type(parts[k].facets[0].size(), dim),
                   parts[k].facets, tag);
  const std::map<std::string, int> types = {{"tri3", 2}, {"quad4", 3}, {"tet4", 4},
                                            {"hex8", 5}, {"tri6", 9},  {"tet10", 11}};
  return out + block(dim, 1, types.at(element), cells, tag) + "$EndElements\n";
}

}  // namespace abut
