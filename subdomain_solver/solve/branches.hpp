#pragma once

#include <cstddef>
#include <vector>

#include "subdomain_solver/solve/fronts.hpp"

namespace abut {

/// Fronts that need no others: one front with all below it. Its coordinates are those that it
/// eliminates, one after the other in the order of elimination, and then the rows that its last
/// front leaves.
struct Branch {
  std::size_t first = 0, end = 0;  // fronts, in postorder; the last is its root
  int first_column = 0;            // in the order of elimination
  int columns = 0, rest = 0;
  std::size_t place = 0;  // where its coordinates begin among those of all branches
  int size() const { return columns + rest; }
};

/// Parts of an elimination that threads can do at once. They follow from the fronts alone, so that
/// sums over them have the same bits whoever works.
struct Branches {
  std::vector<Branch> list;          // in postorder; none of a small factor
  std::vector<const Front*> others;  // that are in none, in postorder
  std::vector<int> rows;             // as Fronts::rows, of branches counted in their coordinates
  std::size_t places = 0;            // coordinates of all branches
  std::size_t stack = 0, top_stack = 0;  // most numbers of rests that wait in a branch; of others
};

/// `fronts` must outlive them.
Branches find_branches(const Fronts& fronts);

}  // namespace abut
