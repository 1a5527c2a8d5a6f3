#include "subdomain_solver/overlap/embed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "surface/closest_point.hpp"

namespace abut {

namespace {

/// Of a cell: what is no distance; of a facet: what is no part of it.
constexpr double nothing = 1.0e-9;
/// Of a cell: points this near are one.
constexpr double same = 1.0e-7;
/// Of shape functions, which are up to 1.
constexpr double embed_rounding = 1.0e-12;
/// Of three linear factors of a shape function, and one to weigh it; in either direction of a
/// quadrilateral, one more.
constexpr int degree = 4;

/// A row over nodes of a mesh, ascending.
using Row = std::vector<std::pair<std::int32_t, double>>;

/// Of values at the nodes of a cell; those that are rounding are left out, and the others sum to 1.
Row row_of(const Mesh& mesh, CellPlace cell, const Eigen::VectorXd& values) {
  const std::span<const std::int32_t> nodes = nodes_of(mesh.blocks[cell.block], cell.cell);
  Row row;
  double sum = 0.0;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const double value = values(static_cast<Eigen::Index>(a));
    if (std::abs(value) < embed_rounding) continue;
    row.emplace_back(nodes[a], value);
    sum += value;
  }
  std::ranges::sort(row);
  for (auto& [node, value] : row) value /= sum;
  return row;
}

Eigen::VectorXd shapes_at(const Mesh& mesh, CellPlace cell, const Eigen::Vector3d& at) {
  const std::vector<double> n = shape_values(mesh, cell, reference_place(mesh, cell, at));
  return Eigen::Map<const Eigen::VectorXd>(n.data(), static_cast<Eigen::Index>(n.size()));
}

void append_row(const Row& row, const Eigen::Vector3d& at, int dim, EmbeddedSurface& to) {
  to.points.insert(to.points.end(), at.data(), at.data() + dim);
  for (const auto& [node, value] : row) {
    to.rows.columns.push_back(node);
    to.rows.values.push_back(value);
  }
  to.rows.end_row();
}

/// A part of a facet: a segment, a triangle, or a quadrilateral that lies in one cell as a whole.
using CellCorners = std::span<const Eigen::Vector3d>;

/// Of a part at a point of its rule, per weight: that of segments and triangles is the same
/// everywhere.
double stretch(const Tabulation& t, int point, CellCorners corners) {
  if (corners.size() < 4) return 1.0;
  Eigen::Matrix<double, 3, 2> along = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t d = 0; d < 2; ++d)
      along.col(static_cast<Eigen::Index>(d)) += t.dn[(index(point) * 4 + i) * 2 + d] * corners[i];
  return along.col(0).cross(along.col(1)).norm();
}

/// What the corners of a part of a facet are to move by, so that their interpolant, linear or
/// bilinear, has the means of the cell's motion against such functions: (corners, nodes of the
/// cell). A quadrilateral that is a facet of the cell moves as its nodes do, warp included.
Eigen::MatrixXd means(const Mesh& mesh, CellPlace cell, CellCorners corners) {
  const auto count = static_cast<Eigen::Index>(corners.size());
  const Element& linear = linear_element(count == 2   ? Shape::line
                                         : count == 3 ? Shape::triangle
                                                      : Shape::quadrilateral);
  const Tabulation t = tabulate(linear, quadrature(linear.shape, degree));
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(count, count), sums;
  for (int p = 0; p < t.points; ++p) {
    const Eigen::Map<const Eigen::VectorXd> n(t.n.data() + index(p) * corners.size(), count);
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < count; ++i) at += n(i) * corners[i];
    const Eigen::VectorXd shapes = shapes_at(mesh, cell, at);
    if (p == 0) sums.setZero(count, shapes.size());
    const double weight = t.weight[p] * stretch(t, p, corners);
    mass += weight * n * n.transpose();
    sums += weight * n * shapes.transpose();
  }
  return solve_square(mass, sums);
}

class Embedder {
 public:
  Embedder(const MeshSimplices& cells, EmbeddedSurface& out) : cells_(cells), out_(out) {
    out_.offsets = {0};
    out_.rows.clear();
  }

  void add(CellCorners part, CellPlace cell) {
    const Eigen::MatrixXd values = means(cells_.mesh(), cell, part);
    for (Eigen::Index i = values.rows() - 1; i >= 0; --i)  // seen from inside this body
      out_.facets.push_back(point(part[i], row_of(cells_.mesh(), cell, values.row(i).transpose())));
    out_.offsets.push_back(static_cast<std::int32_t>(out_.facets.size()));
  }

 private:
  using Key = std::array<std::int64_t, 3>;

  /// Parts share points where they say the same of them: where motion is linear along them.
  std::int32_t point(const Eigen::Vector3d& at, const Row& row) {
    Key key;
    for (int i = 0; i < 3; ++i) key[i] = std::llround(at(i) / (same * cells_.spacing()));
    std::vector<std::pair<std::int32_t, Row>>& here = places_[key];
    for (const auto& [place, other] : here)
      if (equal(other, row)) return place;
    here.emplace_back(out_.rows.count(), row);
    append_row(row, at, cells_.mesh().dim, out_);
    return here.back().first;
  }

  static bool equal(const Row& a, const Row& b) {
    constexpr double digits = 1.0e-11;
    bool alike = a.size() == b.size();
    for (std::size_t k = 0; alike && k < a.size(); ++k)
      alike = a[k].first == b[k].first && std::abs(a[k].second - b[k].second) < digits;
    return alike;
  }

  const MeshSimplices& cells_;
  EmbeddedSurface& out_;
  std::map<Key, std::vector<std::pair<std::int32_t, Row>>> places_;
};

bool holds(const Simplex& simplex, const Eigen::Vector3d& at, double near) {
  return std::ranges::none_of(sides_of(simplex),
                              [&](const HalfSpace& side) { return side.distance(at) > near; });
}

/// Every node of a mesh as a facet without extent.
PosedSurface lone_nodes(const Mesh& mesh, std::vector<std::int32_t>& nodes,
                        std::vector<std::int32_t>& offsets) {
  offsets.push_back(0);
  for (std::int32_t node = 0; node < mesh.node_count(); ++node) {
    nodes.insert(nodes.end(), index(mesh.dim), node);
    offsets.push_back(static_cast<std::int32_t>(nodes.size()));
  }
  return {mesh.dim, mesh.points, nodes, offsets};
}

}  // namespace

double distance(const BoundarySimplices& boundary, const Eigen::Vector3d& at) {
  const PosedSurface surface{boundary.mesh.dim, boundary.mesh.points, boundary.nodes,
                             boundary.offsets};
  return closest_point(surface, boundary.tree, at)->at.distance;
}

void add_point(const Mesh& mesh, const Eigen::Vector3d& at, CellPlace cell, EmbeddedSurface& to) {
  append_row(row_of(mesh, cell, shapes_at(mesh, cell, at)), at, mesh.dim, to);
}

void add_node(const Mesh& mesh, std::int32_t node, EmbeddedSurface& to) {
  const double* x = mesh.points.data() + std::ptrdiff_t{node} * mesh.dim;
  append_row({{node, 1.0}}, {x[0], x[1], mesh.dim == 3 ? x[2] : 0.0}, mesh.dim, to);
}

std::vector<HeldNode> held_nodes(const Mesh& mesh, const MeshSimplices& cells) {
  std::vector<std::int32_t> nodes, offsets;
  const PosedSurface points = lone_nodes(mesh, nodes, offsets);
  BoxTree tree;
  build(tree, points, 0.0);
  std::vector<FacetPair> pairs;
  overlapping_pairs(tree, cells.tree(), pairs);
  std::vector<HeldNode> held;
  for (const FacetPair& pair : pairs) {
    if (!held.empty() && held.back().node == pair.k) continue;
    if (holds(cells.simplex(pair.n), points.point(pair.k), nothing * cells.spacing()))
      held.push_back({pair.k, cells.cell(pair.n)});
  }
  return held;
}

namespace {

/// The corners of the quadrilateral that a triangle and the next one are; nothing: of another kind.
std::optional<std::array<Eigen::Vector3d, 4>> quadrilateral(const BoundarySimplices& boundary,
                                                            int f) {
  const bool next = f + 1 < boundary.count() && boundary.facet[f] == boundary.facet[index(f) + 1];
  const bool first = f == 0 || boundary.facet[f] != boundary.facet[index(f) - 1];
  if (!next || !first || boundary.mesh.dim != 3) return std::nullopt;
  const Simplex one = boundary.simplex(f), two = boundary.simplex(f + 1);  // a fan
  return std::array{one.x[0], one.x[1], one.x[2], two.x[2]};
}

/// The cell that holds all corners of a quadrilateral and its middle, among those that may meet its
/// triangles.
std::optional<CellPlace> cell_around(const std::array<Eigen::Vector3d, 4>& corners,
                                     std::span<const FacetPair> pairs, const MeshSimplices& cells,
                                     double near) {
  const auto held = [&](const Eigen::Vector3d& at, CellPlace cell) {
    return std::ranges::any_of(pairs, [&](const FacetPair& pair) {
      return cells.cell(pair.n) == cell && holds(cells.simplex(pair.n), at, near);
    });
  };
  const Eigen::Vector3d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  std::vector<CellPlace> tried;
  for (const FacetPair& pair : pairs) {
    const CellPlace cell = cells.cell(pair.n);
    if (std::ranges::find(tried, cell) != tried.end()) continue;
    tried.push_back(cell);
    const bool all = held(middle, cell) && std::ranges::all_of(corners, [&](const auto& corner) {
                       return held(corner, cell);
                     });
    if (all) return cell;
  }
  return std::nullopt;
}

/// Parts of a facet's simplex, each in a cell; what is in none is added to what is left.
void divide_among(const Simplex& whole, std::span<const FacetPair> pairs,
                  const MeshSimplices& cells, Embedder& embedder, std::vector<Simplex>& left) {
  const double near = nothing * cells.spacing(), least = nothing * measure(whole);
  std::vector<Simplex> next, inside, outside;
  left.assign(1, whole);
  for (const FacetPair& pair : pairs) {
    const std::vector<HalfSpace> sides = sides_of(cells.simplex(pair.n));
    next.clear();
    for (const Simplex& part : left) {
      outside.clear();
      divide(part, sides, near, inside, &outside);
      if (inside.empty()) outside.assign(1, part);  // undivided
      next.insert(next.end(), outside.begin(), outside.end());
      for (const Simplex& found : inside)
        if (measure(found) > least)
          embedder.add(std::span(found.x).first(index(found.count)), cells.cell(pair.n));
    }
    left.swap(next);
  }
  std::erase_if(left, [least](const Simplex& part) { return measure(part) <= least; });
}

}  // namespace

EmbeddedSurface embed(const BoundarySimplices& boundary, const MeshSimplices& cells,
                      const BoundarySimplices& skin, StickingOut& sticking) {
  EmbeddedSurface out;
  Embedder embedder(cells, out);
  std::vector<FacetPair> pairs;
  overlapping_pairs(boundary.tree, cells.tree(), pairs);
  std::vector<Simplex> left;
  const auto of = [&pairs](int f, int count) {
    const auto from = std::ranges::lower_bound(pairs, f, {}, &FacetPair::k);
    const auto to = std::ranges::lower_bound(pairs, f + count, {}, &FacetPair::k);
    return std::span<const FacetPair>(from, to);
  };
  for (int f = 0; f < boundary.count(); ++f) {
    if (const auto corners = quadrilateral(boundary, f)) {
      const auto cell = cell_around(*corners, of(f, 2), cells, nothing * cells.spacing());
      if (cell) {
        embedder.add(*corners, *cell);
        ++f;
        continue;
      }
    }
    divide_among(boundary.simplex(f), of(f, 1), cells, embedder, left);
    for (const Simplex& part : left) {
      for (int i = 0; i < part.count; ++i) {
        const double apart = distance(skin, part.x[i]);
        if (apart > sticking.distance) sticking = {apart, part.x[i]};
      }
    }
  }
  return out;
}

}  // namespace abut
