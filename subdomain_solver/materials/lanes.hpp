#pragma once

#include <cstring>

/// Loop over first <= i < end that becomes straight code: only then do the entries of small arrays
/// of lanes live in registers. ABUT_LOOPS_STAY: it remains a loop, for code that calls a library
/// for each sum anyway.
#ifdef ABUT_LOOPS_STAY
#define ABUT_UNROLLED(i, first, end) for (int i = (first); i < static_cast<int>(end); ++i)
#else
#define ABUT_UNROLLED(i, first, end) \
  _Pragma("GCC unroll 16") for (int i = (first); i < static_cast<int>(end); ++i)
#endif

/// Behind the parameters of a lambda over lanes: it becomes part of the kernel that calls it.
#define ABUT_INLINED __attribute__((always_inline))

namespace abut {

/// N doubles that go through one computation together (GCC vector extension): + - * / act lane by
/// lane, and the compiler maps them to whatever registers the enclosing function may use. Kernels
/// over lanes belong into functions with target_clones, so that one binary serves all machines.
template <int N>
struct Lanes {
  typedef double Real __attribute__((vector_size(8 * N)));
  typedef unsigned long Bits __attribute__((vector_size(8 * N)));
};

/// A tensor at each of N points, entry i + 3 J.
template <int N>
struct alignas(8 * N) TensorLanes {
  typename Lanes<N>::Real entry[9];
};

// To and from memory only by these and by TensorLanes: how a bare vector is aligned depends on the
// registers that a function may use.
template <int N>
[[gnu::always_inline]] inline typename Lanes<N>::Real load(const double* from) {
  typename Lanes<N>::Real x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
template <int N>
[[gnu::always_inline]] inline void store(const typename Lanes<N>::Real& x, double* to) {
  std::memcpy(to, &x, sizeof x);
}

/// Keeps GCC from taking neighbouring calls apart into scalars before it has seen the vector; Clang
/// does not.
template <class Real>
[[gnu::always_inline]] inline Real kept_whole(const Real& x) {
#if defined(__clang__)
  return x;
#else
  return __builtin_assoc_barrier(x);
#endif
}

/// a b + c in one rounding. Explicit, as the build contracts nothing by itself: the same bits on
/// every machine, and slow, by a library call, on one without the instruction.
template <class Real>
[[gnu::always_inline]] inline Real fused(const Real& a, const Real& b, const Real& c) {
  Real sum;
  ABUT_UNROLLED (i, 0, sizeof(Real) / sizeof(double)) sum[i] = __builtin_fma(a[i], b[i], c[i]);
  return kept_whole(sum);
}

template <class Real>
[[gnu::always_inline]] inline Real broadcast(double x) {
  return Real{} + x;
}

/// Whether no lane is negative, zero or not a number.
template <class Real>
[[gnu::always_inline]] inline bool all_positive(const Real& x) {
  bool positive = true;
  ABUT_UNROLLED (i, 0, sizeof(Real) / sizeof(double)) positive = positive && x[i] > 0.0;
  return positive;
}

/// y (1 - e)^(-1/3) with e = 1 - x y^3, by its series: an error d of y becomes about 12 d^4.
template <class Real>
[[gnu::always_inline]] inline Real improve_inverse_cube_root(const Real& x, const Real& y) {
  const Real e = fused(Real(-x * y), Real(y * y), broadcast<Real>(1.0));
  const Real third = fused(e, broadcast<Real>(14.0 / 81.0), broadcast<Real>(2.0 / 9.0));
  return fused(Real(y * e), fused(e, third, broadcast<Real>(1.0 / 3.0)), y);
}

/// x^(-1/3) for positive normal x, to two roundings, without division or branch. The bits of a
/// double, read as an integer, are its logarithm but for a few percent; minus a third of them is a
/// first guess within 3.6 %, and two improvements are enough.
template <int N>
[[gnu::always_inline]] inline typename Lanes<N>::Real inverse_cube_root(
    const typename Lanes<N>::Real& x) {
  using Real = typename Lanes<N>::Real;
  using Bits = typename Lanes<N>::Bits;
  // The upper 52 bits become the integer part of a double above 2^52, and back: conversions and
  // quotients of 64-bit integers have no instruction on most machines.
  Bits bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits = (bits >> 12) | 0x4330000000000000ul;
  Real logarithm;
  std::memcpy(&logarithm, &bits, sizeof bits);
  // 4/3 of the bits of 1; less 0.069 of an octave, so that 1 - x y^3 errs by 0.105 to both sides.
  const double offset = 4.0 / 3.0 * 0x3ff0000000000p0 - 0.069 * 0x1p40;
  logarithm = fused(Real(logarithm - 0x1p52), broadcast<Real>(-1.0 / 3.0),
                    broadcast<Real>(0x1p52 + offset));
  std::memcpy(&bits, &logarithm, sizeof bits);
  bits <<= 12;
  Real guess;
  std::memcpy(&guess, &bits, sizeof bits);
  return improve_inverse_cube_root(x, improve_inverse_cube_root(x, guess));
}

/// (1 + x)^(-1/3) - 1: d of (1 + d)^3 (1 + x) = 1. One step of Newton's method restores the digits
/// that the cube root loses near 1.
template <int N>
[[gnu::always_inline]] inline typename Lanes<N>::Real inverse_cube_root_less_one(
    const typename Lanes<N>::Real& x) {
  using Real = typename Lanes<N>::Real;
  const Real root = inverse_cube_root<N>(Real(1.0 + x)), d = root - 1.0;
  const Real cube = d * fused(d, Real(3.0 + d), broadcast<Real>(3.0));  // (1 + d)^3 - 1
  const Real residual = fused(cube, x, Real(cube + x));
  return fused(residual, Real(root * (-1.0 / 3.0)), d);
}

}  // namespace abut
