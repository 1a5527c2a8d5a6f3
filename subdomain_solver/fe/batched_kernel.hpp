#pragma once

#include <array>
#include <cstdint>

#include "base/index.hpp"
#include "subdomain_solver/materials/hardening_numbers.hpp"
#include "subdomain_solver/materials/moduli.hpp"
#include "subdomain_solver/materials/mooney_rivlin_numbers.hpp"

namespace abut {

inline constexpr int batch_lanes = 8;  // cells of a batch, whatever the width of registers

/// Cells of one element that are computed together, in batches of 8, on their own copy of what
/// their nodes carry.
struct PatchView {
  int batches = 0;
  const std::int32_t* nodes = nullptr;   // (batches, nodes of the element, 8) into the copies
  const double* reference = nullptr;     // [m] (nodes, 4) position; the fourth number is unused
  const double* displacement = nullptr;  // [m] (nodes, 4)
  double* force = nullptr;               // [N] (nodes, 4) to which the cells add
  /// (batches, 8) where the numbers of a cell's points begin in the histories, point after point;
  /// -1: the lane has no cell.
  const std::int64_t* first_history = nullptr;
  const double* before = nullptr;                // history at the step's begin
  double* after = nullptr;                       // at its end; null: not wanted
  std::array<double, batch_lanes> stored{};      // [J] per lane, to which the cells add
  std::array<double, batch_lanes> dissipated{};  // [J] likewise
};

struct BatchedParameters {
  Moduli moduli;
  double hourglass = 0.0;  // [Pa] coefficient x P-wave modulus
  double thickness = 1.0;  // [m] of plane cells
  HardeningNumbers hardening;
  MooneyRivlinNumbers mooney_rivlin;
  // The rule of cells that are computed by one: weights (points), dN/dxi (points, nodes, dim).
  int points = 0;
  const double* weight = nullptr;
  const double* slope = nullptr;
};

/// Internal force and stored energy of a patch. False: a point has no answer.
using PatchKernel = bool (*)(PatchView&, const BatchedParameters&);

/// Which cells of a patch have frequencies above a limit [M.58].
struct FrequencyQuestion {
  const double* scale = nullptr;  // (batches, 8) moduli per metric and square [Pa s^2/m^2]
  int cells = 0;                  // of the patch; later lanes hold none
  double square = 0.0;            // [1/s^2] of the limit
  /// Null: the limit rises, by a hundredth at a time, until all cells are shown to be below it; it
  /// becomes infinite at a cell without an answer. Else room (cells) for those that are not shown
  /// to be below the limit, places in the patch, ascending.
  std::int32_t* fast = nullptr;
  int found = 0;  // of these
};
using FrequencyKernel = void (*)(const PatchView&, const BatchedParameters&, FrequencyQuestion&);

enum class BatchedLaw {
  linear_elastic,
  saint_venant_kirchhoff,
  neo_hookean,
  mooney_rivlin,
  hencky,
  j2_plasticity,
  count
};
enum class BatchedCell {
  hex8,
  hex8_one_point,
  hex8_mean_dilatation,
  quad4,
  quad4_one_point,
  quad4_mean_dilatation,
  tet4,
  tri3,
  tet10,
  hex20,
  count
};

/// Kernels of every cell (rows) with every law (columns), for one instruction set; null: there is
/// none. Frequencies of cells with mean dilatation or of second order have no bound [M.58].
struct KernelTable {
  const char* instructions = "";
  std::array<std::array<PatchKernel, static_cast<int>(BatchedLaw::count)>,
             static_cast<int>(BatchedCell::count)>
      kernels{};
  std::array<std::array<FrequencyKernel, static_cast<int>(BatchedLaw::count)>,
             static_cast<int>(BatchedCell::count)>
      frequencies{};

  FrequencyKernel frequency_of(BatchedCell cell, BatchedLaw law) const {
    return frequencies[index(cell)][index(law)];
  }
  PatchKernel of(BatchedCell cell, BatchedLaw law) const {
    return kernels[index(cell)][index(law)];
  }
};

// The same source, compiled once for each instruction set; all give the same bits.
const KernelTable& batched_kernels_generic();
const KernelTable& batched_kernels_avx2();
const KernelTable& batched_kernels_avx512();

}  // namespace abut
