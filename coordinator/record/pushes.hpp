#pragma once

#include <vector>

namespace abut {

/// Contacts as the force tells them: it goes from nothing to something and back. What sets in again
/// within `together` of its end has not parted; what brings less than a hundredth of the impulse of
/// the largest push is a touch of what vibrates. Judged on impulses, which both sides have alike:
/// whose substeps tell the force, and what was tried to find it, makes no difference.
class Pushes {
 public:
  /// `together` [s]; 0: every end counts.
  explicit Pushes(double together) : together_(together) {}

  /// A force [N], positive in compression, that goes linearly from one value to another over a part
  /// of time [s] after the parts before.
  void add(double from, double to, double before, double now);

  bool any() const { return !impulses_.empty(); }
  int count() const;

 private:
  double together_;
  double last_ = 0.0, peak_ = 0.0;  // [s] [N] end of the last push, largest force so far
  std::vector<double> impulses_;    // [N s] of all, however small
};

}  // namespace abut
