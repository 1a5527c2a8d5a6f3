#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/worker_threads.hpp"
#include "subdomain_solver/fe/batched_kernel.hpp"
#include "subdomain_solver/fe/cell_kernel.hpp"
#include "subdomain_solver/fe/cell_patches.hpp"
#include "subdomain_solver/materials/material.hpp"

namespace abut {

struct BatchedOptions {
  Formulation formulation = Formulation::full;
  double hourglass = 0.05;  // coefficient of the stiffness of one_point [M.52]
  double thickness = 1.0;   // [m] of plane cells, in plane strain
  int threads = 1;
  const KernelTable* kernels = nullptr;  // null: the widest that the machine has
  /// (blocks; cells) where a cell's numbers begin in the histories; empty: cell after cell.
  std::vector<std::vector<std::int64_t>> first_history = {};
};

/// Histories of the points of all cells (cells, points, numbers of the law), of laws that have one.
struct PointHistories {
  std::span<const double> before;  // at the step's begin
  std::span<double> after;         // at its end; empty: not wanted
};

/// [J] of all cells: stored, and dissipated in the step.
struct CellEnergies {
  double stored = 0.0, dissipated = 0.0;
};

/// Instruction sets that both the build and this machine know, the widest first.
std::vector<const KernelTable*> batched_kernels();

/// Internal force and energies of a whole mesh by cells in batches of 8: for explicit steps.
/// Reference geometry is computed anew from the nodes each time, which is cheaper than to read it
/// from memory. The same bits for every number of threads and every width of registers.
class BatchedCells {
 public:
  /// Whether all cells (hex8, quad4, tet4, tri3, full tet10 and hex20) and the law have a batched
  /// form; cells that share their place with another body's have none.
  static bool can(const Mesh& mesh, const Material& material, Formulation formulation);

  BatchedCells(const Mesh& mesh, const Material& material, const BatchedOptions& options);

  /// q: [m] (nodes, dim) displacements; force: [N] (nodes, dim) r(q). False: a point has no answer,
  /// or a number is not finite, and all results are undefined.
  [[nodiscard]] bool evaluate(std::span<const double> q, const PointHistories& histories,
                              std::span<double> force, CellEnergies& energies);

  /// Whether their frequencies have a bound.
  bool bounds() const;
  /// An upper bound [1/s^2] of at least `from` on the square of all cells' frequencies at q, to a
  /// hundredth of what [M.58] gives. scales: [Pa s^2/m^2] (patches, batches, 8) moduli per metric
  /// and square; history: of all points. Infinite: a cell has no answer.
  double bound_frequencies(std::span<const double> q, std::span<const double> history, double from,
                           std::span<const double> scales);
  /// Adds the cells that are not shown to be slower than a limit, in the order of the patches.
  struct Place {
    int block = 0, cell = 0;
  };
  void find_fast(std::span<const double> q, std::span<const double> history, double square,
                 std::span<const double> scales, std::vector<Place>& out);

  const CellPatches& patches() const { return patches_; }
  WorkerThreads& threads() { return threads_; }
  const char* instructions() const { return table_.instructions; }
  std::size_t bytes() const;  // [B] of memory that this object holds

 private:
  struct Copies {  // of what the nodes of one patch carry
    std::vector<double> displacement, force;
  };
  struct Histories {
    const double* before = nullptr;
    double* after = nullptr;
  };
  void evaluate(std::size_t patch, Copies& copies, std::span<const double> q,
                const Histories& histories, std::span<double> force);
  void ask_all(std::span<const double> q, std::span<const double> history,
               std::span<const double> scales);
  void place_histories(const Mesh& mesh, const std::vector<std::vector<std::int64_t>>& given);
  PatchView view_of(std::size_t patch, Copies& copies, const Histories& histories) const;
  void copy_displacement(const CellPatch& patch, Copies& copies, std::span<const double> q) const;

  int dim_;
  CellPatches patches_;
  const KernelTable& table_;
  std::vector<Tabulation> rules_;                         // (blocks)
  std::vector<BatchedParameters> parameters_;             // (blocks)
  std::vector<PatchKernel> kernels_;                      // (blocks)
  std::vector<FrequencyKernel> frequencies_;              // (blocks)
  std::vector<Copies> copies_;                            // (threads)
  std::vector<double> shared_;                            // [N] (shared copies, dim)
  std::vector<int> cell_numbers_;                         // (blocks) of a cell's history
  std::vector<CellEnergies> energies_;                    // (patches)
  std::vector<std::vector<std::int64_t>> first_history_;  // (patches; batches, 8) or nothing
  std::vector<unsigned char> answers_;                    // (patches)
  std::vector<FrequencyQuestion> questions_;              // (patches)
  std::vector<std::vector<std::int32_t>> fast_;           // (patches) places in the patch
  WorkerThreads threads_;
};

}  // namespace abut
