#pragma once

#include "subdomain_solver/fe/batched_kernel.hpp"

namespace abut {

/// 8 cells of one element whose tangents are found together: numbers of the cells side by side.
struct StiffnessBatch {
  int nodes = 0, points = 0;
  const double* volume = nullptr;        // [m^3] (points, 8) reference
  const double* gradient = nullptr;      // [1/m] (points, nodes, dim, 8) dN/dX
  const double* displacement = nullptr;  // [m] (nodes, dim, 8)
  /// [N/m] (pairs, dim, dim, 8): of the pairs of nodes a <= b, a by a, entries (i of a, k of b).
  double* stiffness = nullptr;
};

/// False: a point has no answer.
using StiffnessKernel = bool (*)(const StiffnessBatch&, const BatchedParameters&);

/// Reference shapes of 8 cells of one element.
struct ShapeBatch {
  int nodes = 0, points = 0;
  const double* weight = nullptr;  // (points) of a rule
  const double* slope = nullptr;   // (points, nodes, dim) dN/dxi
  const double* place = nullptr;   // [m] (nodes, dim, 8)
  double* volume = nullptr;        // [m^dim] (points, 8)
  double* gradient = nullptr;      // [1/m] (points, nodes, dim, 8); null: not wanted
};
using ShapeKernel = void (*)(const ShapeBatch&);

/// 8 cells that are held against a frequency.
struct SlownessBatch {
  int nodes = 0;
  double square = 0.0;                // [1/s^2]
  const double* stiffness = nullptr;  // [N/m] as StiffnessBatch has it
  const double* mass = nullptr;       // [kg] (nodes, 8)
  double* rows = nullptr;             // work space (n (n + 1)/2, 8), n = nodes x dim
};
/// A bit of each cell: whether square M - K is definite, so that its frequencies are lower.
using SlownessKernel = unsigned (*)(const SlownessBatch&);

/// Of one instruction set. What CellKernel computes cell by cell [M.43, M.45], to rounding; the
/// same bits for every width of registers.
struct StiffnessKernels {
  const char* instructions = "";
  struct OfLaw {
    StiffnessKernel flat, space;                        // in two and three dimensions
    StiffnessKernel flat_one_volume, space_one_volume;  // mean dilatation, one volume per cell
  };
  OfLaw saint_venant_kirchhoff, neo_hookean;
  ShapeKernel flat_shape, space_shape;
  SlownessKernel flat_slowness, space_slowness;
  bool fuses;  // fused multiply-add is an instruction, not a call

  /// Null: there is none.
  StiffnessKernel of(BatchedLaw law, int dim, bool one_volume) const {
    if (law != BatchedLaw::saint_venant_kirchhoff && law != BatchedLaw::neo_hookean) return nullptr;
    const OfLaw& k = law == BatchedLaw::neo_hookean ? neo_hookean : saint_venant_kirchhoff;
    if (one_volume) return dim == 3 ? k.space_one_volume : k.flat_one_volume;
    return dim == 3 ? k.space : k.flat;
  }
};
extern const StiffnessKernels stiffness_generic, stiffness_avx2, stiffness_avx512;

/// That of this machine.
const StiffnessKernels& stiffness_here();

}  // namespace abut
