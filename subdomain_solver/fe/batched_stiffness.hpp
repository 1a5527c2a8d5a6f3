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

/// Of one instruction set. What CellKernel computes cell by cell [M.43, M.45], to rounding; the
/// same bits for every width of registers.
struct StiffnessKernels {
  const char* instructions = "";
  struct OfLaw {
    StiffnessKernel flat, space;                        // in two and three dimensions
    StiffnessKernel flat_one_volume, space_one_volume;  // mean dilatation, one volume per cell
  };
  OfLaw saint_venant_kirchhoff, neo_hookean;

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
