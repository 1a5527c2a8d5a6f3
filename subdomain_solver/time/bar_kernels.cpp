#include "subdomain_solver/time/bar_kernels.hpp"

#include <algorithm>

// One binary for all machines: the loader picks the widest variant. Sanitizers do not support this.
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define ABUT_VECTORISED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define ABUT_VECTORISED
#endif

namespace abut {

namespace {
/// Nodes per block: u and v of two blocks stay in the first-level cache.
constexpr std::size_t block = 512;
}  // namespace

ABUT_VECTORISED
void kick_drift_nodes(double* __restrict u, double* __restrict v, std::size_t first,
                      std::size_t last, double g, double shift, double dt) {
  std::size_t drifted = first;
  for (std::size_t begin = first; begin < last; begin += block) {
    const std::size_t end = std::min(begin + block, last);
    for (std::size_t i = begin; i < end; ++i) {
      v[i] += g * ((u[i + 1] - u[i]) - (u[i] - u[i - 1])) + shift;
    }
    // A node may move once the velocity of its right neighbour no longer needs its old place.
    const std::size_t movable = end == last ? last : end - 1;
    for (std::size_t i = drifted; i < movable; ++i) u[i] += dt * v[i];
    drifted = std::max(drifted, movable);
  }
}

ABUT_VECTORISED
void kick_nodes(const double* __restrict s, double* __restrict v, std::size_t first,
                std::size_t last, double g, double shift) {
  for (std::size_t i = first; i < last; ++i) {
    v[i] += g * ((s[i + 1] - s[i]) - (s[i] - s[i - 1])) + shift;
  }
}

ABUT_VECTORISED
void drift_nodes(double* __restrict u, const double* __restrict v, std::size_t first,
                 std::size_t last, double dt) {
  for (std::size_t i = first; i < last; ++i) u[i] += dt * v[i];
}

ABUT_VECTORISED
void smooth_nodes(const double* __restrict u, const double* __restrict t, double* __restrict out,
                  std::size_t first, std::size_t last, double ratio) {
  for (std::size_t i = first; i < last; ++i) {
    out[i] = u[i] + ratio * ((t[i] - t[i - 1]) - (t[i + 1] - t[i]));
  }
}

}  // namespace abut
