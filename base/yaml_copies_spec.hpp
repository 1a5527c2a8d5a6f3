#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/fields.hpp"

namespace abut {

// What a scene says of the copies of a body; each struct lists its keys once.

constexpr std::size_t max_copies = 10'000;  // of one body

struct GridCopies {
  std::vector<double> count, spacing;  // (dim), (dim) [m]
  void fields(Fields& f);
  std::size_t number() const;
  std::vector<double> offset(std::size_t i) const;  // [m] (dim) of a copy from the body's place
};
/// Other keys of the body's `initial` may stand beside them.
struct ListedCopy {
  std::vector<double> position, velocity;  // [m] [m/s] (dim)
  void fields(Fields& f);
};
struct TableCopies {
  std::string file;
  void fields(Fields& f);
};
struct CopiesSpec {
  std::optional<GridCopies> grid;
  std::vector<ListedCopy> list;
  std::optional<TableCopies> table;
  void fields(Fields& f);
};

}  // namespace abut
