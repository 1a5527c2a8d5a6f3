#pragma once

#include <cstddef>

namespace abut {

/// A dense matrix, column by column; `stride` from column to column.
struct DenseView {
  double* values = nullptr;
  std::ptrdiff_t rows = 0, columns = 0, stride = 0;
  double* at(std::ptrdiff_t row, std::ptrdiff_t column) const {
    return values + row + column * stride;
  }
};

/// Of a strip of L D, and of a tile's rows of L, at the widest registers.
constexpr std::size_t packed_strip = 32'768, packed_rows = 4'096;

/// Numbers that an elimination works with beside a front of so many rows and columns.
constexpr std::size_t elimination_space(std::size_t rows, std::size_t columns,
                                        std::size_t workers = 1) {
  return rows * columns + workers * (packed_strip + packed_rows);
}

/// Who shares the work of an elimination; alone by default. Plain pointers: inline code of others
/// must not be compiled for the registers of one machine.
struct Team {
  using Work = void(const void* argument, std::size_t task, int worker);
  void* self = nullptr;
  int workers = 1;
  /// work(argument, task, worker) for every task below `tasks`.
  void (*run)(void* self, std::size_t tasks, Work* work, const void* argument) = nullptr;
};

/// Eliminates the columns of a front by L D L^T without exchanges: `block` (rows, columns) becomes
/// the unit lower trapezoid L with D on its diagonal, and L D L^T of the rows below its columns is
/// taken from the lower half of `rest` (rows - columns, squared). What stands above the diagonals
/// is undefined. `space`: as elimination_space of as many workers. False: a pivot is nothing, or
/// not a number.
///
/// The same source for every width of registers; all give the same bits, whoever works, as every
/// entry loses its products one by one in their order.
using Eliminate = bool(DenseView block, DenseView rest, double* space, const Team& team);
Eliminate eliminate_generic, eliminate_avx2, eliminate_avx512;

/// That of this machine.
Eliminate& eliminate_here();

}  // namespace abut
