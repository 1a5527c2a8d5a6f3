#include "subdomain_solver/fe/surface_shape.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "base/error.hpp"
#include "base/index.hpp"
#include "contract/whole_facets.hpp"

namespace abut {

namespace {

using Eigen::Vector3d;

/// Of a facet's size: how thick the cells behind it are.
constexpr double thickness = 0.05;
constexpr const char* block_name = "surface alone";

/// Facets made to look the same way, part by part.
class Orienter {
 public:
  Orienter(SurfaceFacets& surface, const std::string& where) : surface_(surface), where_(where) {}

  void run() {
    join();
    seen_.assign(surface_.facets.size(), 0);
    for (std::size_t first = 0; first < seen_.size(); ++first) {
      if (seen_[first] != 0) continue;
      part_.clear();
      bool closed = true;
      double volume = 0.0;
      follow(first, closed);
      for (const std::size_t f : part_) volume += volume_of(f);
      for (const std::size_t f : part_)
        if (closed && volume < 0.0) std::swap(surface_.facets[f][0], surface_.facets[f][1]);
    }
  }

 private:
  using Edge = std::array<std::int32_t, 2>;  // in the plane a node and -1

  /// The edges of a facet as it goes round, in the plane its begin and its end; and whether it goes
  /// along an edge from its smaller node.
  std::vector<std::pair<Edge, bool>> edges_of(std::size_t f) const {
    const auto& n = surface_.facets[f];
    if (surface_.dim == 2) return {{{n[0], -1}, true}, {{n[1], -1}, false}};
    std::vector<std::pair<Edge, bool>> out;
    for (const std::size_t i : {0u, 1u, 2u}) {
      const std::int32_t a = n[i], b = n[(i + 1) % 3];
      out.push_back({{std::min(a, b), std::max(a, b)}, a < b});
    }
    return out;
  }

  void join() {
    for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
      for (const auto& [edge, along] : edges_of(f)) {
        std::vector<std::size_t>& facets = at_[edge];
        facets.push_back(f);
        if (facets.size() > 2)
          refuse(f,
                 surface_.dim == 2 ? "meets more than one other at a node"
                                   : "shares an edge with more than one other",
                 "Let each edge belong to two facets, or to one where the surface ends.");
      }
    }
  }

  /// From one facet over all that hang together with it.
  void follow(std::size_t first, bool& closed) {
    seen_[first] = 1;
    part_.push_back(first);
    for (std::size_t k = 0; k < part_.size(); ++k) {
      for (const auto& [edge, along] : edges_of(part_[k])) {
        const std::vector<std::size_t>& facets = at_[edge];
        closed = closed && facets.size() == 2;
        for (const std::size_t other : facets) {
          if (other == part_[k]) continue;
          bool same = false;
          for (const auto& [its, its_along] : edges_of(other))
            same = same || (its == edge && its_along == along);
          if (seen_[other] == 0) {
            if (same) std::swap(surface_.facets[other][0], surface_.facets[other][1]);
            seen_[other] = 1;
            part_.push_back(other);
          } else if (same) {
            refuse(other,
                   "cannot look to the same side as its neighbours: the surface has one side",
                   "Cut the surface, or mesh a body.");
          }
        }
      }
    }
  }

  /// Times the dimension: of the cone from the origin.
  double volume_of(std::size_t f) const {
    const auto& n = surface_.facets[f];
    const Vector3d a = at(n[0]), b = at(n[1]);
    if (surface_.dim == 2) return a.x() * b.y() - a.y() * b.x();
    return a.dot(b.cross(at(n[2])));
  }

  Vector3d at(std::int32_t node) const {
    Vector3d x = Vector3d::Zero();
    for (int i = 0; i < surface_.dim; ++i)
      x(i) = surface_.points[index(node) * index(surface_.dim) + index(i)];
    return x;
  }

  [[noreturn]] void refuse(std::size_t f, const std::string& what, const char* remedy) const {
    throw InputError(surface_.names[f] + " " + what, where_, remedy);
  }

  SurfaceFacets& surface_;
  const std::string& where_;
  std::map<Edge, std::vector<std::size_t>> at_;  // facets at an edge
  std::vector<char> seen_;
  std::vector<std::size_t> part_;
};

/// Behind a facet's middle: the inner side is on the left of segments, and where triangles that are
/// seen from there go round clockwise.
Vector3d inner_node(const std::array<Vector3d, 3>& x, int dim) {
  if (dim == 2) {
    const Vector3d along = x[1] - x[0];
    return 0.5 * (x[0] + x[1]) + thickness * Vector3d(-along.y(), along.x(), 0.0);
  }
  const Vector3d area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
  const double size = std::sqrt(area.norm());
  return (x[0] + x[1] + x[2]) / 3.0 - thickness * (size > 0.0 ? Vector3d(area / size) : area);
}

/// Points of no facet: of a file's other elements, in the middle of those of second order.
void drop_unused(SurfaceFacets& surface) {
  const std::size_t dim = index(surface.dim);
  std::vector<std::int32_t> number(surface.points.size() / dim, -1);
  for (const auto& facet : surface.facets)
    for (std::size_t a = 0; a < dim; ++a) number[index(facet[a])] = 0;
  std::vector<double> points;
  std::int32_t next = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    number[n] = next++;
    for (std::size_t i = 0; i < dim; ++i) points.push_back(surface.points[n * dim + i]);
  }
  for (auto& facet : surface.facets)
    for (std::size_t a = 0; a < dim; ++a) facet[a] = number[index(facet[a])];
  surface.points = std::move(points);
}

std::int32_t local_facet(const Element& cell, int nodes) {
  for (std::size_t local = 0; local < cell.facets.size(); ++local)
    if (std::ranges::all_of(cell.facets[local], [nodes](int node) { return node < nodes; }))
      return static_cast<std::int32_t>(local);
  return 0;
}

}  // namespace

void SurfaceFacets::add(std::span<const std::int32_t> nodes, const std::string& name,
                        std::span<const std::string> in_groups) {
  const auto push = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    for (const std::string& group : in_groups)
      groups[group].push_back(static_cast<std::int32_t>(facets.size()));
    facets.push_back({a, b, c});
    names.push_back(name);
  };
  for (const std::vector<int>& part : straight_parts(dim, nodes.size())) {
    const auto node = [&](std::size_t i) { return nodes[index(part[i])]; };
    push(node(0), node(1), dim == 2 ? -1 : node(2));
    if (part.size() == 4) push(node(0), node(2), node(3));
  }
}

Mesh surface_shape(SurfaceFacets surface, const std::string& where) {
  drop_unused(surface);
  Orienter(surface, where).run();
  Mesh mesh;
  mesh.dim = surface.dim;
  mesh.points = std::move(surface.points);
  const std::size_t dim = surface.dim == 2 ? 2 : 3;
  CellBlock& cells = mesh.blocks.emplace_back();
  cells.element = &linear_element(surface.dim == 2 ? Shape::triangle : Shape::tetrahedron);
  cells.name = block_name;
  const std::int32_t local = local_facet(*cells.element, surface.dim);
  std::vector<Facet> all;
  for (const std::array<std::int32_t, 3>& nodes : surface.facets) {
    std::array<Vector3d, 3> x{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    for (std::size_t a = 0; a < dim; ++a)
      for (std::size_t i = 0; i < dim; ++i)
        x[a](static_cast<Eigen::Index>(i)) = mesh.points[index(nodes[a]) * dim + i];
    const Vector3d inner = inner_node(x, surface.dim);
    // Seen from the node inside, a triangle goes round clockwise.
    cells.nodes.push_back(nodes[0]);
    if (surface.dim == 3) cells.nodes.push_back(nodes[2]);
    cells.nodes.push_back(nodes[1]);
    cells.nodes.push_back(mesh.node_count());
    for (int i = 0; i < surface.dim; ++i) mesh.points.push_back(inner(i));
    all.push_back({0, static_cast<std::int32_t>(all.size()), local});
  }
  for (const auto& [name, facets] : surface.groups)
    for (const std::int32_t f : facets) mesh.sides[name].push_back(all[index(f)]);
  mesh.sides.try_emplace("boundary", std::move(all));
  return mesh;
}

bool is_surface_shape(const Mesh& mesh) {
  return mesh.blocks.size() == 1 && mesh.blocks.front().name == block_name;
}

}  // namespace abut
