/// Cost of a material law per point: the scalar laws (stress, and stress with tangent), and the
/// batched ones at 4 and at 8 points at once, whichever registers the machine has. `per point`
/// is seconds per point; the points lie in the second-level cache.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/materials/batched_laws.hpp"
#include "subdomain_solver/materials/hencky.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/mooney_rivlin.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/materials/saint_venant_kirchhoff.hpp"

#if defined(__x86_64__)
#define ABUT_VECTORISED \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define ABUT_VECTORISED
#endif

namespace abut {
namespace {

constexpr std::size_t points = 512;
const Moduli moduli{1.25e9, 0.5e9};

/// A deformation that differs from point to point.
Matrix3 deformation(std::size_t point) {
  const double s = 1.0e-4 * static_cast<double>(point);
  Matrix3 f;
  f << 1.0 + s, 0.01, -s, 0.02, 1.0 - 0.5 * s, 0.03, s, -0.01, 1.0 + 0.2 * s;
  return f;
}

void report(benchmark::State& state) {
  state.counters["per point"] = benchmark::Counter(
      static_cast<double>(points),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void scalar(benchmark::State& state, const Material& law, Need want) {
  std::vector<Matrix3> f(points);
  for (std::size_t i = 0; i < points; ++i) f[i] = deformation(i);
  const std::vector<double> before(index(law.history_size()), 0.0);
  std::vector<double> after(before);
  PointResponse out;
  for (auto _ : state)
    for (const Matrix3& at : f) {
      const bool answers = law.evaluate(at, before, after, want, out);
      benchmark::DoNotOptimize(answers);
      benchmark::DoNotOptimize(out.stress.data());
    }
  report(state);
}

template <class Law, int N>
ABUT_VECTORISED void all_stresses(const Law& law, const TensorLanes<N>* f, TensorLanes<N>* p,
                                  double* valid) {
  for (std::size_t i = 0; i < points / N; ++i) {
    typename Lanes<N>::Real here;
    law.stress(f[i], p[i], here);
    store<N>(here, valid + i * N);
  }
}

template <class Law, int N>
void batched(benchmark::State& state) {
  std::vector<TensorLanes<N>> f(points / N), p(points / N);
  std::vector<double> valid(points);
  for (std::size_t i = 0; i < points; ++i)
    for (int k = 0; k < 9; ++k) f[i / N].entry[k][i % N] = deformation(i).reshaped()[k];
  const Law law{moduli};
  for (auto _ : state) {
    all_stresses<Law, N>(law, f.data(), p.data(), valid.data());
    benchmark::DoNotOptimize(p.data());
    benchmark::ClobberMemory();
  }
  report(state);
}

template <class Law>
void add_batched(const std::string& name) {
  benchmark::RegisterBenchmark((name + "/batched of 4").c_str(), batched<Law, 4>);
  benchmark::RegisterBenchmark((name + "/batched of 8").c_str(), batched<Law, 8>);
}

void add_scalar(const std::string& name, std::shared_ptr<const Material> law) {
  benchmark::RegisterBenchmark((name + "/scalar stress").c_str(),
                               [law](benchmark::State& s) { scalar(s, *law, Need::stress); });
  benchmark::RegisterBenchmark((name + "/scalar tangent").c_str(),
                               [law](benchmark::State& s) { scalar(s, *law, Need::tangent); });
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  using namespace abut;
  Hardening hardening;
  hardening.yield_stress = 1.0e7;
  hardening.modulus = 1.0e7;
  hardening.saturation = Saturation{2.0e7, 10.0};
  add_scalar("linear_elastic", std::make_shared<LinearElastic>(moduli, 1.0));
  add_batched<BatchedLinearElastic>("linear_elastic");
  add_scalar("saint_venant_kirchhoff", std::make_shared<SaintVenantKirchhoff>(moduli, 1.0));
  add_batched<BatchedSaintVenantKirchhoff>("saint_venant_kirchhoff");
  add_scalar("neo_hookean", std::make_shared<NeoHookean>(moduli, 1.0));
  add_batched<BatchedNeoHookean>("neo_hookean");
  const MooneyRivlinParameters rubber{0.15e9, 0.1e9, moduli.bulk, 1.0};
  add_scalar("mooney_rivlin", std::make_shared<MooneyRivlin>(rubber));
  add_scalar("hencky", std::make_shared<Hencky>(moduli, 1.0));
  add_scalar("j2_plasticity", std::make_shared<J2Plasticity>(moduli, hardening, 1.0));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
