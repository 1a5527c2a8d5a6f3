#include "subdomain_solver/overlap/cell_shares.hpp"

#include <map>
#include <span>
#include <utility>

#include "base/dense.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Of a cell: less is none of it, all but that is all of it; and of its size, what is no distance.
constexpr double no_share = 1.0e-9;

/// Exact for shape functions of parallelepipeds, three of whose factors are linear.
constexpr int share_degree = 4;

struct Cells {
  std::vector<std::size_t> first;  // (blocks) where a block's cells begin in a list of all
  std::size_t count = 0;

  explicit Cells(const Mesh& mesh) {
    for (const CellBlock& block : mesh.blocks) {
      first.push_back(count);
      count += index(block.count());
    }
  }
  std::size_t at(CellPlace place) const { return first[place.block] + index(place.cell); }
};

/// Adds the integrals of a cell's shape functions over a part of it, in reference coordinates.
void add_integrals(const Mesh& mesh, CellPlace place, const Simplex& part,
                   std::vector<double>& out) {
  const Element& element = *mesh.blocks[place.block].element;
  const std::size_t dim = index(mesh.dim), nodes = index(element.nodes);
  const Quadrature rule = quadrature(dim == 2 ? Shape::triangle : Shape::tetrahedron, share_degree);
  const double unit = dim == 2 ? 2.0 : 6.0;  // volume of the reference simplex: 1 of so many
  const std::span<const std::int32_t> own = nodes_of(mesh.blocks[place.block], place.cell);
  std::vector<double> n(nodes), dn(nodes * dim);
  for (int p = 0; p < rule.count(); ++p) {
    Eigen::Vector3d at = part.x[0];
    for (std::size_t i = 0; i < dim; ++i)
      at += rule.points[index(p) * dim + i] * (part.x[i + 1] - part.x[0]);
    const std::vector<double> xi = reference_place(mesh, place, at);
    element.evaluate(xi, n, dn);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(mesh.dim, mesh.dim);
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t i = 0; i < dim; ++i)
        for (std::size_t k = 0; k < dim; ++k)
          jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) +=
              mesh.points[index(own[a]) * dim + i] * dn[a * dim + k];
    const double weight = unit * measure(part) * rule.weights[p] / determinant_of(jacobian);
    for (std::size_t a = 0; a < nodes; ++a) out[a] += weight * n[a];
  }
}

/// The same over the whole reference cell.
std::vector<double> whole_integrals(const Element& element) {
  const Tabulation t = tabulate(element, quadrature(element.shape, 2));
  std::vector<double> out(index(t.nodes), 0.0);
  for (int p = 0; p < t.points; ++p)
    for (int a = 0; a < t.nodes; ++a) out[a] += t.weight[p] * t.n[p * t.nodes + a];
  return out;
}

}  // namespace

CommonParts common_parts(const MeshSimplices& own, const MeshSimplices& other) {
  const Mesh& mesh = own.mesh();
  const Cells cells(mesh);
  std::vector<double> volume(cells.count, 0.0), common(cells.count, 0.0);
  for (int i = 0; i < own.count(); ++i) volume[cells.at(own.cell(i))] += measure(own.simplex(i));
  std::vector<FacetPair> pairs;
  overlapping_pairs(own.tree(), other.tree(), pairs);
  const double near = no_share * own.spacing();
  std::vector<Simplex> inside;
  std::vector<std::pair<CellPlace, Simplex>> found;
  for (const FacetPair& pair : pairs) {
    divide(own.simplex(pair.k), sides_of(other.simplex(pair.n)), near, inside, nullptr);
    for (const Simplex& part : inside) {
      common[cells.at(own.cell(pair.k))] += measure(part);
      found.emplace_back(own.cell(pair.k), part);
    }
  }
  CommonParts out;
  std::map<std::size_t, CommonParts::Part> by_cell;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    for (int c = 0; c < mesh.blocks[b].count(); ++c) {
      const CellPlace place{static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)};
      const std::size_t at = cells.at(place);
      if (common[at] <= no_share * volume[at]) continue;
      out.volume += common[at];
      const bool all = common[at] >= (1.0 - no_share) * volume[at];
      const std::size_t nodes = index(mesh.blocks[b].element->nodes);
      by_cell[at] = {place, std::vector<double>(nodes, all ? 1.0 : 0.0)};
      if (all) common[at] = 0.0;  // nothing to integrate
    }
  }
  for (const auto& [place, part] : found) {
    const std::size_t at = cells.at(place);
    if (by_cell.contains(at) && common[at] > 0.0) add_integrals(mesh, place, part, by_cell[at].of);
  }
  for (auto& [at, part] : by_cell) {
    if (common[at] > 0.0) {
      const std::vector<double> whole = whole_integrals(*mesh.blocks[part.cell.block].element);
      for (std::size_t a = 0; a < whole.size(); ++a) part.of[a] /= whole[a];
    }
    out.parts.push_back(std::move(part));
  }
  return out;
}

}  // namespace abut
