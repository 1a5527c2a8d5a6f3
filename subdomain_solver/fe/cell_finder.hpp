#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Finds the cell of a mesh in which a place is, of any element in one to three dimensions.
class CellFinder {
 public:
  /// The mesh must outlive it.
  explicit CellFinder(const Mesh& mesh);

  struct Found {
    std::int32_t block = 0, cell = 0;
    std::vector<double> xi;  // (dim) reference coordinates
    double outside = 0.0;    // in reference coordinates, how far beyond its sides; at most 0: in it
  };
  /// The cell that holds a place [m] (dim), or the one that it is outside of by the least.
  Found find(std::span<const double> at) const;
  double smallest() const { return smallest_; }  // [m] the least extent of a cell

 private:
  std::vector<std::int64_t> bin_of(std::span<const double> at) const;
  std::size_t place_of(const std::vector<std::int64_t>& bin) const;
  void look_within(std::span<const double> at, Found& best) const;
  void look(std::span<const double> at, const std::vector<std::int64_t>& bin, Found& best) const;

  const Mesh& mesh_;
  struct Cell {
    std::int32_t block = 0, cell = 0;
  };
  std::vector<double> lower_;         // [m] (dim)
  std::vector<std::int64_t> counts_;  // (dim) of bins
  double width_ = 0.0;                // [m] of a bin
  double smallest_ = 0.0;
  std::vector<std::vector<Cell>> bins_;
};

/// Reference coordinates (dim) of a place [m] (dim) in a cell or beside it, by Newton's method.
std::vector<double> reference_coordinates(const Mesh& mesh, std::int32_t block, std::int32_t cell,
                                          std::span<const double> at);

}  // namespace abut
