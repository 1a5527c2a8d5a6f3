#include "subdomain_solver/fe/cell_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/index.hpp"
#include "base/one_each.hpp"
#include "subdomain_solver/fe/batched_kernel.hpp"

namespace abut {

namespace {

// Cells of a patch: displacement, position and force of their nodes, 96 bytes each, take half a
// megabyte. Small meshes have smaller patches, so that there is work for several threads.
constexpr std::size_t most_cells = 4096, least_cells = 512, wanted_patches = 16;
constexpr std::size_t lanes = batch_lanes;

/// Puts two zeros before every one of the lower 21 bits.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

/// Cells along a curve that fills space (Morton 1966), by their first nodes: neighbours in the
/// order are neighbours in the body.
std::vector<std::int32_t> along_a_curve(const Mesh& mesh, const CellBlock& cells) {
  const std::size_t dim = index(mesh.dim);
  std::array<double, 3> low{}, high{};
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    low[i % dim] = std::min(low[i % dim], mesh.points[i]);
    high[i % dim] = std::max(high[i % dim], mesh.points[i]);
  }
  double extent = 0.0;
  for (std::size_t d = 0; d < dim; ++d) extent = std::max(extent, high[d] - low[d]);
  std::vector<std::uint64_t> key(index(cells.count()), 0);
  for (std::size_t c = 0; c < key.size(); ++c) {
    const std::int32_t node = nodes_of(cells, static_cast<std::int32_t>(c))[0];
    for (std::size_t d = 0; d < dim; ++d) {
      const double part = (mesh.points[index(node) * dim + d] - low[d]) / extent;
      key[c] |= spread_bits(static_cast<std::uint64_t>(part * 0x1.fffffp20)) << d;
    }
  }
  std::vector<std::int32_t> order(key.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&key](std::int32_t a, std::int32_t b) { return key[a] < key[b]; });
  return order;
}

}  // namespace

CellPatches::CellPatches(const Mesh& mesh) {
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) add_block(mesh, static_cast<int>(b));
  // How many patches have a node: counted by the last one that was seen at it.
  std::vector<std::int32_t> patches_at(index(mesh.node_count()), 0);
  std::vector<std::int32_t> last(index(mesh.node_count()), -1);
  for (std::size_t p = 0; p < patches_.size(); ++p)
    for (std::int32_t cell : patches_[p].cells)
      for (std::int32_t node : nodes_of(mesh.blocks[patches_[p].block], cell))
        if (last[node] != static_cast<std::int32_t>(p)) {
          last[node] = static_cast<std::int32_t>(p);
          ++patches_at[node];
        }
  std::size_t shared = 0;
  for (CellPatch& patch : patches_) {
    place_nodes(mesh, patch, patches_at);
    patch.first_shared = shared;
    shared += patch.nodes.size() - index(patch.own);
  }
  find_shared(mesh.node_count());
}

void CellPatches::add_block(const Mesh& mesh, int block) {
  const CellBlock& cells = mesh.blocks[block];
  const std::vector<std::int32_t> order = along_a_curve(mesh, cells);
  const std::size_t size =
      std::clamp(order.size() / wanted_patches / lanes * lanes, least_cells, most_cells);
  for (std::size_t first = 0; first < order.size(); first += size) {
    CellPatch patch;
    patch.block = block;
    const std::size_t end = std::min(first + size, order.size());
    patch.cells.assign(order.begin() + static_cast<std::ptrdiff_t>(first),
                       order.begin() + static_cast<std::ptrdiff_t>(end));
    patches_.push_back(std::move(patch));
  }
}

/// Copies in the order in which cells ask for them, own ones first. Lanes without a cell compute a
/// regular one at rest, on nodes of its own behind all others.
void CellPatches::place_nodes(const Mesh& mesh, CellPatch& patch,
                              std::span<const std::int32_t> patches_at) {
  const CellBlock& cells = mesh.blocks[patch.block];
  const Element& element = *cells.element;
  const std::size_t each = index(element.nodes), dim = index(mesh.dim);
  for (std::int32_t cell : patch.cells)
    for (std::int32_t node : nodes_of(cells, cell)) patch.nodes.push_back(node);
  std::vector<std::int32_t> sorted = patch.nodes;
  keep_one_each(sorted);
  std::vector<std::int32_t> copy(sorted.size(), -1);
  const std::vector<std::int32_t> asked = std::move(patch.nodes);
  patch.nodes.clear();
  const auto at = [&sorted](std::int32_t node) {
    return index(std::lower_bound(sorted.begin(), sorted.end(), node) - sorted.begin());
  };
  for (const bool own : {true, false}) {
    for (std::int32_t node : asked) {
      if ((patches_at[node] == 1) != own || copy[at(node)] >= 0) continue;
      copy[at(node)] = static_cast<std::int32_t>(patch.nodes.size());
      patch.nodes.push_back(node);
    }
    if (own) patch.own = static_cast<int>(patch.nodes.size());
  }
  patch.batches = static_cast<int>((patch.cells.size() + lanes - 1) / lanes);
  patch.places.resize(index(patch.batches) * each * lanes);
  for (std::size_t k = 0; k < index(patch.batches) * lanes; ++k)
    for (std::size_t a = 0; a < each; ++a)
      patch.places[(k / lanes * each + a) * lanes + k % lanes] =
          k < patch.cells.size() ? copy[at(asked[k * each + a])]
                                 : static_cast<std::int32_t>(patch.nodes.size() + a);
  patch.reference.assign((patch.nodes.size() + each) * 4, 0.0);
  for (std::size_t n = 0; n < patch.nodes.size(); ++n)
    for (std::size_t d = 0; d < dim; ++d)
      patch.reference[4 * n + d] = mesh.points[index(patch.nodes[n]) * dim + d];
  for (std::size_t a = 0; a < each; ++a)
    for (std::size_t d = 0; d < dim; ++d)
      patch.reference[4 * (patch.nodes.size() + a) + d] = element.corners[a * dim + d];
  most_copies_ = std::max(most_copies_, patch.nodes.size() + each);
}

/// Lists of the copies of each shared node, patch after patch.
void CellPatches::find_shared(int node_count) {
  std::vector<std::vector<std::int32_t>> copies(index(node_count));
  for (const CellPatch& patch : patches_)
    for (std::size_t n = index(patch.own); n < patch.nodes.size(); ++n)
      copies[patch.nodes[n]].push_back(
          static_cast<std::int32_t>(patch.first_shared + n - index(patch.own)));
  first_.push_back(0);
  for (std::size_t node = 0; node < copies.size(); ++node) {
    if (copies[node].empty()) continue;
    shared_.push_back(static_cast<std::int32_t>(node));
    copies_.insert(copies_.end(), copies[node].begin(), copies[node].end());
    first_.push_back(copies_.size());
  }
}

std::size_t CellPatches::bytes() const {
  std::size_t sum = (shared_.size() + copies_.size()) * sizeof(std::int32_t) +
                    first_.size() * sizeof(std::size_t);
  for (const CellPatch& p : patches_)
    sum += (p.cells.size() + p.nodes.size() + p.places.size()) * sizeof(std::int32_t) +
           p.reference.size() * sizeof(double);
  return sum;
}

}  // namespace abut
