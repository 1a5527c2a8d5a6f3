#include "subdomain_solver/solve/secants.hpp"

#include <cmath>

namespace abut {

void Secants::add(const Vector& step, double part, const Vector& before, const Vector& after) {
  if (count_ == most) {  // the oldest one goes
    first_ = (first_ + 1) % most;
    --count_;
  }
  Pair& last = pair(count_);
  last.step = part * step;
  last.change = after - before;
  const double work = last.step.dot(last.change);
  if (!(work > 0.0) || !std::isfinite(1.0 / work)) return;
  last.inverse = 1.0 / work;
  ++count_;
}

}  // namespace abut
