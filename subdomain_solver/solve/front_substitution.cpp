// Compiled once for each instruction set, with ABUT_LANES doubles to a register; only
// ABUT_SUBSTITUTE leaves this file, so that no code for one machine reaches another.
#include "subdomain_solver/solve/front_substitution.hpp"

namespace abut {

namespace {

typedef double Lanes __attribute__((vector_size(8 * ABUT_LANES)));
typedef double MemoryLanes __attribute__((vector_size(8 * ABUT_LANES), aligned(8)));
using Index = std::ptrdiff_t;

constexpr Index lanes = ABUT_LANES;
constexpr Index together = 4;  // columns that are read in one pass over their rows
constexpr Index partial = 8;   // sums of a product, whatever the width of registers
constexpr Index parts = partial / lanes;

Lanes load(const double* from) { return *reinterpret_cast<const MemoryLanes*>(from); }

/// y less the products of `count` columns from `from` on, with their values.
template <Index count>
void take_columns(const double* from, Index stride, const double* value, double* y, Index rows) {
  Index i = 0;
  for (; i + lanes <= rows; i += lanes) {
    Lanes sum = load(y + i);
#pragma GCC unroll 4
    for (Index c = 0; c < count; ++c) sum -= load(from + i + c * stride) * value[c];
    *reinterpret_cast<MemoryLanes*>(y + i) = sum;
  }
  for (; i < rows; ++i)
    for (Index c = 0; c < count; ++c) y[i] -= from[i + c * stride] * value[c];
}

/// `value` less the products of `count` columns with y.
template <Index count>
void take_products(const double* from, Index stride, const double* y, Index rows, double* value) {
  Lanes sum[count][parts] = {};
  Index i = 0;
  for (; i + partial <= rows; i += partial) {
#pragma GCC unroll 4
    for (Index p = 0; p < parts; ++p) {
      const Lanes other = load(y + i + p * lanes);
#pragma GCC unroll 4
      for (Index c = 0; c < count; ++c)
        sum[c][p] += load(from + i + p * lanes + c * stride) * other;
    }
  }
  for (Index c = 0; c < count; ++c) {
    double each[partial];
    for (Index p = 0; p < parts; ++p) *reinterpret_cast<MemoryLanes*>(each + p * lanes) = sum[c][p];
    for (Index l = 0; i + l < rows; ++l) each[l] += from[i + l + c * stride] * y[i + l];
    value[c] -=
        ((each[0] + each[1]) + (each[2] + each[3])) + ((each[4] + each[5]) + (each[6] + each[7]));
  }
}

template <Index count>
void forward_columns(const DenseView& block, Index j, const DenseView& values) {
  for (Index right = 0; right < values.columns; ++right) {
    double* y = values.at(j, right);
    for (Index c = 0; c < count; ++c)
      for (Index i = c + 1; i < count; ++i) y[i] -= *block.at(j + i, j + c) * y[c];
    take_columns<count>(block.at(j + count, j), block.stride, y, y + count, block.rows - j - count);
  }
}

template <Index count>
void backward_columns(const DenseView& block, Index j, const DenseView& values) {
  for (Index right = 0; right < values.columns; ++right) {
    double* y = values.at(j, right);
    for (Index c = 0; c < count; ++c) y[c] /= *block.at(j + c, j + c);
    take_products<count>(block.at(j + count, j), block.stride, y + count, block.rows - j - count,
                         y);
    for (Index c = count; c-- > 0;)
      for (Index i = c + 1; i < count; ++i) y[c] -= *block.at(j + i, j + c) * y[i];
  }
}

void forward(DenseView block, DenseView values) {
  Index j = 0;
  for (; j + together <= block.columns; j += together) forward_columns<together>(block, j, values);
  for (; j < block.columns; ++j) forward_columns<1>(block, j, values);
}

void backward(DenseView block, DenseView values) {
  Index j = block.columns;
  for (; j % together != 0; --j) backward_columns<1>(block, j - 1, values);
  for (; j > 0; j -= together) backward_columns<together>(block, j - together, values);
}

}  // namespace

const FrontSubstitution ABUT_SUBSTITUTE = {forward, backward};

}  // namespace abut
