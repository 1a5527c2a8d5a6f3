#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "subdomain_solver/fe/batched_stiffness.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// Tells cells that are slower than a frequency, eight at a time: their tangents and shares of the
/// lumped mass [M.53] are those of FeModel to rounding, and square M_e - K_e has positive pivots.
class SlowerCells {
 public:
  explicit SlowerCells(const FeModel& model);

  /// Whether cells of a block can be asked at all: of continua with the points of their rule, whole
  /// cells alone, where the machine has fused multiply-add (else cell by cell is faster).
  bool can(int block) const { return blocks_[index(block)].can; }
  /// Up to 8 cells of a block; u: [m] (nodes, dim) displacements along the axes of space, history:
  /// of all points; square [1/s^2]. A bit of each: set where its tangent is shown to have lower
  /// frequencies by more than rounding; not set tells nothing.
  unsigned find(int block, std::span<const int> cells, std::span<const double> u,
                std::span<const double> history, double square);

 private:
  struct Block {
    bool can = false, one_volume = false;
    StiffnessKernel stiffness = nullptr;  // null: at rest alone
  };
  bool find_stiffness(int block, std::span<const int> cells, std::span<const double> u,
                      std::span<const double> history);
  void find_mass(int block);

  const FeModel& model_;
  const StiffnessKernels& kernels_;
  BatchedParameters parameters_;
  std::vector<Block> blocks_;
  std::vector<double> place_, displacement_, volume_, gradient_, stiffness_, mass_, rows_;
};

}  // namespace abut
