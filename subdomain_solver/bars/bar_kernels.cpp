#include "subdomain_solver/bars/bar_kernels.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

// One binary for all machines: the loader picks the widest variant. Sanitizers do not support this.
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define ABUT_VECTORISED __attribute__((target_clones("avx2", "default")))
#else
#define ABUT_VECTORISED
#endif

namespace abut {

namespace {

/// Four doubles that the compiler maps to whatever the variant's registers are.
using Pack = double __attribute__((vector_size(32)));
constexpr std::size_t pack = 4;

inline __attribute__((always_inline)) void load(Pack& to, const double* from) {
  std::memcpy(&to, from, sizeof to);
}
inline __attribute__((always_inline)) void store(double* to, const Pack& from) {
  std::memcpy(to, &from, sizeof from);
}

/// How many doubles a place lies behind the begin of a pack's own space.
inline __attribute__((always_inline)) std::size_t place_in_pack(const double* at) {
  return reinterpret_cast<std::uintptr_t>(at) / sizeof(double) % pack;
}

/// First of the nodes [first, last) at which an array is aligned to packs. The heap begins arrays
/// at any 16 bytes, and stores across cache lines would cost a tenth of a pass.
inline __attribute__((always_inline)) std::size_t aligned_node(const double* array,
                                                               std::size_t first,
                                                               std::size_t last) {
  const std::size_t beyond = place_in_pack(array + first);
  return std::min(last, beyond == 0 ? first : first + pack - beyond);
}

}  // namespace

ABUT_VECTORISED
void kick_drift_nodes(double* __restrict u, double* __restrict v, std::size_t first,
                      std::size_t last, double g, double shift, double dt) {
  // One sweep: a pack of displacements is stored only after the next pack has read its old left
  // neighbour. Four loads and two stores per node instead of six and two.
  std::size_t i = first;
  double left = u[first - 1];  // old displacement left of the next node
  if (i + pack <= last) {
    Pack moved{};
    for (; i + pack <= last; i += pack) {
      Pack before, here, after, velocity;
      load(before, u + i - 1);
      load(here, u + i);
      load(after, u + i + 1);
      load(velocity, v + i);
      velocity += g * ((after - here) - (here - before)) + shift;
      store(v + i, velocity);
      if (i != first) store(u + i - pack, moved);
      moved = here + dt * velocity;
    }
    left = u[i - 1];
    store(u + i - pack, moved);
  }
  for (; i < last; ++i) {
    const double here = u[i];
    v[i] += g * ((u[i + 1] - here) - (here - left)) + shift;
    u[i] = here + dt * v[i];
    left = here;
  }
}

ABUT_VECTORISED
void kick_nodes(const double* __restrict s, double* __restrict v, std::size_t first,
                std::size_t last, double g, double shift) {
  const auto kick = [=](std::size_t i) {
    v[i] += g * ((s[i + 1] - s[i]) - (s[i] - s[i - 1])) + shift;
  };
  const std::size_t aligned = aligned_node(v, first, last);
  for (std::size_t i = first; i < aligned; ++i) kick(i);
  for (std::size_t i = aligned; i < last; ++i) kick(i);
}

ABUT_VECTORISED
void drift_nodes(double* __restrict u, const double* __restrict v, std::size_t first,
                 std::size_t last, double dt) {
  const std::size_t aligned = aligned_node(u, first, last);
  for (std::size_t i = first; i < aligned; ++i) u[i] += dt * v[i];
  for (std::size_t i = aligned; i < last; ++i) u[i] += dt * v[i];
}

ABUT_VECTORISED
void smooth_nodes(const double* __restrict u, const double* __restrict t, double* __restrict out,
                  std::size_t first, std::size_t last, double ratio) {
  const auto smooth = [=](std::size_t i) {
    out[i] = u[i] + ratio * ((t[i] - t[i - 1]) - (t[i + 1] - t[i]));
  };
  const std::size_t aligned = aligned_node(out, first, last);
  for (std::size_t i = first; i < aligned; ++i) smooth(i);
  for (std::size_t i = aligned; i < last; ++i) smooth(i);
}

double* placed_like(const double* other, std::size_t n, std::vector<double>& buffer) {
  if (buffer.size() < n + pack) buffer.resize(n + pack);
  const std::size_t shift = place_in_pack(other) + pack - place_in_pack(buffer.data());
  return buffer.data() + shift % pack;
}

}  // namespace abut
