#pragma once

#include "subdomain_solver/fe/batched_kernel.hpp"
#include "subdomain_solver/fe/batched_responses.hpp"
#include "subdomain_solver/materials/batched_j2.hpp"
#include "subdomain_solver/materials/batched_j2_bound.hpp"

namespace abut {

// A law at the points of N cells of a patch: `begin(batch, slice)` says of which ones, then a point
// is asked by its place among the cell's histories and H.

/// Laws without a history: stress and energy, or tangent moduli.
template <int N, class Law>
struct ElasticPoints {
  static constexpr bool dissipates = false;
  Law law;

  ElasticPoints(const PatchView&, const BatchedParameters& p) : law(law_of(p)) {}
  [[gnu::always_inline]] void begin(int, int) {}
  template <class... Out>
  [[gnu::always_inline]] void operator()(int, const TensorLanes<N>& h, Out&... out) const {
    law(h, out...);
  }

 private:
  static Law law_of(const BatchedParameters& p) {
    if constexpr (requires { Law{p.moduli, p.mooney_rivlin}; })
      return {p.moduli, p.mooney_rivlin};
    else
      return {p.moduli};
  }
};

/// Histories of N cells, number by number.
template <int N>
struct HistoryRows {
  const PatchView& patch;
  const double* from[N] = {};
  double* to[N] = {};

  /// Lanes without a cell have points that nothing has happened to, at most 27 of hex20.
  [[gnu::always_inline]] void begin(int batch, int slice) {
    static constexpr double nothing[27 * J2HistoryLanes<N>::size] = {};
    for (int l = 0; l < N; ++l) {
      const std::int64_t first = patch.first_history[batch * batch_lanes + slice + l];
      from[l] = first < 0 ? nothing : patch.before + first;
      to[l] = first < 0 || patch.after == nullptr ? nullptr : patch.after + first;
    }
  }
  [[gnu::always_inline]] J2HistoryLanes<N> read(int point) const {
    constexpr int size = J2HistoryLanes<N>::size;
    J2HistoryLanes<N> out;
    ABUT_UNROLLED (k, 0, size)
      ABUT_UNROLLED (l, 0, N) out.at[k][l] = from[l][point * size + k];
    return out;
  }
  [[gnu::always_inline]] void write(int point, const J2HistoryLanes<N>& history) const {
    constexpr int size = J2HistoryLanes<N>::size;
    ABUT_UNROLLED (l, 0, N) {
      if (to[l] == nullptr) continue;
      ABUT_UNROLLED (k, 0, size) to[l][point * size + k] = history.at[k][l];
    }
  }
};

/// Stress, energy, dissipation and new history of J2 plasticity.
template <int N>
struct J2Points {
  static constexpr bool dissipates = true;
  const BatchedParameters& parameters;
  HistoryRows<N> rows;

  J2Points(const PatchView& patch, const BatchedParameters& p) : parameters(p), rows{patch} {}
  [[gnu::always_inline]] void begin(int batch, int slice) { rows.begin(batch, slice); }
  [[gnu::always_inline]] void operator()(int point, const TensorLanes<N>& h,
                                         LaneResponse<N>& out) const {
    const HardeningNumbers& hardening = parameters.hardening;
    const J2HistoryLanes<N> before = rows.read(point);
    J2HistoryLanes<N> after;
    const J2Lanes<N> state(parameters.moduli, hardening, h, before);
    state.stress(parameters.moduli, out.stress);
    state.advance(before, after);
    out.energy = state.energy(parameters.moduli, hardening, after);
    out.dissipation = hardening.yield_stress * state.flow;
    out.valid = state.answers();
    rows.write(point, after);
  }
};

/// Moduli that bound its tangents.
template <int N>
struct J2BoundPoints {
  J2Bound bound;
  HistoryRows<N> rows;

  J2BoundPoints(const PatchView& patch, const BatchedParameters& p)
      : bound{p.moduli, p.hardening}, rows{patch} {}
  [[gnu::always_inline]] void begin(int batch, int slice) { rows.begin(batch, slice); }
  [[gnu::always_inline]] void operator()(int point, const TensorLanes<N>& h,
                                         ElasticityLanes<N>& moduli,
                                         typename Lanes<N>::Real& valid) const {
    bound(h, rows.read(point), moduli, valid);
  }
};

}  // namespace abut
