#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Cells of one element near each other, small enough that what their nodes carry stays in a
/// core's cache. They read and add to copies of their nodes; `nodes` says whose. The first `own`
/// nodes belong to no other patch.
struct CellPatch {
  int block = 0;                     // of the mesh
  std::vector<std::int32_t> cells;   // of the block, in the order of the lanes
  std::vector<std::int32_t> nodes;   // (copies) global number
  std::vector<double> reference;     // [m] (copies and rest, 4) position
  std::vector<std::int32_t> places;  // (batches, nodes of the element, 8) into the copies
  int batches = 0;
  int own = 0;
  std::size_t first_shared = 0;  // where its other nodes begin in the list of shared copies
};

/// A partition of a mesh's cells. The same for every number of threads: so is the order of all sums
/// that rest on it.
class CellPatches {
 public:
  explicit CellPatches(const Mesh& mesh);

  const std::vector<CellPatch>& list() const { return patches_; }
  std::size_t most_copies() const { return most_copies_; }      // of any patch, rest included
  std::size_t shared_copies() const { return copies_.size(); }  // of nodes of several patches
  /// For each shared node, the places of its copies in the list of shared copies.
  struct SharedNode {
    std::int32_t node = 0;
    std::span<const std::int32_t> copies;
  };
  std::size_t shared_count() const { return shared_.size(); }
  SharedNode shared(std::size_t i) const {
    const std::size_t begin = first_[i], end = first_[i + 1];
    return {shared_[i], std::span(copies_).subspan(begin, end - begin)};
  }
  std::size_t bytes() const;  // of memory, for the record

 private:
  void add_block(const Mesh& mesh, int block);
  void find_shared(int node_count);
  void place_nodes(const Mesh& mesh, CellPatch& patch, std::span<const std::int32_t> patches_at);

  std::vector<CellPatch> patches_;
  std::vector<std::int32_t> shared_, copies_;
  std::vector<std::size_t> first_;
  std::size_t most_copies_ = 0;
};

}  // namespace abut
