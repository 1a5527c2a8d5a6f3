#pragma once

#include "subdomain_solver/solve/front_elimination.hpp"

namespace abut {

/// Substitution in one front of L D L^T: `block` (rows, columns) is its unit lower trapezoid L with
/// D on the diagonal, `values` (rows, right sides) what the right sides have at its rows.
///
/// The same source for every width of registers; all give the same bits, whatever the number of
/// right sides, as their sums have one order.
struct FrontSubstitution {
  /// L y = b: the columns' values become y, those of the rows below lose what y takes from them.
  void (*forward)(DenseView block, DenseView values);
  /// D L^T x = y: the columns' values, of y, become x; the rows below have theirs.
  void (*backward)(DenseView block, DenseView values);
};
extern const FrontSubstitution substitute_generic, substitute_avx2, substitute_avx512;

/// That of this machine.
const FrontSubstitution& substitution_here();

}  // namespace abut
