#include "subdomain_solver/fe/field_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "contract/hand_over.hpp"
#include "subdomain_solver/fe/cell_finder.hpp"
#include "subdomain_solver/fe/vtk_cells.hpp"
#include "subdomain_solver/solid_fields.hpp"

namespace abut {
namespace {

constexpr const char* transferred = "a body that another model takes over";
/// Parts of a cell's edge in which both meshes are read, at most; of simplices points along it.
constexpr int most_parts = 16, most_points = 12;

bool is_simplex(Shape shape) { return shape == Shape::triangle || shape == Shape::tetrahedron; }

/// A rule of so many points along an edge in every part of a cell, so many of which lie along its
/// edge; of simplices one rule, with two points along an edge for each part.
Quadrature divided_rule(Shape shape, int parts, int points) {
  if (is_simplex(shape))
    return quadrature(shape, 2 * std::min(most_points, std::max(points, 2 * parts)) - 1);
  const Quadrature one = quadrature(shape, 2 * points - 1);
  const std::size_t dim = one.points.size() / one.weights.size();
  Quadrature all;
  std::size_t cells = 1;
  for (std::size_t i = 0; i < dim; ++i) cells *= index(parts);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    for (std::size_t p = 0; p < one.weights.size(); ++p) {
      std::size_t place = cell;
      for (std::size_t i = 0; i < dim; ++i, place /= index(parts)) {
        const double begin = 2.0 * static_cast<double>(place % index(parts));
        all.points.push_back((begin + one.points[p * dim + i] + 1.0) / parts - 1.0);
      }
      all.weights.push_back(one.weights[p] / static_cast<double>(cells));
    }
  }
  return all;
}

const Element* element_of(std::int32_t type) {
  for (const Element& element : all_elements())
    if (element.vtk == type) return &element;
  return nullptr;
}

/// Cells of one element after the other, as grids have them.
Mesh mesh_of_grid(const Grid& grid, int dim) {
  Mesh mesh;
  mesh.dim = dim;
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    for (std::size_t i = 0; i < index(dim); ++i)
      mesh.points.push_back(grid.points[3 * node + i]);
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    const Element* element = element_of(grid.types[c]);
    if (element == nullptr || element->dim != dim)
      throw RunError(fmt::format("has cells of VTK's type {}, and the new mesh has {} dimensions",
                                 grid.types[c], dim),
                     transferred, "Give the stage a mesh of the same dimension.");
    if (mesh.blocks.empty() || mesh.blocks.back().element != element)
      mesh.blocks.push_back({element, {}, {}, {}});
    const VtkCell cell = vtk_cell(*element);
    std::vector<std::int32_t> nodes(cell.nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
      nodes[index(cell.nodes[k])] = grid.connectivity[index(grid.offsets[c]) + k];
    std::vector<std::int32_t>& all = mesh.blocks.back().nodes;
    all.insert(all.end(), nodes.begin(), nodes.end());
  }
  return mesh;
}

/// [m] (dim) and the volume that a weight of the reference shape stands for.
double jacobian_at(const Mesh& mesh, std::span<const std::int32_t> nodes, const Tabulation& t,
                   int point, std::vector<double>& at) {
  const std::size_t dim = index(mesh.dim), count = nodes.size();
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(mesh.dim, mesh.dim);
  std::ranges::fill(at, 0.0);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t i = 0; i < dim; ++i) {
      const double x = mesh.points[index(nodes[a]) * dim + i];
      at[i] += t.n[index(point) * count + a] * x;
      for (std::size_t k = 0; k < dim; ++k)
        j(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) +=
            x * t.dn[(index(point) * count + a) * dim + k];
    }
  }
  return mesh.dim == 1   ? std::abs(j(0, 0))
         : mesh.dim == 2 ? std::abs(j(0, 0) * j(1, 1) - j(0, 1) * j(1, 0))
                         : std::abs(Eigen::Matrix3d(j).determinant());
}

/// [m] the largest extent of a block's cells along an axis.
double largest_extent(const Mesh& mesh, const CellBlock& block) {
  double most = 0.0;
  for (int c = 0; c < block.count(); ++c) {
    for (std::size_t i = 0; i < index(mesh.dim); ++i) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const std::int32_t node : nodes_of(block, c)) {
        const double x = mesh.points[index(node) * index(mesh.dim) + i];
        low = std::min(low, x), high = std::max(high, x);
      }
      most = std::max(most, high - low);
    }
  }
  return most;
}

}  // namespace

FieldTransfer::FieldTransfer(const Grid& from, const Mesh& to, bool round)
    : to_(to), from_(mesh_of_grid(from, to.dim)), same_(same_grid(from, grid_of(to))) {
  if (same_) return;
  take_samples(round);
  factor();
}

/// Where the new cells are larger than the old ones, they are read in as many parts as these: the
/// old field bends at its cells' sides.
void FieldTransfer::take_samples(bool round) {
  const CellFinder finder(from_);
  int order = 1;
  for (const CellBlock& block : from_.blocks) order = std::max(order, block.element->order);
  std::vector<double> at(index(to_.dim)), dn;
  for (const CellBlock& block : to_.blocks) {
    const double ratio = largest_extent(to_, block) / finder.smallest();
    const int parts = std::clamp(static_cast<int>(std::ceil(ratio - 1.0e-6)), 1, most_parts);
    const int points = std::max(order, block.element->order) + 1;
    const Tabulation t =
        tabulate(*block.element, divided_rule(block.element->shape, parts, points));
    for (int c = 0; c < block.count(); ++c) {
      const std::span<const std::int32_t> own = nodes_of(block, c);
      for (int p = 0; p < t.points; ++p) {
        Sample sample;
        sample.weight = t.weight[index(p)] * jacobian_at(to_, own, t, p, at);
        if (round) sample.weight *= std::abs(at[0]);
        sample.own.assign(own.begin(), own.end());
        const auto values = t.n.begin() + static_cast<std::ptrdiff_t>(index(p) * own.size());
        sample.own_n.assign(values, values + static_cast<std::ptrdiff_t>(own.size()));
        const CellFinder::Found found = finder.find(at);
        const CellBlock& old = from_.blocks[index(found.block)];
        const std::span<const std::int32_t> nodes = nodes_of(old, found.cell);
        sample.nodes.assign(nodes.begin(), nodes.end());
        sample.n.resize(nodes.size());
        dn.resize(nodes.size() * at.size());
        old.element->evaluate(found.xi, sample.n, dn);
        samples_.push_back(std::move(sample));
      }
    }
  }
}

/// The new mesh's mass matrix of one component, by the same samples.
void FieldTransfer::factor() {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Sample& sample : samples_)
    for (std::size_t a = 0; a < sample.own.size(); ++a)
      for (std::size_t b = 0; b < sample.own.size(); ++b)
        entries.emplace_back(sample.own[a], sample.own[b],
                             sample.weight * sample.own_n[a] * sample.own_n[b]);
  SparseMatrix mass(to_.node_count(), to_.node_count());
  mass.setFromTriplets(entries.begin(), entries.end());
  solver_ = make_own_solver(Pivots::definite);
  if (!solver_->factor(mass))
    throw RunError("has no mass at some nodes of the new mesh", transferred,
                   "Give the stage another mesh.");
}

std::vector<double> FieldTransfer::to_nodes(std::span<const double> values) {
  const std::size_t dim = index(to_.dim), nodes = index(to_.node_count());
  std::vector<double> out(nodes * dim);
  if (same_) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = values[k / dim * 3 + k % dim];
    return out;
  }
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(to_.node_count(), to_.dim), answer;
  for (const Sample& sample : samples_) {
    for (std::size_t i = 0; i < dim; ++i) {
      double here = 0.0;
      for (std::size_t a = 0; a < sample.nodes.size(); ++a)
        here += sample.n[a] * values[index(sample.nodes[a]) * 3 + i];
      for (std::size_t b = 0; b < sample.own.size(); ++b)
        right(sample.own[b], static_cast<Eigen::Index>(i)) +=
            sample.weight * sample.own_n[b] * here;
    }
  }
  if (!solver_->solve_columns(right, answer))
    throw RunError("does not fit the new mesh", transferred, "Give the stage another mesh.");
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = answer(static_cast<Eigen::Index>(k / dim), static_cast<Eigen::Index>(k % dim));
  return out;
}

}  // namespace abut
