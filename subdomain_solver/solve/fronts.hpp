#pragma once

#include <cstddef>
#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// Coordinates that are eliminated together: a dense lower trapezoid of the factor.
struct Front {
  int first = 0;           // of its columns, in the order of elimination
  int columns = 0;         // eliminated here
  int rows = 0;            // columns included
  int children = 0;        // fronts before it whose rest it takes
  std::size_t list = 0;    // where its rows begin in Fronts::rows, and their places
  std::size_t values = 0;  // where its block (rows, columns) begins in the factor
  int rest() const { return rows - columns; }
};

/// How a symmetric matrix is eliminated front by front (multifrontal; I. S. Duff and J. K. Reid,
/// 1983): nested dissection by METIS of the graph whose vertices are coordinates of one pattern, as
/// those of a node are. Fronts stand in postorder: each finds the rests of its children last.
struct Fronts {
  std::vector<int> order;      // (n) coordinate at each place of the elimination
  std::vector<Front> list;     // children before parents
  std::vector<int> rows;       // in the order of elimination, ascending in each front
  std::vector<int> in_parent;  // of each row that is left: which row of the parent's it is
  std::size_t values = 0;      // numbers of the factor
  std::size_t stack = 0;       // most numbers of the rests that wait
  std::size_t largest_rest = 0, longest = 0;  // numbers of a rest; rows
  std::size_t space = 0;                      // numbers that an elimination works with, at most
};

/// Of a matrix that has both halves of its pattern. The same pattern gives the same fronts.
Fronts find_fronts(const SparseMatrix& matrix);

}  // namespace abut
