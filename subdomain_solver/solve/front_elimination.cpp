// Compiled once for each instruction set, with ABUT_LANES doubles to a register; only
// ABUT_ELIMINATE leaves this file, so that no code for one machine reaches another.
#include "subdomain_solver/solve/front_elimination.hpp"

namespace abut {

namespace {

typedef double Lanes __attribute__((vector_size(8 * ABUT_LANES)));
typedef double MemoryLanes __attribute__((vector_size(8 * ABUT_LANES), aligned(8)));
using Index = std::ptrdiff_t;

// A tile of the product stays in registers, its rows of L in the first cache, a strip of L D in the
// second.
constexpr Index front_lanes = ABUT_LANES, tall = 2 * front_lanes, wide = 4;
constexpr Index depth = 256, strip = 128;
static_assert(tall * depth <= packed_rows && strip * depth <= packed_strip);
constexpr Index narrow = 8;   // columns that are eliminated one by one
constexpr Index chunk = 512;  // rows of a strip that one of a team takes at a time
static_assert(chunk % tall == 0);
// Products that make up for calling a team together, which takes some microseconds.
constexpr Index worth_a_team = 1'000'000;

constexpr Index smaller(Index a, Index b) { return a < b ? a : b; }

/// Rows first to first + count of x, columns k to k + d, as `height` numbers a column: what is
/// missing is zero.
template <Index height>
void pack(const DenseView& x, Index first, Index k, Index d, double* out) {
  const Index count = smaller(height, x.rows - first);
  for (Index c = 0; c < d; ++c, out += height) {
    const double* from = x.at(first, k + c);
    for (Index i = 0; i < count; ++i) out[i] = from[i];
    for (Index i = count; i < height; ++i) out[i] = 0.0;
  }
}

/// c (tall, wide) less a b^T, both packed.
void take_tile(const double* a, const double* b, Index d, double* c, Index stride) {
  Lanes sum[2][wide];
  for (Index j = 0; j < wide; ++j)
    for (Index i = 0; i < 2; ++i)
      sum[i][j] = *reinterpret_cast<const MemoryLanes*>(c + i * front_lanes + j * stride);
  for (Index k = 0; k < d; ++k, a += tall, b += wide) {
    const Lanes low = *reinterpret_cast<const MemoryLanes*>(a);
    const Lanes high = *reinterpret_cast<const MemoryLanes*>(a + front_lanes);
#pragma GCC unroll 4
    for (Index j = 0; j < wide; ++j) {
      sum[0][j] -= low * b[j];
      sum[1][j] -= high * b[j];
    }
  }
  for (Index j = 0; j < wide; ++j)
    for (Index i = 0; i < 2; ++i)
      *reinterpret_cast<MemoryLanes*>(c + i * front_lanes + j * stride) = sum[i][j];
}

/// The same of a tile that reaches beyond the edges of c.
void take_edge(const double* a, const double* b, Index d, double* c, Index stride, Index rows,
               Index columns) {
  double tile[tall * wide] = {};
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) tile[i + j * tall] = c[i + j * stride];
  take_tile(a, b, d, tile, tall);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) c[i + j * stride] = tile[i + j * tall];
}

/// What is taken from c, on and below its diagonal, less l ld^T: l has as many rows as c, ld as c
/// has columns. Strips of columns and chunks of their rows are tasks.
struct Products {
  const DenseView &c, &l, &ld;
  double* space;  // packed rows and strips, of each worker
  Index strips() const { return (c.columns + strip - 1) / strip; }
  Index chunks() const { return (c.rows + chunk - 1) / chunk; }
};

void take_part(const void* argument, std::size_t task, int worker) {
  const Products& of = *static_cast<const Products*>(argument);
  const DenseView &c = of.c, &l = of.l, &ld = of.ld;
  double* packed_l = of.space + static_cast<Index>(worker) * Index{packed_rows + packed_strip};
  double* packed_ld = packed_l + packed_rows;
  const Index first = static_cast<Index>(task) / of.chunks() * strip;
  const Index last = smaller(first + strip, c.columns);
  // Chunks begin where the strip meets the diagonal, so that all are of whole tiles.
  const Index from = first + static_cast<Index>(task) % of.chunks() * chunk;
  const Index to = smaller(from + chunk, c.rows);
  if (from >= to) return;
  for (Index k = 0; k < l.columns; k += depth) {
    const Index d = smaller(depth, l.columns - k);
    for (Index j = first; j < last; j += wide) pack<wide>(ld, j, k, d, packed_ld + (j - first) * d);
    for (Index i = from; i < to; i += tall) {
      pack<tall>(l, i, k, d, packed_l);
      for (Index j = first; j < last && j < i + tall; j += wide) {
        const double* b = packed_ld + (j - first) * d;
        const Index rows = c.rows - i, columns = last - j;
        if (rows >= tall && columns >= wide)
          take_tile(packed_l, b, d, c.at(i, j), c.stride);
        else
          take_edge(packed_l, b, d, c.at(i, j), c.stride, smaller(rows, tall),
                    smaller(columns, wide));
      }
    }
  }
}

void take(const DenseView& c, const DenseView& l, const DenseView& ld, double* space,
          const Team& team) {
  const Products of{c, l, ld, space};
  const auto tasks = static_cast<std::size_t>(of.strips() * of.chunks());
  if (team.run != nullptr && tasks > 1 && c.rows * c.columns * l.columns > worth_a_team)
    return team.run(team.self, tasks, take_part, &of);
  for (std::size_t task = 0; task < tasks; ++task) take_part(&of, task, 0);
}

DenseView part(const DenseView& x, Index row, Index rows, Index column, Index columns) {
  return {x.at(row, column), rows, columns, x.stride};
}

bool eliminate_one_by_one(const DenseView& block, const DenseView& ld) {
  for (Index j = 0; j < block.columns; ++j) {
    double *own = block.at(0, j), *kept = ld.at(0, j);
    const double pivot = own[j];
    if (!(pivot < 0.0 || pivot > 0.0)) return false;
    for (Index k = j + 1; k < block.columns; ++k) {
      const double factor = own[k] / pivot;
      double* other = block.at(0, k);
      for (Index i = k; i < block.rows; ++i) other[i] -= factor * own[i];
    }
    for (Index i = j + 1; i < block.rows; ++i) {
      kept[i] = own[i];
      own[i] /= pivot;
    }
  }
  return true;
}

/// A half of the columns, what they take from the other, and that one; L D is kept beside.
bool eliminate_columns(const DenseView& block, const DenseView& ld, double* space,
                       const Team& team) {
  const Index n = block.columns, rows = block.rows;
  if (n <= narrow) return eliminate_one_by_one(block, ld);
  const Index half = (n / 2 + narrow - 1) / narrow * narrow, other = n - half;
  if (!eliminate_columns(part(block, 0, rows, 0, half), part(ld, 0, rows, 0, half), space, team))
    return false;
  const DenseView right = part(block, half, rows - half, half, other);
  take(right, part(block, half, rows - half, 0, half), part(ld, half, other, 0, half), space, team);
  return eliminate_columns(right, part(ld, half, rows - half, half, other), space, team);
}

}  // namespace

bool ABUT_ELIMINATE(DenseView block, DenseView rest, double* space, const Team& team) {
  const DenseView ld{space, block.rows, block.columns, block.rows};
  double* packed = space + block.rows * block.columns;
  if (!eliminate_columns(block, ld, packed, team)) return false;
  const Index n = block.columns, left = block.rows - n;
  if (left > 0) take(rest, part(block, n, left, 0, n), part(ld, n, left, 0, n), packed, team);
  return true;
}

}  // namespace abut
