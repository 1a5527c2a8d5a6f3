#pragma once

#include <vector>

#include "contract/subdomain.hpp"

namespace abut {

/// How a body divides a window.
struct Substeps {
  double begin = 0.0, end = 0.0, step = 0.0, last = 0.0;  // [s]
  int count = 0;

  /// Whole substeps, and a shorter last one where they do not fill the window. Throws RunError for
  /// more than most_substeps.
  static Substeps divide(double begin, double end, double step);
  double length(int i) const { return i == count ? last : step; }  // i = 1..count
  double time(int i) const { return i == count ? end : begin + i * step; }
  bool matches(const std::vector<double>& times) const;  // the same instants, i = 0..count
};

/// Records at the ends of equal parts of a window, on the substeps nearest to them. Their times are
/// computed alike by all bodies.
class RecordClock {
 public:
  RecordClock(const Advance& request, int substeps);
  bool done() const { return next_ > records_; }
  int substep() const;  // after which the next record is due; -1: no more
  double time() const;
  void next() { ++next_; }

 private:
  TimeWindow window_;
  int records_, substeps_;
  int next_ = 1;
};

}  // namespace abut
