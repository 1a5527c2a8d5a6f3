// Compiled once for each instruction set, with ABUT_LANES doubles to a register; only ABUT_KERNELS
// leaves this file, so that no code for one machine reaches another.
#include "subdomain_solver/fe/batched_flat_cells.hpp"
#include "subdomain_solver/fe/batched_hex8.hpp"
#include "subdomain_solver/fe/batched_hex8_one_point.hpp"
#include "subdomain_solver/fe/batched_kernel.hpp"

namespace abut {

namespace {

using Row = Lanes<4>::Real;  // what a node carries: 3 numbers and one unused

/// Values of 8 cells' nodes, (nodes, 3, 8), from rows of 4.
template <int nodes>
[[gnu::always_inline]] inline void gather(const double* from, const std::int32_t* list,
                                          double* out) {
  ABUT_UNROLLED (a, 0, nodes)
    ABUT_UNROLLED (part, 0, 2) {
      const int half = 4 * part;
      const std::int32_t* at = list + a * batch_lanes + half;
      const Row r0 = load<4>(from + 4 * at[0]), r1 = load<4>(from + 4 * at[1]);
      const Row r2 = load<4>(from + 4 * at[2]), r3 = load<4>(from + 4 * at[3]);
      const Row xz01 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6);
      const Row xz23 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);
      const Row y01 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
      const Row y23 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
      double* to = out + 3 * a * batch_lanes + half;
      store<4>(__builtin_shufflevector(xz01, xz23, 0, 1, 4, 5), to);
      store<4>(__builtin_shufflevector(y01, y23, 0, 1, 4, 5), to + batch_lanes);
      store<4>(__builtin_shufflevector(xz01, xz23, 2, 3, 6, 7), to + 2 * batch_lanes);
    }
}

/// Adds to rows of 4, node after node and cell after cell: the same sums for every width of lanes,
/// and cells of a batch may share nodes.
template <int nodes>
[[gnu::always_inline]] inline void scatter(const double* from, const std::int32_t* list,
                                           double* out) {
  const Row none{};
  ABUT_UNROLLED (a, 0, nodes)
    ABUT_UNROLLED (part, 0, 2) {
      const int half = 4 * part;
      const std::int32_t* at = list + a * batch_lanes + half;
      const double* values = from + 3 * a * batch_lanes + half;
      const Row x = load<4>(values), y = load<4>(values + batch_lanes);
      const Row z = load<4>(values + 2 * batch_lanes);
      const Row xy02 = __builtin_shufflevector(x, y, 0, 4, 2, 6);
      const Row xy13 = __builtin_shufflevector(x, y, 1, 5, 3, 7);
      const Row z02 = __builtin_shufflevector(z, none, 0, 4, 2, 6);
      const Row z13 = __builtin_shufflevector(z, none, 1, 5, 3, 7);
      const Row rows[4] = {__builtin_shufflevector(xy02, z02, 0, 1, 4, 5),
                           __builtin_shufflevector(xy13, z13, 0, 1, 4, 5),
                           __builtin_shufflevector(xy02, z02, 2, 3, 6, 7),
                           __builtin_shufflevector(xy13, z13, 2, 3, 6, 7)};
      ABUT_UNROLLED (l, 0, 4) {
        double* node = out + 4 * at[l];
        store<4>(Row(load<4>(node) + rows[l]), node);
      }
    }
}

template <class Cell, class Law>
bool run_patch(PatchView& patch, const BatchedParameters& parameters) {
  constexpr int lanes = ABUT_LANES;
  using Real = Lanes<lanes>::Real;
  using Bits = Lanes<lanes>::Bits;
  constexpr int size = Cell::nodes * 3 * batch_lanes;
  alignas(64) double x[size], u[size], force[size];
  const Law law{parameters.moduli};
  Bits valid = ~Bits{};
  for (int b = 0; b < patch.batches; ++b) {
    const std::int32_t* list = patch.nodes + b * Cell::nodes * batch_lanes;
    gather<Cell::nodes>(patch.reference, list, x);
    gather<Cell::nodes>(patch.displacement, list, u);
    for (int slice = 0; slice < batch_lanes; slice += lanes) {
      Real stored = load<lanes>(patch.stored.data() + slice);
      Cell::template evaluate<lanes, Law>(x + slice, u + slice, force + slice, law, parameters,
                                          stored, valid);
      store<lanes>(stored, patch.stored.data() + slice);
    }
    scatter<Cell::nodes>(force, list, patch.force);
  }
  ABUT_UNROLLED (l, 0, lanes)
    if (valid[l] == 0) return false;
  return true;
}

template <class Cell>
constexpr std::array<PatchKernel, static_cast<int>(BatchedLaw::count)> row() {
  return {run_patch<Cell, LinearElasticResponse>, run_patch<Cell, SaintVenantKirchhoffResponse>,
          run_patch<Cell, NeoHookeanResponse>};
}

constexpr KernelTable table = {
    ABUT_INSTRUCTIONS,
    {row<Hex8>(), row<Hex8OnePoint>(), row<Quad4>(), row<Quad4OnePoint>(), row<Tet4>()}};

}  // namespace

const KernelTable& ABUT_KERNELS() { return table; }

}  // namespace abut
