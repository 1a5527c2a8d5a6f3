#include "subdomain_solver/overlap/embed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

#include <Eigen/LU>

#include "base/index.hpp"
#include "surface/closest_point.hpp"

namespace abut {

namespace {

/// Of a cell: what is no distance; of a facet: what is no part of it.
constexpr double nothing = 1.0e-9;
/// Of a cell: points this near are one.
constexpr double same = 1.0e-7;
/// Of shape functions, which are up to 1.
constexpr double rounding = 1.0e-12;
/// Of three linear factors of a shape function, and one to weigh it.
constexpr int degree = 4;

/// A row over nodes of a mesh, ascending.
using Row = std::vector<std::pair<std::int32_t, double>>;

/// Of values at the nodes of a cell; those that are rounding are left out, and the others sum to 1.
Row row_of(const Mesh& mesh, CellPlace cell, const Eigen::VectorXd& values) {
  const std::span<const std::int32_t> nodes = nodes_of(mesh.blocks[index(cell.block)], cell.cell);
  Row row;
  double sum = 0.0;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const double value = values(static_cast<Eigen::Index>(a));
    if (std::abs(value) < rounding) continue;
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

void append(const Row& row, const Eigen::Vector3d& at, int dim, EmbeddedSurface& to) {
  to.points.insert(to.points.end(), at.data(), at.data() + dim);
  for (const auto& [node, value] : row) {
    to.rows.columns.push_back(node);
    to.rows.values.push_back(value);
  }
  to.rows.end_row();
}

/// What the corners of a part of a facet are to move by, so that their linear interpolant has the
/// means of the cell's motion against linear functions: (corners, nodes of the cell).
Eigen::MatrixXd means(const Mesh& mesh, CellPlace cell, const Simplex& part) {
  const int corners = part.count;
  const Element& linear = element_named(corners == 2 ? "bar2" : "tri3");
  const Tabulation t = tabulate(linear, quadrature(linear.shape, degree));
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(corners, corners), sums;
  for (int p = 0; p < t.points; ++p) {
    const Eigen::Map<const Eigen::VectorXd> n(t.n.data() + index(p * corners), corners);
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (int i = 0; i < corners; ++i) at += n(i) * part.x[index(i)];
    const Eigen::VectorXd shapes = shapes_at(mesh, cell, at);
    if (p == 0) sums.setZero(corners, shapes.size());
    mass += t.weight[index(p)] * n * n.transpose();
    sums += t.weight[index(p)] * n * shapes.transpose();
  }
  return mass.partialPivLu().solve(sums);
}

class Embedder {
 public:
  Embedder(const MeshSimplices& cells, EmbeddedSurface& out) : cells_(cells), out_(out) {
    out_.offsets = {0};
    out_.rows.clear();
  }

  void add(const Simplex& part, CellPlace cell) {
    const Eigen::MatrixXd values = means(cells_.mesh(), cell, part);
    for (int i = part.count - 1; i >= 0; --i)  // seen from inside this body
      out_.facets.push_back(
          point(part.x[index(i)], row_of(cells_.mesh(), cell, values.row(i).transpose())));
    out_.offsets.push_back(static_cast<std::int32_t>(out_.facets.size()));
  }

 private:
  using Key = std::array<std::int64_t, 3>;

  /// Parts share points where they say the same of them: where motion is linear along them.
  std::int32_t point(const Eigen::Vector3d& at, const Row& row) {
    Key key;
    for (int i = 0; i < 3; ++i) key[index(i)] = std::llround(at(i) / (same * cells_.spacing()));
    std::vector<std::pair<std::int32_t, Row>>& here = places_[key];
    for (const auto& [place, other] : here)
      if (equal(other, row)) return place;
    here.emplace_back(out_.rows.count(), row);
    append(row, at, cells_.mesh().dim, out_);
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
  append(row_of(mesh, cell, shapes_at(mesh, cell, at)), at, mesh.dim, to);
}

void add_node(const Mesh& mesh, std::int32_t node, EmbeddedSurface& to) {
  const double* x = mesh.points.data() + std::ptrdiff_t{node} * mesh.dim;
  append({{node, 1.0}}, {x[0], x[1], mesh.dim == 3 ? x[2] : 0.0}, mesh.dim, to);
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

EmbeddedSurface embed(const BoundarySimplices& boundary, const MeshSimplices& cells,
                      const BoundarySimplices& skin, StickingOut& sticking) {
  EmbeddedSurface out;
  Embedder embedder(cells, out);
  const double near = nothing * cells.spacing();
  std::vector<FacetPair> pairs;
  overlapping_pairs(boundary.tree, cells.tree(), pairs);
  std::vector<Simplex> left, next, inside, outside;
  std::size_t p = 0;
  for (int f = 0; f < boundary.count(); ++f) {
    const Simplex whole = boundary.simplex(f);
    const double least = nothing * measure(whole);
    left.assign(1, whole);
    for (; p < pairs.size() && pairs[p].k == f; ++p) {
      const std::vector<HalfSpace> sides = sides_of(cells.simplex(pairs[p].n));
      next.clear();
      for (const Simplex& part : left) {
        outside.clear();
        divide(part, sides, near, inside, &outside);
        if (inside.empty()) outside.assign(1, part);  // undivided
        next.insert(next.end(), outside.begin(), outside.end());
        for (const Simplex& found : inside)
          if (measure(found) > least) embedder.add(found, cells.cell(pairs[p].n));
      }
      left.swap(next);
    }
    for (const Simplex& part : left) {
      if (measure(part) <= least) continue;
      for (int i = 0; i < part.count; ++i) {
        const double apart = distance(skin, part.x[index(i)]);
        if (apart > sticking.distance) sticking = {apart, part.x[index(i)]};
      }
    }
  }
  return out;
}

}  // namespace abut
