#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coordinator/coupling/tie_layout.hpp"

namespace abut {

/// How far kernels of ties look.
struct TieBandWidth {
  // As many spacings of the rows' side, whatever the step; absent: as far as waves come.
  std::optional<double> rows;
  double cones = 1.0;  // of the way of a wave
};

/// Which rows of a body answer a force on one of its rows, and from which step on: those that a
/// wave from there can reach, along straight lines  [M.110]. Rows of one end have colours such that
/// no row answers two of one colour, so that all of a colour can be pressed at once.
struct TieBand {
  struct Reached {
    std::int32_t row = 0;   // of the body, over all its ends
    std::int32_t from = 0;  // step (from 0) at whose end it is reached
  };
  std::vector<std::size_t> offsets;  // (rows + 1) by the row that is pressed
  std::vector<Reached> reached;      // ascending by row
  std::vector<int> colour;           // (rows)
  std::vector<int> colours;          // (ends) number of them

  std::span<const Reached> of(std::size_t row) const {
    return std::span(reached).subspan(offsets[row], offsets[row + 1] - offsets[row]);
  }
};

/// `steps`: of the body, at whose ends it is read.
TieBand make_tie_band(const TieLayout& layout, const TieLayout::Part& part,
                      const TieBandWidth& width, int steps, const Bodies& bodies);

}  // namespace abut
