#include "subdomain_solver/fe/cell_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "base/dense.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

/// Of reference coordinates: a place this near to a cell's side is in the cell.
constexpr double on_side = 1.0e-9;
constexpr std::int64_t most_bins = 1 << 22;

/// How far a place is beyond the sides of a reference shape; at most 0: within.
double beyond(Shape shape, std::span<const double> xi) {
  double most = -std::numeric_limits<double>::infinity(), sum = -1.0;
  const bool simplex = shape == Shape::triangle || shape == Shape::tetrahedron;
  for (const double x : xi) {
    most = std::max(most, simplex ? -x : std::abs(x) - 1.0);
    sum += x;
  }
  return simplex ? std::max(most, sum) : most;
}

/// [m] (dim) of a cell's nodes.
void bounds(const Mesh& mesh, std::span<const std::int32_t> nodes, std::span<double> low,
            std::span<double> high) {
  std::ranges::fill(low, std::numeric_limits<double>::infinity());
  std::ranges::fill(high, -std::numeric_limits<double>::infinity());
  for (const std::int32_t node : nodes) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      const double x = mesh.points[index(node) * low.size() + i];
      low[i] = std::min(low[i], x), high[i] = std::max(high[i], x);
    }
  }
}

}  // namespace

/// From the middle: one step where the cell is a parallelepiped or a simplex.
std::vector<double> reference_coordinates(const Mesh& mesh, std::int32_t block, std::int32_t cell,
                                          std::span<const double> at) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Element& element = *mesh.blocks[index(block)].element;
  const std::span<const std::int32_t> nodes = nodes_of(mesh.blocks[index(block)], cell);
  const Eigen::Index dim = mesh.dim, count = element.nodes;
  Rows x(count, dim);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index i = 0; i < dim; ++i)
      x(a, i) = mesh.points[index(nodes[index(a)]) * index(dim) + index(i)];
  const Eigen::Map<const Rows> corners(element.corners.data(), count, dim);
  const Eigen::Map<const Eigen::VectorXd> place(at.data(), dim);
  std::vector<double> xi(index(dim)), n(index(count)), dn(n.size() * xi.size());
  Eigen::Map<Eigen::VectorXd> here(xi.data(), dim);
  here = corners.colwise().mean().transpose();
  constexpr int most = 30;
  for (int i = 0; i < most; ++i) {
    element.evaluate(xi, n, dn);
    const Eigen::Map<const Eigen::VectorXd> values(n.data(), count);
    const Eigen::Map<const Rows> slopes(dn.data(), count, dim);
    const Eigen::VectorXd left = place - x.transpose() * values;
    const Eigen::MatrixXd jacobian = x.transpose() * slopes;
    const Eigen::VectorXd step = solve_square(jacobian, left);
    here += step;
    if (!(step.lpNorm<Eigen::Infinity>() > 1.0e-14)) break;
  }
  return xi;
}

CellFinder::CellFinder(const Mesh& mesh) : mesh_(mesh) {
  const std::size_t dim = index(mesh.dim);
  std::vector<double> low(dim), high(dim), upper(dim, -std::numeric_limits<double>::infinity());
  lower_.assign(dim, std::numeric_limits<double>::infinity());
  smallest_ = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const CellBlock& block : mesh.blocks) {
    for (int c = 0; c < block.count(); ++c) {
      bounds(mesh, nodes_of(block, c), low, high);
      double least = std::numeric_limits<double>::infinity(), most = 0.0;
      for (std::size_t i = 0; i < dim; ++i) {
        lower_[i] = std::min(lower_[i], low[i]), upper[i] = std::max(upper[i], high[i]);
        least = std::min(least, high[i] - low[i]), most = std::max(most, high[i] - low[i]);
      }
      smallest_ = std::min(smallest_, least);
      sum += most;
    }
  }
  width_ = sum / mesh.cell_count();
  for (bool fits = false; !fits; width_ *= fits ? 1.0 : 2.0) {
    std::int64_t all = 1;
    counts_.clear();
    for (std::size_t i = 0; i < dim; ++i) {
      counts_.push_back(static_cast<std::int64_t>((upper[i] - lower_[i]) / width_) + 1);
      all = all > most_bins ? all : all * counts_.back();
    }
    fits = all <= most_bins;
  }
  std::int64_t all = 1;
  for (const std::int64_t count : counts_) all *= count;
  bins_.resize(index(all));
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    for (int c = 0; c < mesh.blocks[b].count(); ++c) {
      bounds(mesh, nodes_of(mesh.blocks[b], c), low, high);
      const std::vector<std::int64_t> first = bin_of(low), last = bin_of(high);
      std::vector<std::int64_t> bin = first;
      for (std::size_t i = 0; i < dim;) {  // counts through the box of bins
        bins_[place_of(bin)].push_back({static_cast<std::int32_t>(b), c});
        for (i = 0; i < dim && ++bin[i] > last[i]; ++i) bin[i] = first[i];
      }
    }
  }
}

std::vector<std::int64_t> CellFinder::bin_of(std::span<const double> at) const {
  std::vector<std::int64_t> bin;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double whole = std::floor((at[i] - lower_[i]) / width_);
    const double last = static_cast<double>(counts_[i] - 1);
    bin.push_back(static_cast<std::int64_t>(std::clamp(whole, 0.0, last)));
  }
  return bin;
}

std::size_t CellFinder::place_of(const std::vector<std::int64_t>& bin) const {
  std::int64_t place = 0;
  for (std::size_t i = bin.size(); i-- > 0;) place = place * counts_[i] + bin[i];
  return index(place);
}

void CellFinder::look(std::span<const double> at, const std::vector<std::int64_t>& bin,
                      Found& best) const {
  for (const Cell& cell : bins_[place_of(bin)]) {
    if (best.outside <= on_side) return;
    std::vector<double> xi = reference_coordinates(mesh_, cell.block, cell.cell, at);
    const double outside = beyond(mesh_.blocks[index(cell.block)].element->shape, xi);
    if (outside < best.outside) best = {cell.block, cell.cell, std::move(xi), outside};
  }
}

/// A cell that holds a place, in whose bin its box is; none: `best` is as it was.
void CellFinder::look_within(std::span<const double> at, Found& best) const {
  std::vector<double> low(at.size()), high(at.size());
  for (const Cell& cell : bins_[place_of(bin_of(at))]) {
    bounds(mesh_, nodes_of(mesh_.blocks[index(cell.block)], cell.cell), low, high);
    bool near = true;
    for (std::size_t i = 0; i < at.size() && near; ++i)
      near = at[i] >= low[i] - on_side * width_ && at[i] <= high[i] + on_side * width_;
    if (!near) continue;
    std::vector<double> xi = reference_coordinates(mesh_, cell.block, cell.cell, at);
    const double outside = beyond(mesh_.blocks[index(cell.block)].element->shape, xi);
    if (outside > on_side) continue;
    best = {cell.block, cell.cell, std::move(xi), outside};
    return;
  }
}

/// Rings of bins around that of the place, until a cell has been found, and one more: a cell of the
/// next ring may be nearer.
CellFinder::Found CellFinder::find(std::span<const double> at) const {
  Found best;
  best.outside = std::numeric_limits<double>::infinity();
  look_within(at, best);
  if (std::isfinite(best.outside)) return best;
  const std::vector<std::int64_t> middle = bin_of(at);
  const std::size_t dim = middle.size();
  const std::int64_t most = *std::ranges::max_element(counts_);
  std::int64_t last = most;
  for (std::int64_t ring = 0; ring <= last; ++ring) {
    std::vector<std::int64_t> away(dim, -ring);
    for (std::size_t i = 0; i < dim;) {
      std::int64_t farthest = 0;
      bool there = true;
      std::vector<std::int64_t> bin = middle;
      for (std::size_t k = 0; k < dim; ++k) {
        farthest = std::max(farthest, std::abs(away[k]));
        bin[k] += away[k];
        there = there && bin[k] >= 0 && bin[k] < counts_[k];
      }
      if (there && farthest == ring) look(at, bin, best);
      for (i = 0; i < dim && ++away[i] > ring; ++i) away[i] = -ring;
    }
    if (best.outside <= on_side) break;
    if (std::isfinite(best.outside)) last = std::min(last, ring + 1);
  }
  return best;
}

}  // namespace abut
