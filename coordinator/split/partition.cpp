#include "coordinator/split/partition.hpp"

#include <algorithm>
#include <new>
#include <numeric>

#include <fmt/format.h>
#include <metis.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// The graph of cells, those that stay together as one.
struct Clusters {
  CellGraph graph;
  std::vector<idx_t> cells;   // of a cluster
  std::vector<idx_t> facets;  // (graph.next) between two clusters
};

Clusters clusters_of(const CellGraph& cells, const std::vector<int>& together) {
  const int count = 1 + *std::ranges::max_element(together);
  Clusters out;
  out.cells.assign(index(count), 0);
  std::vector<std::vector<std::int32_t>> next(index(count));
  for (std::size_t c = 0; c < together.size(); ++c) {
    ++out.cells[together[c]];
    for (std::int32_t k = cells.begin[c]; k < cells.begin[c + 1]; ++k) {
      const int other = together[cells.next[index(k)]];
      if (other != together[c]) next[together[c]].push_back(other);
    }
  }
  out.graph.begin.push_back(0);
  for (std::vector<std::int32_t>& neighbours : next) {
    std::ranges::sort(neighbours);
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      const bool again = k > 0 && neighbours[k] == neighbours[k - 1];
      if (again) ++out.facets.back();
      if (again) continue;
      out.graph.next.push_back(neighbours[k]);
      out.facets.push_back(1);
    }
    out.graph.begin.push_back(static_cast<std::int32_t>(out.graph.next.size()));
  }
  return out;
}

/// METIS's own way of many parts keeps them connected, and may leave one empty where a cluster is
/// as large as a part; its repeated halving does neither.
enum class Way { many_at_once, halving };

std::vector<int> metis_parts(Clusters& clusters, int parts, Way way) {
  const CellGraph& graph = clusters.graph;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_CONTIG] = way == Way::many_at_once;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  std::vector<idx_t> begin(graph.begin.begin(), graph.begin.end());
  std::vector<idx_t> next(graph.next.begin(), graph.next.end());
  std::vector<idx_t> part(index(graph.cells()), 0);
  idx_t count = graph.cells(), constraints = 1, wanted = parts, cut = 0;
  const auto deal = way == Way::many_at_once ? METIS_PartGraphKway : METIS_PartGraphRecursive;
  const int answer =
      deal(&count, &constraints, begin.data(), next.data(), clusters.cells.data(), nullptr,
           clusters.facets.data(), &wanted, nullptr, nullptr, options, &cut, part.data());
  if (answer == METIS_ERROR_MEMORY) throw std::bad_alloc();
  if (answer != METIS_OK)
    throw RunError(fmt::format("METIS gives up with the code {}", answer), "", "Report it.");
  return {part.begin(), part.end()};
}

/// Joins what does not hang together with its part to the neighbour that it shares most facets
/// with: all but the largest piece of every part.
void join_splinters(const CellGraph& graph, int parts, std::vector<int>& part) {
  for (bool changed = true; changed;) {
    changed = false;
    const std::vector<int> piece = pieces_of(graph, part);
    const int pieces = 1 + *std::ranges::max_element(piece);
    std::vector<int> size(index(pieces), 0), owner(index(pieces), 0);
    std::vector<int> largest(index(parts), -1);
    for (std::size_t c = 0; c < piece.size(); ++c) {
      ++size[piece[c]];
      owner[piece[c]] = part[c];
    }
    for (int p = 0; p < pieces; ++p) {
      int& most = largest[owner[index(p)]];
      if (most < 0 || size[p] > size[most]) most = p;
    }
    const auto splinter =
        std::ranges::find_if(piece, [&](int p) { return largest[owner[index(p)]] != p; });
    if (splinter == piece.end()) return;
    std::vector<int> shared(index(parts), 0);
    for (std::size_t c = 0; c < piece.size(); ++c) {
      for (std::int32_t k = graph.begin[c]; piece[c] == *splinter && k < graph.begin[c + 1]; ++k) {
        const int other = part[graph.next[index(k)]];
        if (other != part[c]) ++shared[other];
      }
    }
    const int to = static_cast<int>(std::ranges::max_element(shared) - shared.begin());
    for (std::size_t c = 0; c < piece.size(); ++c)
      if (piece[c] == *splinter) part[c] = to;
    changed = true;
  }
}

/// Numbers parts in the order of their first cells; how many there are.
int renumber(int parts, std::vector<int>& part) {
  std::vector<int> number(index(parts), -1);
  int count = 0;
  for (int& p : part) {
    int& of = number[p];
    if (of < 0) of = count++;
    p = of;
  }
  return count;
}

}  // namespace

std::vector<int> kept_together(const Mesh& mesh, const std::vector<std::int32_t>& nodes) {
  std::vector<int> root(index(mesh.cell_count()));
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&root](int cell) {
    while (root[cell] != cell) cell = root[cell] = root[root[index(cell)]];
    return cell;
  };
  std::vector<int> first(index(mesh.node_count()), -1);  // cell of a node that keeps its cells
  std::vector<bool> keeps(first.size(), false);
  for (std::int32_t node : nodes) keeps[node] = true;
  int cell = 0;
  for (const CellBlock& block : mesh.blocks) {
    for (int own = 0; own < block.count(); ++own, ++cell) {
      for (std::int32_t node : nodes_of(block, own)) {
        if (!keeps[node]) continue;
        int& at = first[node];
        if (at < 0) at = cell;
        const auto [low, high] = std::minmax({root_of(at), root_of(cell)});
        root[high] = low;
      }
    }
  }
  std::vector<int> number(root.size(), -1), together;
  int count = 0;
  for (int c = 0; c < cell; ++c) {
    int& of = number[root_of(c)];
    if (of < 0) of = count++;
    together.push_back(of);
  }
  return together;
}

std::vector<int> partition(const CellGraph& graph, const std::vector<int>& together, int parts,
                           const std::string& where) {
  const std::vector<int> piece = pieces_of(graph, std::vector<int>(index(graph.cells()), 0));
  const int pieces = 1 + *std::ranges::max_element(piece);
  if (pieces > 1) {
    throw InputError(fmt::format("is of {} pieces that share no facets", pieces), where,
                     "Make a body of each piece first, or join them in the mesh.");
  }
  Clusters clusters = clusters_of(graph, together);
  const int least = clusters.graph.cells();
  if (parts > least) {
    throw InputError(fmt::format("has {} cells to deal out, those at surfaces that touch counted "
                                 "as one, fewer than {} bodies",
                                 least, parts),
                     where,
                     "Ask for fewer bodies, or let a smaller side be the port that touches.");
  }
  for (const Way way : {Way::many_at_once, Way::halving}) {
    std::vector<int> of_cluster = metis_parts(clusters, parts, way);
    join_splinters(clusters.graph, parts, of_cluster);
    std::vector<int> part;
    for (int cluster : together) part.push_back(of_cluster[cluster]);
    if (renumber(parts, part) == parts) return part;
  }
  throw InputError(fmt::format("of {} cells does not fall into {} connected bodies that leave "
                               "surfaces that touch whole",
                               graph.cells(), parts),
                   where, "Ask for fewer bodies, or let a smaller side be the port that touches.");
}

}  // namespace abut
