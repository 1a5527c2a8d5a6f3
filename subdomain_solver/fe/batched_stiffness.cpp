// Compiled once for each instruction set, with ABUT_LANES doubles to a register; only
// ABUT_STIFFNESS leaves this file, so that no code for one machine reaches another.
#include "subdomain_solver/fe/batched_stiffness.hpp"

#include "subdomain_solver/fe/batched_responses.hpp"
#include "subdomain_solver/fe/batched_slowness.hpp"
#include "subdomain_solver/materials/batched_tangents.hpp"

namespace abut {

namespace {

constexpr int lanes = ABUT_LANES;
constexpr int most_points = 27;
using Real = Lanes<lanes>::Real;
using Tensor = TensorLanes<lanes>;
using Elasticity = ElasticityLanes<lanes>;

/// Some of the cells of a batch, as many as a register holds.
template <int dim>
struct Slice {
  const StiffnessBatch& batch;
  int first;  // cell

  Real volume(int p) const { return number(batch.volume, p); }
  Real gradient(int p, int a, int j) const {
    return number(batch.gradient, (p * batch.nodes + a) * dim + j);
  }
  Tensor displacement_gradient(int p) const {
    Tensor h{};
    for (int a = 0; a < batch.nodes; ++a)
      ABUT_UNROLLED (j, 0, dim) {
        const Real slope = gradient(p, a, j);
        ABUT_UNROLLED (i, 0, dim) {
          Real& entry = h.entry[i + 3 * j];
          entry = fused(number(batch.displacement, a * dim + i), slope, entry);
        }
      }
    return h;
  }
  Real number(const double* rows, int row) const {
    return load<lanes>(rows + row * batch_lanes + first);
  }
  double* entry(int pair, int i, int k) const {
    return batch.stiffness + ((pair * dim + i) * dim + k) * batch_lanes + first;
  }
};

/// dP_iJ/dF_kL, of whichever block is kept.
inline const Real& entry_of(const Elasticity& a, int i, int j, int k, int l) {
  return j <= l ? a.at[j][l][i][k] : a.at[l][j][k][i];
}

/// Adds B^T D B of a point [M.43]; D: [J] moduli times its volume.
template <int dim>
void add_point(const Slice<dim>& slice, int p, const Elasticity& moduli) {
  int pair = 0;
  for (int a = 0; a < slice.batch.nodes; ++a) {
    Real pulled[dim][dim][dim];  // (i, k, L) sum over J of dN_a/dX_J D_iJkL
    ABUT_UNROLLED (i, 0, dim)
      ABUT_UNROLLED (k, 0, dim)
        ABUT_UNROLLED (l, 0, dim) {
          Real sum = slice.gradient(p, a, 0) * entry_of(moduli, i, 0, k, l);
          ABUT_UNROLLED (j, 1, dim)
            sum = fused(slice.gradient(p, a, j), entry_of(moduli, i, j, k, l), sum);
          pulled[i][k][l] = sum;
        }
    for (int b = a; b < slice.batch.nodes; ++b, ++pair) {
      Real slope[dim];
      ABUT_UNROLLED (l, 0, dim) slope[l] = slice.gradient(p, b, l);
      ABUT_UNROLLED (i, 0, dim)
        ABUT_UNROLLED (k, 0, dim) {
          double* at = slice.entry(pair, i, k);
          Real sum = load<lanes>(at);
          ABUT_UNROLLED (l, 0, dim) sum = fused(pulled[i][k][l], slope[l], sum);
          store<lanes>(sum, at);
        }
    }
  }
}

inline bool all_set(const Lanes<lanes>::Bits& bits) {
  ABUT_UNROLLED (l, 0, lanes)
    if (bits[l] == 0) return false;
  return true;
}

template <int dim, class Law>
bool add_points(const Slice<dim>& slice, const Law& law) {
  Lanes<lanes>::Bits valid = ~Lanes<lanes>::Bits{};
  for (int p = 0; p < slice.batch.points; ++p) {
    Elasticity moduli;
    Real answered;
    law.tangent(slice.displacement_gradient(p), moduli, answered);
    valid &= answered > 0.0;
    const Real volume = slice.volume(p);
    ABUT_UNROLLED (j, 0, dim)
      ABUT_UNROLLED (l, j, dim)
        ABUT_UNROLLED (i, 0, dim)
          ABUT_UNROLLED (k, 0, dim) moduli.at[j][l][i][k] *= volume;
    add_point(slice, p, moduli);
  }
  return all_set(valid);
}

/// The points of cells with one volume change [M.44], and what it adds to the tangent [M.45], by
/// the formulas of CellKernel::split_moduli() and couple_fields().
template <int dim>
class OneVolume {
 public:
  explicit OneVolume(const Slice<dim>& slice) : slice_(slice) {}

  template <class Law>
  bool add(const Law& law) {
    find_volume();
    find_pressure(law);
    ABUT_UNROLLED (a, 0, most_nodes)
      ABUT_UNROLLED (i, 0, dim) swelling_[a][i] = coupling_[a][i] = Real{};
    stiffness_ = Real{};
    for (int p = 0; p < slice_.batch.points; ++p) {
      Elasticity moduli;
      Real unused;
      law.tangent(carried(p), moduli, unused);
      split(p, moduli);
      add_point(slice_, p, moduli);
    }
    couple();
    return all_set(valid_);
  }

 private:
  static constexpr int most_nodes = 8;  // quadratic cells have more than one volume change

  void find_volume() {
    whole_ = Real{};
    Real swollen{};
    for (int p = 0; p < slice_.batch.points; ++p) {
      h_[p] = slice_.displacement_gradient(p);
      Tensor unused;
      jacobian_[p] = cofactor(plus_identity(h_[p]), unused);
      valid_ &= jacobian_[p] > 0.0;
      whole_ += slice_.volume(p);
      swollen = fused(slice_.volume(p), jacobian_[p], swollen);
    }
    theta_ = swollen / whole_;
    for (int p = 0; p < slice_.batch.points; ++p)
      stretch_[p] = inverse_cube_root<lanes>(Real(jacobian_[p] / theta_));
  }

  /// Fbar - I
  Tensor carried(int p) const {
    const Tensor f = plus_identity(h_[p]);
    Tensor out;
    ABUT_UNROLLED (k, 0, 9)
      out.entry[k] = fused(Real(stretch_[p] - 1.0), f.entry[k], h_[p].entry[k]);
    return out;
  }

  template <class Law>
  void find_pressure(const Law& law) {
    amount_ = Real{};
    for (int p = 0; p < slice_.batch.points; ++p) {
      const Tensor h = carried(p), f = plus_identity(h);
      LaneResponse<lanes> response;
      law.response(h, response);
      valid_ &= response.valid > 0.0;
      stress_[p] = response.stress;
      third_[p] = (1.0 / 3.0) * product(stress_[p], f);
      amount_ = fused(slice_.volume(p), third_[p], amount_);
    }
    amount_ = amount_ / (theta_ * whole_);
  }

  static Real product(const Tensor& a, const Tensor& b) {
    Real sum = a.entry[0] * b.entry[0];
    ABUT_UNROLLED (k, 1, 9) sum = fused(a.entry[k], b.entry[k], sum);
    return sum;
  }

  /// A : Fbar
  static Tensor contract(const Elasticity& a, const Tensor& f) {
    Tensor out;
    ABUT_UNROLLED (i, 0, 3)
      ABUT_UNROLLED (j, 0, 3) {
        Real sum{};
        ABUT_UNROLLED (k, 0, 3)
          ABUT_UNROLLED (l, 0, 3) sum = fused(entry_of(a, i, j, k, l), f.entry[k + 3 * l], sum);
        out.entry[i + 3 * j] = sum;
      }
    return out;
  }

  /// Of a point: its moduli by Fbar become those by F times its volume, and what theta and F have
  /// in common is added up.
  void split(int p, Elasticity& a) {
    const Tensor bar = plus_identity(carried(p));
    Tensor y, t = contract(a, bar);
    const Real volume = slice_.volume(p), s = stretch_[p], third = third_[p];
    const Real j = cofactor(plus_identity(h_[p]), y), inverse = 1.0 / j;
    ABUT_UNROLLED (m, 0, 9) y.entry[m] *= inverse;
    const Real c = (1.0 / 9.0) * (product(t, bar) + 3.0 * third);
    ABUT_UNROLLED (m, 0, 9) t.entry[m] = (1.0 / 3.0) * s * (t.entry[m] + stress_[p].entry[m]);
    const Real swelling = amount_ * j, on = c + swelling, across = third - swelling, square = s * s;
    ABUT_UNROLLED (row, 0, dim)
      ABUT_UNROLLED (l, row, dim)
        ABUT_UNROLLED (i, 0, dim)
          ABUT_UNROLLED (k, 0, dim) {
            const int ij = i + 3 * row, kl = k + 3 * l;
            Real sum = square * a.at[row][l][i][k];
            sum = fused(Real(-t.entry[ij]), y.entry[kl], sum);
            sum = fused(Real(-y.entry[ij]), t.entry[kl], sum);
            sum = fused(Real(on * y.entry[ij]), y.entry[kl], sum);
            sum = fused(Real(across * y.entry[i + 3 * l]), y.entry[k + 3 * row], sum);
            a.at[row][l][i][k] = volume * sum;
          }
    stiffness_ = fused(volume, Real((c - third) / (theta_ * theta_)), stiffness_);
    Tensor swell, common;
    ABUT_UNROLLED (m, 0, 9) {
      swell.entry[m] = volume * j * y.entry[m];
      common.entry[m] = volume / theta_ * (t.entry[m] - c * y.entry[m]);
    }
    integrate(p, swell, swelling_);
    integrate(p, common, coupling_);
  }

  /// Adds B^T S.
  void integrate(int p, const Tensor& s, Real (&to)[most_nodes][dim]) const {
    for (int a = 0; a < slice_.batch.nodes; ++a)
      ABUT_UNROLLED (i, 0, dim)
        ABUT_UNROLLED (j, 0, dim)
          to[a][i] = fused(s.entry[i + 3 * j], slice_.gradient(p, a, j), to[a][i]);
  }

  void couple() {
    const Real inverse = 1.0 / whole_;
    for (int a = 0; a < slice_.batch.nodes; ++a)
      ABUT_UNROLLED (i, 0, dim) {
        swelling_[a][i] *= inverse;
        coupling_[a][i] = fused(Real(0.5 * stiffness_), swelling_[a][i], coupling_[a][i]);
      }
    int pair = 0;
    for (int a = 0; a < slice_.batch.nodes; ++a)
      for (int b = a; b < slice_.batch.nodes; ++b, ++pair)
        ABUT_UNROLLED (i, 0, dim)
          ABUT_UNROLLED (k, 0, dim) {
            double* at = slice_.entry(pair, i, k);
            const Real sum = fused(coupling_[a][i], swelling_[b][k], load<lanes>(at));
            store<lanes>(fused(swelling_[a][i], coupling_[b][k], sum), at);
          }
  }

  const Slice<dim>& slice_;
  Tensor h_[most_points], stress_[most_points];  // H; P at Fbar
  Real jacobian_[most_points], stretch_[most_points];
  Real third_[most_points];  // [Pa] P : Fbar / 3
  Real whole_, theta_, amount_, stiffness_;
  Real swelling_[most_nodes][dim], coupling_[most_nodes][dim];
  Lanes<lanes>::Bits valid_ = ~Lanes<lanes>::Bits{};
};

template <class Response, class Tangent>
struct StiffnessLaw {
  Response response;
  Tangent tangent;
  explicit StiffnessLaw(const BatchedParameters& p) : response{p.moduli}, tangent{p.moduli} {}
};
using SaintVenantKirchhoffLaw =
    StiffnessLaw<SaintVenantKirchhoffResponse, SaintVenantKirchhoffTangent>;
using NeoHookeanLaw = StiffnessLaw<NeoHookeanResponse, NeoHookeanTangent>;

template <int dim, bool one_volume, class Law>
bool run(const StiffnessBatch& batch, const BatchedParameters& parameters) {
  const Law law(parameters);
  const int numbers = batch.nodes * (batch.nodes + 1) / 2 * dim * dim * batch_lanes;
  for (int k = 0; k < numbers; ++k) batch.stiffness[k] = 0.0;
  bool valid = true;
  for (int first = 0; first < batch_lanes; first += lanes) {
    const Slice<dim> slice{batch, first};
    if constexpr (one_volume)
      valid = OneVolume<dim>(slice).add(law) && valid;
    else
      valid = add_points(slice, law) && valid;
  }
  return valid;
}

template <class Law>
constexpr StiffnessKernels::OfLaw kernels_of() {
  return {run<2, false, Law>, run<3, false, Law>, run<2, true, Law>, run<3, true, Law>};
}

#ifdef __FP_FAST_FMA
constexpr bool fuses = true;
#else
constexpr bool fuses = false;
#endif

}  // namespace

const StiffnessKernels ABUT_STIFFNESS = {
    ABUT_INSTRUCTIONS,           kernels_of<SaintVenantKirchhoffLaw>(),
    kernels_of<NeoHookeanLaw>(), measure_all<2, lanes>,
    measure_all<3, lanes>,       find_slower<2, lanes>,
    find_slower<3, lanes>,       fuses};

}  // namespace abut
