#include "subdomain_solver/substeps.hpp"

#include <algorithm>

#include "base/count.hpp"

namespace abut {

RecordClock::RecordClock(const Advance& request, int substeps)
    : window_(request.window), records_(std::max(1, request.records)), substeps_(substeps) {
  next();
}

void RecordClock::next() {
  ++next_;
  due_ =
      done() ? -1 : count_within(static_cast<double>(next_) * substeps_ / records_, 0, substeps_);
}

double RecordClock::time() const {
  if (next_ == records_) return window_.end;
  const int each = std::max(1, records_ / static_cast<int>(window_.windows));
  const int k = next_ / each, j = next_ % each;
  const double from = window_.stop(k);
  return j == 0 ? from : from + j * ((window_.stop(k + 1) - from) / each);
}

}  // namespace abut
