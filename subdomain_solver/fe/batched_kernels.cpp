// Compiled once for each instruction set, with ABUT_LANES doubles to a register; only ABUT_KERNELS
// leaves this file, so that no code for one machine reaches another.
#include "subdomain_solver/fe/batched_flat_cells.hpp"
#include "subdomain_solver/fe/batched_hex8.hpp"
#include "subdomain_solver/fe/batched_hex8_one_point.hpp"
#include "subdomain_solver/fe/batched_kernel.hpp"
#include "subdomain_solver/fe/batched_law_points.hpp"
#include "subdomain_solver/fe/batched_mean_dilatation.hpp"
#include "subdomain_solver/fe/batched_points.hpp"
#include "subdomain_solver/fe/batched_simplices.hpp"
#include "subdomain_solver/fe/batched_tabulated.hpp"

namespace abut {

namespace {

using Row = Lanes<4>::Real;  // what a node carries: 3 numbers and one unused

/// Values of 8 cells' nodes, (nodes, 3, 8), from rows of 4. Called, as scatter is: one code serves
/// all cells of so many nodes.
template <int nodes>
[[gnu::noinline]] void gather(const double* from, const std::int32_t* list, double* out) {
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
[[gnu::noinline]] void scatter(const double* from, const std::int32_t* list, double* out) {
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

/// A law that is called, not inlined: what it does at a point costs hundreds of times what a call
/// does, within each cell's code it takes minutes to compile, and one such code serves all of them.
class CalledLaw {
 public:
  static constexpr bool dissipates = true;  // or nothing

  virtual void begin(int batch, int slice) = 0;
  virtual void respond(int point, const TensorLanes<ABUT_LANES>& h,
                       LaneResponse<ABUT_LANES>& out) const = 0;
  [[gnu::always_inline]] void operator()(int point, const TensorLanes<ABUT_LANES>& h,
                                         LaneResponse<ABUT_LANES>& out) const {
    respond(point, h, out);
  }

 protected:
  ~CalledLaw() = default;
};

template <class Points>
class CalledPoints final : public CalledLaw {
 public:
  CalledPoints(const PatchView& patch, const BatchedParameters& parameters)
      : points_(patch, parameters) {}

  void begin(int batch, int slice) override { points_.begin(batch, slice); }
  void respond(int point, const TensorLanes<ABUT_LANES>& h,
               LaneResponse<ABUT_LANES>& out) const override {
    points_(point, h, out);
    if constexpr (!Points::dissipates) out.dissipation = Lanes<ABUT_LANES>::Real{};
  }

 private:
  Points points_;
};

template <class Cell, class Law>
[[gnu::noinline]] bool run_cells(PatchView& patch, const BatchedParameters& parameters, Law& law) {
  constexpr int lanes = ABUT_LANES;
  constexpr int size = Cell::nodes * 3 * batch_lanes;
  alignas(64) double x[size], u[size], force[size];
  PointSums<lanes, Law::dissipates> sums;
  sums.valid = ~Lanes<lanes>::Bits{};
  for (int b = 0; b < patch.batches; ++b) {
    const std::int32_t* list = patch.nodes + b * Cell::nodes * batch_lanes;
    gather<Cell::nodes>(patch.reference, list, x);
    gather<Cell::nodes>(patch.displacement, list, u);
    for (int slice = 0; slice < batch_lanes; slice += lanes) {
      law.begin(b, slice);
      sums.stored = load<lanes>(patch.stored.data() + slice);
      if (Law::dissipates) sums.dissipated = load<lanes>(patch.dissipated.data() + slice);
      Cell::template evaluate<lanes>(x + slice, u + slice, force + slice, law, parameters, sums);
      store<lanes>(sums.stored, patch.stored.data() + slice);
      if (Law::dissipates) store<lanes>(sums.dissipated, patch.dissipated.data() + slice);
    }
    scatter<Cell::nodes>(force, list, patch.force);
  }
  ABUT_UNROLLED (l, 0, lanes)
    if (sums.valid[l] == 0) return false;
  return true;
}

template <class Cell, class Law>
bool run_patch(PatchView& patch, const BatchedParameters& parameters) {
  Law law(patch, parameters);
  return run_cells<Cell, Law>(patch, parameters, law);
}
template <class Cell, class Points>
bool call_patch(PatchView& patch, const BatchedParameters& parameters) {
  CalledPoints<Points> law(patch, parameters);
  return run_cells<Cell, CalledLaw>(patch, parameters, law);
}

/// A law that is asked whether its moduli at a point are below a limit times the metric of the
/// point's cell. Called, not inlined: what surrounds it is the same for all laws of a cell.
template <int dim>
class Asked {
 public:
  using Real = Lanes<ABUT_LANES>::Real;

  virtual void begin(int batch, int slice) = 0;
  virtual void keep_slower(int place, const TensorLanes<ABUT_LANES>& h, const Real& limit,
                           const Real (&metric)[dim][dim],
                           Lanes<ABUT_LANES>::Bits& below) const = 0;

 protected:
  ~Asked() = default;
};

template <int dim, class Tangent>
class AskedLaw final : public Asked<dim> {
 public:
  using typename Asked<dim>::Real;

  AskedLaw(const PatchView& patch, const BatchedParameters& parameters)
      : tangent_(patch, parameters) {}

  void begin(int batch, int slice) override { tangent_.begin(batch, slice); }
  void keep_slower(int place, const TensorLanes<ABUT_LANES>& h, const Real& limit,
                   const Real (&metric)[dim][dim], Lanes<ABUT_LANES>::Bits& below) const override {
    ElasticityLanes<ABUT_LANES> moduli;
    Real valid, scaled[dim][dim];
    tangent_(place, h, moduli, valid);
    below &= valid > 0.0;
    ABUT_UNROLLED (j, 0, dim)
      ABUT_UNROLLED (l, 0, dim) scaled[j][l] = limit * metric[j][l];
    MetricTest<dim, ABUT_LANES>::run(scaled, moduli, below);
  }

 private:
  Tangent tangent_;
};

/// Cells of a batch (x, u: nodal values) that are slower than a limit, one bit each.
template <class Points>
unsigned slower_cells(const double* x, const double* u, const double* scale, double square,
                      int batch, Asked<Points::dim>& law) {
  constexpr int lanes = ABUT_LANES, dim = Points::dim;
  using Real = Lanes<lanes>::Real;
  using Bits = Lanes<lanes>::Bits;
  unsigned slower = 0;
  for (int slice = 0; slice < batch_lanes; slice += lanes) {
    const Real limit = load<lanes>(scale + slice) * square;
    law.begin(batch, slice);
    Bits below = ~Bits{};
    Real metric[dim][dim];
    Points::template run<lanes>(x + slice, u + slice, metric,
                                [&](int place, const TensorLanes<lanes>& h) ABUT_INLINED {
                                  law.keep_slower(place, h, limit, metric, below);
                                });
    ABUT_UNROLLED (l, 0, lanes)
      if (below[l] != 0) slower |= 1u << (slice + l);
  }
  return slower;
}

template <class Points>
[[gnu::noinline]] void ask_cells(const PatchView& patch, FrequencyQuestion& question,
                                 Asked<Points::dim>& law) {
  constexpr int size = Points::nodes * 3 * batch_lanes;
  constexpr double most = 1.0e12;  // rises of the limit, for cells without an answer
  alignas(64) double x[size], u[size];
  const double end = question.square * most;
  for (int b = 0; b < patch.batches; ++b) {
    const std::int32_t* list = patch.nodes + b * Points::nodes * batch_lanes;
    gather<Points::nodes>(patch.reference, list, x);
    gather<Points::nodes>(patch.displacement, list, u);
    const int first = b * batch_lanes, rest = question.cells - first;
    const unsigned all = rest < batch_lanes ? (1u << rest) - 1 : (1u << batch_lanes) - 1;
    unsigned fast = 0;
    for (;;) {
      fast = all & ~slower_cells<Points>(x, u, question.scale + first, question.square, b, law);
      if (fast == 0 || question.fast != nullptr) break;
      question.square *= 1.01;
      if (question.square < end) continue;
      question.square = __builtin_inf();
      return;
    }
    for (int l = 0; l < batch_lanes; ++l)
      if ((fast >> l & 1u) != 0) question.fast[question.found++] = first + l;
  }
}

template <class Points, class Tangent>
void ask_patch(const PatchView& patch, const BatchedParameters& parameters,
               FrequencyQuestion& question) {
  AskedLaw<Points::dim, Tangent> law(patch, parameters);
  ask_cells<Points>(patch, question, law);
}

constexpr int laws = static_cast<int>(BatchedLaw::count);
template <class Law>
using Plain = ElasticPoints<ABUT_LANES, Law>;

template <class Points>
constexpr std::array<FrequencyKernel, laws> frequency_row() {
  return {ask_patch<Points, Plain<LinearElasticTangent>>,
          ask_patch<Points, Plain<SaintVenantKirchhoffTangent>>,
          ask_patch<Points, Plain<NeoHookeanTangent>>,
          ask_patch<Points, Plain<MooneyRivlinTangent>>,
          ask_patch<Points, Plain<HenckyBound>>,
          ask_patch<Points, J2BoundPoints<ABUT_LANES>>};
}

template <class Cell>
constexpr std::array<PatchKernel, laws> row() {
  return {run_patch<Cell, Plain<LinearElasticResponse>>,
          run_patch<Cell, Plain<SaintVenantKirchhoffResponse>>,
          run_patch<Cell, Plain<NeoHookeanResponse>>,
          call_patch<Cell, Plain<MooneyRivlinResponse>>,
          call_patch<Cell, Plain<HenckyResponse>>,
          call_patch<Cell, J2Points<ABUT_LANES>>};
}

/// Of cells with many points and nodes, which would take long to compile with every law.
template <class Cell>
constexpr std::array<PatchKernel, laws> called_row() {
  return {call_patch<Cell, Plain<LinearElasticResponse>>,
          call_patch<Cell, Plain<SaintVenantKirchhoffResponse>>,
          call_patch<Cell, Plain<NeoHookeanResponse>>,
          call_patch<Cell, Plain<MooneyRivlinResponse>>,
          call_patch<Cell, Plain<HenckyResponse>>,
          call_patch<Cell, J2Points<ABUT_LANES>>};
}

/// Of cells whose volume change is of finite strain: linear laws have another one.
template <class Cell>
constexpr std::array<PatchKernel, laws> finite_row() {
  std::array<PatchKernel, laws> all = row<Cell>();
  all[static_cast<int>(BatchedLaw::linear_elastic)] = nullptr;
  return all;
}

constexpr KernelTable table = {
    ABUT_INSTRUCTIONS,
    {row<Hex8>(), row<Hex8OnePoint>(), finite_row<Hex8MeanDilatation>(), row<Quad4>(),
     row<Quad4OnePoint>(), finite_row<Quad4MeanDilatation>(), row<Tet4>(), row<Tri3>(),
     called_row<TabulatedCell<10>>(), called_row<TabulatedCell<20>>()},
    {frequency_row<Hex8Points>(),
     frequency_row<Hex8MeanPoint>(),
     {},
     frequency_row<Quad4Points>(),
     frequency_row<Quad4MeanPoint>(),
     {},
     frequency_row<Tet4Point>(),
     frequency_row<Tri3Point>(),
     {},
     {}}};

}  // namespace

const KernelTable& ABUT_KERNELS() { return table; }

}  // namespace abut
