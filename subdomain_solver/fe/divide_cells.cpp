#include "subdomain_solver/fe/divide_cells.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

/// Of an element of ours: as of those that we do not have.
DividedShape shape_like(std::string_view name, std::string_view plural, const Element& linear,
                        std::span<const Edge> edges) {
  DividedShape shape = {name, plural, linear.nodes, linear.facets, {}};
  shape.edges.assign(edges.begin(), edges.end());
  return shape;
}

const DividedShape& hexahedron_shape() {
  static const DividedShape shape =
      shape_like("hexahedron", "hexahedra", linear_element(Shape::hexahedron), hexahedron_edges);
  return shape;
}

/// In the plane a face is the cell.
const DividedShape& quadrilateral_shape() {
  static const DividedShape shape = {"quadrilateral",
                                     "quadrilaterals",
                                     4,
                                     {{0, 1, 2, 3}},
                                     {quadrilateral_edges.begin(), quadrilateral_edges.end()}};
  return shape;
}

const Element& simplex(Shape shape, bool quadratic) {
  for (const Element& element : all_elements())
    if (element.shape == shape && element.order == (quadratic ? 2 : 1)) return element;
  ABUT_ASSERT(false);
  return all_elements().front();
}

class Divider {
 public:
  explicit Divider(FileMesh& file) : file_(file) {}

  void run() {
    std::vector<FileMesh::Elements> kept, parts;
    for (FileMesh::Elements& block : file_.elements) {
      const bool hexahedra = block.type->shape == Shape::hexahedron;
      if (!hexahedra && block.type->shape != Shape::quadrilateral) {
        kept.push_back(std::move(block));
        continue;
      }
      const FileMesh::Divided whole = {hexahedra ? &hexahedron_shape() : &quadrilateral_shape(),
                                       block.type->order > 1,
                                       block.entity,
                                       std::move(block.where),
                                       std::move(block.tags),
                                       std::move(block.nodes),
                                       std::move(block.origins)};
      parts.push_back(divide(whole, index(block.type->nodes)));
    }
    for (const FileMesh::Divided& whole : file_.divided)
      parts.push_back(divide(whole, index(whole.shape->nodes(whole.quadratic))));
    std::ranges::move(parts, std::back_inserter(kept));
    file_.elements = std::move(kept);
    file_.divided.clear();
    add_note();
  }

 private:
  using Triangle = std::array<int, 3>;  // local corners

  /// `stride`: nodes per cell in the list, of which those beyond the edges' are left out.
  FileMesh::Elements divide(const FileMesh::Divided& whole, std::size_t stride) {
    const bool flat = whole.shape == &quadrilateral_shape();
    FileMesh::Elements out;
    out.type = &simplex(flat ? Shape::triangle : Shape::tetrahedron, whole.quadratic);
    out.entity = whole.entity;
    out.where = whole.where;
    for (std::size_t cell = 0; cell < whole.tags.size(); ++cell) {
      shape_ = whole.shape;
      nodes_ = std::span(whole.nodes).subspan(cell * stride, stride);
      const std::size_t before = out.nodes.size();
      flat ? add_triangles(out) : add_tetrahedra(out);
      const std::size_t count = (out.nodes.size() - before) / index(out.type->nodes);
      out.tags.insert(out.tags.end(), count, whole.tags[cell]);
      if (!whole.origins.empty()) out.origins.insert(out.origins.end(), count, whole.origins[cell]);
      if (!flat) ++counts_[whole.shape->plural].second;
      if (!flat) tetrahedra_ += count;
    }
    if (!flat) counts_[whole.shape->plural].first = whole.shape->name;
    linear_ = linear_ || (!flat && !whole.quadratic);
    return out;
  }

  std::vector<Triangle> triangles(std::vector<int> face) const {
    const auto before = [this](int a, int b) { return nodes_[a] < nodes_[b]; };
    std::rotate(face.begin(), std::min_element(face.begin(), face.end(), before), face.end());
    std::vector<Triangle> out;
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      out.push_back({face[0], face[k], face[k + 1]});
    return out;
  }

  void add_triangles(FileMesh::Elements& out) {
    for (const Triangle& t : triangles(shape_->faces[0])) add_simplex(out, t);
  }

  void add_tetrahedra(FileMesh::Elements& out) {
    const auto corners = nodes_.first(index(shape_->corners));
    const int top = static_cast<int>(std::ranges::min_element(corners) - corners.begin());
    for (const std::vector<int>& face : shape_->faces) {
      if (std::ranges::find(face, top) != face.end()) continue;
      // from outside the face goes round to the left, as a tetrahedron's base does from its top
      for (const Triangle& t : triangles(face))
        add_simplex(out, std::array<int, 4>{t[0], t[2], t[1], top});
    }
  }

  template <std::size_t N>
  void add_simplex(FileMesh::Elements& out, const std::array<int, N>& corners) {
    for (int corner : corners) out.nodes.push_back(nodes_[corner]);
    for (const std::vector<int>& pair : out.type->between)
      out.nodes.push_back(middle(corners[pair[0]], corners[pair[1]]));
  }

  std::int32_t middle(int a, int b) {
    for (std::size_t e = 0; e < shape_->edges.size(); ++e) {
      const Edge& edge = shape_->edges[e];
      if (edge == Edge{a, b} || edge == Edge{b, a}) return nodes_[index(shape_->corners) + e];
    }
    const std::pair<std::int32_t, std::int32_t> ends = std::minmax(nodes_[a], nodes_[b]);
    const auto [entry, fresh] =
        middles_.try_emplace(ends, static_cast<std::int32_t>(file_.node_tags.size()));
    if (fresh) add_node(a, b);
    return entry->second;
  }

  /// The middle of a face, -1/4 of its corners and 1/2 of the nodes between them (quad8), or of the
  /// cell, -1/4 and 1/4 (hex20): the weights sum to 1.
  void add_node(int a, int b) {
    std::vector<int> on;  // corners
    for (const std::vector<int>& face : shape_->faces)
      if (std::ranges::count(face, a) + std::ranges::count(face, b) == 2) on = face;
    const bool inside = on.empty();
    for (int corner = 0; inside && corner < shape_->corners; ++corner) on.push_back(corner);
    std::array<double, 3> at{};
    const auto add = [this, &at](std::int32_t node, double weight) {
      for (std::size_t d = 0; d < 3; ++d) at[d] += weight * file_.points[3 * index(node) + d];
    };
    for (int corner : on) add(nodes_[corner], -0.25);
    for (std::size_t e = 0; e < shape_->edges.size(); ++e) {
      const Edge& edge = shape_->edges[e];
      if (std::ranges::count(on, edge[0]) + std::ranges::count(on, edge[1]) == 2)
        add(nodes_[index(shape_->corners) + e], inside ? 0.25 : 0.5);
    }
    file_.points.insert(file_.points.end(), at.begin(), at.end());
    file_.node_tags.push_back(0);
  }

  void add_note() {
    std::string cells;
    for (const auto& [plural, one] : counts_)
      cells += fmt::format("{}{} {}", cells.empty() ? "" : " and ", one.second,
                           one.second == 1 ? one.first : plural);
    file_.notes.push_back(fmt::format(
        "{} divided into {} tetrahedra{}", cells, tetrahedra_,
        linear_ ? ", which are stiff in bending and lock when nearly incompressible" : ""));
  }

  FileMesh& file_;
  const DividedShape* shape_ = nullptr;                                    // of the cell at hand
  std::span<const std::int32_t> nodes_;                                    // of the cell at hand
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles_;  // of diagonals
  std::map<std::string_view, std::pair<std::string_view, std::size_t>> counts_;  // by plural
  std::size_t tetrahedra_ = 0;
  bool linear_ = false;
};

}  // namespace

const DividedShape& pyramid_shape() {
  static const DividedShape shape = {
      "pyramid",
      "pyramids",
      5,
      {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
      {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}}};
  return shape;
}

const DividedShape& prism_shape() {
  static const DividedShape shape = {
      "prism",
      "prisms",
      6,
      {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}};
  return shape;
}

void divide_cells(FileMesh& file) {
  if (!file.divided.empty()) Divider(file).run();
}

}  // namespace abut
