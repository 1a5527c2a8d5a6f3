#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Tells equal cells of a mesh: their shape, and displacement where wanted, as seen from the first
/// node, in parts of 2^-36 of the cell's size. That is far above the rounding of equal cells at
/// different places, and far below what matters: enough for 1e-6 in the highest frequency at aspect
/// ratios of 1e4.
class CellKeys {
 public:
  using Key = std::vector<std::int64_t>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };

  CellKeys(const Mesh& mesh, const CellBlock& cells) : mesh_(mesh), cells_(cells) {}

  /// u: [m] (nodes of the mesh, dim) or nothing. The key lives until the next call.
  const Key& of(int cell, std::span<const double> u = {});

 private:
  void append(std::span<const double> values, int cell, int exponent);
  int size_of(int cell) const;

  const Mesh& mesh_;
  const CellBlock& cells_;
  Key key_;
};

}  // namespace abut
