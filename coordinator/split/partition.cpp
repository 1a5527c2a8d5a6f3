#include "coordinator/split/partition.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <metis.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

std::vector<int> metis_parts(const CellGraph& graph, int parts) {
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_CONTIG] = 1;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  std::vector<idx_t> begin(graph.begin.begin(), graph.begin.end());
  std::vector<idx_t> next(graph.next.begin(), graph.next.end());
  std::vector<idx_t> part(index(graph.cells()), 0);
  idx_t cells = graph.cells(), constraints = 1, count = parts, cut = 0;
  const int answer =
      METIS_PartGraphKway(&cells, &constraints, begin.data(), next.data(), nullptr, nullptr,
                          nullptr, &count, nullptr, nullptr, options, &cut, part.data());
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
      ++size[index(piece[c])];
      owner[index(piece[c])] = part[c];
    }
    for (int p = 0; p < pieces; ++p) {
      int& most = largest[index(owner[index(p)])];
      if (most < 0 || size[index(p)] > size[index(most)]) most = p;
    }
    const auto splinter =
        std::ranges::find_if(piece, [&](int p) { return largest[index(owner[index(p)])] != p; });
    if (splinter == piece.end()) return;
    std::vector<int> shared(index(parts), 0);
    for (std::size_t c = 0; c < piece.size(); ++c) {
      for (std::int32_t k = graph.begin[c]; piece[c] == *splinter && k < graph.begin[c + 1]; ++k) {
        const int other = part[index(graph.next[index(k)])];
        if (other != part[c]) ++shared[index(other)];
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
    int& of = number[index(p)];
    if (of < 0) of = count++;
    p = of;
  }
  return count;
}

}  // namespace

std::vector<int> partition(const CellGraph& graph, int parts, const std::string& where) {
  if (parts > graph.cells()) {
    throw InputError(fmt::format("has {} cells, fewer than {} bodies", graph.cells(), parts), where,
                     "Ask for fewer bodies.");
  }
  std::vector<int> part(index(graph.cells()), 0);
  const std::vector<int> piece = pieces_of(graph, part);
  const int pieces = 1 + *std::ranges::max_element(piece);
  if (pieces > 1) {
    throw InputError(fmt::format("is of {} pieces that share no facets", pieces), where,
                     "Make a body of each piece first, or join them in the mesh.");
  }
  part = metis_parts(graph, parts);
  join_splinters(graph, parts, part);
  if (renumber(parts, part) < parts) {
    throw InputError(
        fmt::format("of {} cells does not fall into {} connected bodies", graph.cells(), parts),
        where, "Ask for fewer bodies.");
  }
  return part;
}

}  // namespace abut
