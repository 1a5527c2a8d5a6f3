#pragma once

namespace abut {

/// While it lives, numbers of this thread, and of threads that it starts, that are too small for
/// full precision are zero. Fronts of waves have forerunners of any size: a row of bars at rest
/// would compute with 1e-310 for most of a run, a hundred times as slowly, with a few digits only.
/// Does nothing on processors that have no such switch.
class FlushedDenormals {
 public:
  FlushedDenormals();
  ~FlushedDenormals();
  FlushedDenormals(const FlushedDenormals&) = delete;
  FlushedDenormals& operator=(const FlushedDenormals&) = delete;

 private:
  unsigned long before_ = 0;  // the control register
};

}  // namespace abut
