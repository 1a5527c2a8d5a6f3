#pragma once

#include <cstddef>
#include <vector>

#include "base/archive.hpp"

namespace abut {

/// What points of ports have near them, as pictures and measures show it: a body that comes back to
/// a state shows what it showed there.
class SeenGaps {
 public:
  /// `sticks`: friction holds the point; `gap` [m].
  void add(std::size_t port, std::size_t point, double gap, bool sticks) {
    values_.insert(values_.end(), {static_cast<double>(port), static_cast<double>(point), gap,
                                   sticks ? 1.0 : 0.0});
  }

  /// Calls `see(point, gap, sticks)` for those of a port of so many points; others, which only a
  /// damaged checkpoint can hold, are passed over.
  template <class See>
  void visit(std::size_t port, std::size_t points, const See& see) const {
    for (std::size_t k = 0; k + 3 < values_.size(); k += 4) {
      const double point = values_[k + 1];
      if (values_[k] != static_cast<double>(port)) continue;
      if (point >= 0.0 && point < static_cast<double>(points))
        see(static_cast<std::size_t>(point), values_[k + 2], values_[k + 3] != 0.0);
    }
  }

  void state(Archive& archive) { archive.field("seen_gaps", values_); }

 private:
  std::vector<double> values_;  // port, point, gap, 1 where it sticks
};

}  // namespace abut
