#include "subdomain_solver/contact/slid_points.hpp"

#include "base/index.hpp"

namespace abut {

namespace {

/// Sweeps before it come from guesses: what slides in them may be far from what will.
constexpr int first_that_counts = 3;

}  // namespace

void SlidPoints::begin(const TimeWindow& window, int substeps, std::size_t points) {
  const bool again = window.index == window_.index && window.begin == window_.begin &&
                     window.end == window_.end && points == points_ && sweep_ > 0;
  window_ = window;
  substeps_ = substeps;
  points_ = points;
  sweep_ = again ? sweep_ + 1 : 1;
  if (sweep_ == first_that_counts) slid_.assign(index(substeps) * points, 0);
}

void SlidPoints::see(int i, std::span<double> slid) {
  if (sweep_ < first_that_counts || i < 1 || i >= substeps_) return;
  char* seen = slid_.data() + index(i - 1) * points_;
  for (std::size_t k = 0; k < slid.size(); ++k) {
    if (slid[k] != 0.0) seen[k] = 1;
    if (seen[k] != 0) slid[k] = 1.0;
  }
}

}  // namespace abut
