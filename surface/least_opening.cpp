#include "surface/least_opening.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace abut {

void least_opening(const SparseRows& rows, std::span<const double> gaps, std::span<const char> met,
                   double within, int most_sweeps, std::span<double> d) {
  const std::size_t count = index(rows.count());
  std::vector<double> pushed(count, 0.0), square(count, 0.0);  // multipliers; of the rows' factors
  for (std::size_t r = 0; r < count; ++r)
    for (std::int32_t e = rows.offsets[r]; e < rows.offsets[r + 1]; ++e)
      square[r] += rows.values[e] * rows.values[e];
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double most = 0.0;  // [m] by which a row was moved
    for (std::size_t r = 0; r < count; ++r) {
      if (!(square[r] > 0.0)) continue;  // nothing of it can move
      double gap = gaps[r];
      for (std::int32_t e = rows.offsets[r]; e < rows.offsets[r + 1]; ++e)
        gap += rows.values[e] * d[rows.columns[index(e)]];
      const double whole = -gap / square[r];
      const double push = met[r] != 0 ? whole : std::max(-pushed[r], whole);
      if (push == 0.0) continue;
      pushed[r] += push;
      most = std::max(most, std::abs(push) * square[r]);
      for (std::int32_t e = rows.offsets[r]; e < rows.offsets[r + 1]; ++e)
        d[rows.columns[index(e)]] += push * rows.values[e];
    }
    if (most <= within) return;
  }
}

}  // namespace abut
