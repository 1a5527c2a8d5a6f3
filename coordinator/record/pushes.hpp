#pragma once

#include <vector>

#include "base/archive.hpp"

namespace abut {

/// Contacts as the force tells them: it goes from nothing to something and back. Judged on
/// impulses, which both sides have alike: whose substeps tell the force, and what was tried to find
/// it, makes no difference. Two pushes are one contact where the force is missing for less than
/// `together`, or for less than twice that and by less than a hundredth of the largest impulse; a
/// contact of less than that impulse is a touch of what vibrates.
class Pushes {
 public:
  /// `together` [s]; 0: every end may count.
  explicit Pushes(double together) : together_(together) {}

  /// A force [N], positive in compression, that goes linearly from one value to another over a part
  /// of time [s] after the parts before.
  void add(double from, double to, double before, double now);

  bool any() const { return !pushes_.empty(); }
  int count() const;

  void state(Archive& archive);

 private:
  struct Push {
    double begin = 0.0, end = 0.0, impulse = 0.0;  // [s] [s] [N s]
    double force() const { return impulse / (end - begin); }
  };
  std::vector<Push> contacts(double negligible) const;

  double together_;
  double peak_ = 0.0;  // [N] largest force so far
  std::vector<Push> pushes_;
};

}  // namespace abut
