#include "subdomain_solver/solve/aggregates.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace abut {

namespace {

constexpr std::int32_t none = -1;

struct Coupling {
  std::int32_t node = none;
  double size = 0.0;  // squared, of the block
};

/// Of each node those to others, flat.
struct Graph {
  std::vector<std::size_t> begin = {0};
  std::vector<Coupling> couplings;

  std::span<const Coupling> of(std::int32_t node) const {
    const std::size_t from = begin[index(node)];
    return std::span(couplings).subspan(from, begin[index(node) + 1] - from);
  }
  std::int32_t count() const { return static_cast<std::int32_t>(begin.size()) - 1; }
};

/// Squares of the sizes of all blocks, those of the diagonal apart.
Graph block_sizes(const SparseMatrix& matrix, const std::vector<std::int32_t>& nodes,
                  std::vector<double>& diagonal) {
  const std::size_t count = nodes.empty() ? 0 : index(nodes.back()) + 1;
  diagonal.assign(count, 0.0);
  std::vector<double> sizes(count, 0.0);  // of the column of blocks at hand
  std::vector<std::int32_t> met;
  Graph graph;
  for (std::size_t row = 0; row < nodes.size();) {
    const std::int32_t node = nodes[row];
    met.clear();
    for (; row < nodes.size() && nodes[row] == node; ++row)
      for (SparseMatrix::InnerIterator entry(matrix, static_cast<Eigen::Index>(row)); entry;
           ++entry) {
        const std::int32_t other = nodes[index(entry.row())];
        double& size = sizes[index(other)];
        if (size == 0.0 && entry.value() != 0.0) met.push_back(other);
        size += entry.value() * entry.value();
      }
    std::ranges::sort(met);
    for (const std::int32_t other : met) {
      if (other == node) {
        diagonal[index(node)] = sizes[index(node)];
      } else {
        graph.couplings.push_back({other, sizes[index(other)]});
      }
      sizes[index(other)] = 0.0;
    }
    graph.begin.push_back(graph.couplings.size());
  }
  return graph;
}

Graph strong_couplings(const SparseMatrix& matrix, const std::vector<std::int32_t>& nodes,
                       double weak) {
  std::vector<double> diagonal;
  const Graph all = block_sizes(matrix, nodes, diagonal);
  Graph strong;
  for (std::int32_t node = 0; node < all.count(); ++node) {
    for (const Coupling& c : all.of(node)) {
      const double own = std::sqrt(diagonal[index(node)] * diagonal[index(c.node)]);
      if (c.size > weak * weak * own) strong.couplings.push_back(c);
    }
    strong.begin.push_back(strong.couplings.size());
  }
  return strong;
}

}  // namespace

std::vector<std::int32_t> aggregates(const SparseMatrix& matrix,
                                     const std::vector<std::int32_t>& nodes, double weak) {
  const Graph strong = strong_couplings(matrix, nodes, weak);
  std::vector<std::int32_t> group(index(strong.count()), none);
  std::int32_t groups = 0;
  const auto is_free = [&group](const Coupling& c) { return group[index(c.node)] == none; };
  for (std::int32_t node = 0; node < strong.count(); ++node) {
    const auto around = strong.of(node);
    if (group[index(node)] != none || around.empty() || !std::ranges::all_of(around, is_free))
      continue;
    group[index(node)] = groups;
    for (const Coupling& c : around) group[index(c.node)] = groups;
    ++groups;
  }
  // Those between go to the group of the one that they are coupled to most; of the groups made so
  // far alone, or chains would grow.
  const std::vector<std::int32_t> centred = group;
  for (std::int32_t node = 0; node < strong.count(); ++node) {
    if (group[index(node)] != none) continue;
    double most = 0.0;
    for (const Coupling& c : strong.of(node)) {
      if (centred[index(c.node)] == none || c.size <= most) continue;
      most = c.size;
      group[index(node)] = centred[index(c.node)];
    }
  }
  for (std::int32_t node = 0; node < strong.count(); ++node) {
    if (group[index(node)] != none) continue;
    group[index(node)] = groups;
    for (const Coupling& c : strong.of(node))
      if (is_free(c)) group[index(c.node)] = groups;
    ++groups;
  }
  return group;
}

}  // namespace abut
