#pragma once

#include "contract/subdomain.hpp"
#include "contract/substeps.hpp"

namespace abut {

/// Records at the ends of equal parts of a window, on the substeps nearest to them. Their times are
/// computed alike by all bodies.
class RecordClock {
 public:
  RecordClock(const Advance& request, int substeps);
  bool done() const { return next_ > records_; }
  int substep() const { return due_; }  // after which the next record is due; -1: no more
  double time() const;
  void next();

 private:
  TimeWindow window_;
  int records_, substeps_;
  int next_ = 0;
  int due_ = -1;  // kept: every substep asks for it
};

}  // namespace abut
