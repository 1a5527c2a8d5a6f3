#include "coordinator/record/contact_times.hpp"

#include <algorithm>

#include "base/archive_lists.hpp"

namespace abut {

void ContactTimes::join(double time) {
  closed_ = true;
  since_ = time;
}

void ContactTimes::close(double time) {
  if (closed_) return;
  closed_ = true;
  ++closings_;
  // Times located inside one substep may come in the wrong order.
  if (count_ > 0) time = std::max(time, end_);
  if (goes_on(time)) {
    finished_ += time - end_;
  } else {
    if (count_ == 0) begin_ = time;
    ++count_;
  }
  since_ = time;
}

void ContactTimes::open(double time) {
  if (!closed_) return;
  closed_ = false;
  end_ = std::max(time, since_);
  finished_ += end_ - since_;
}

double ContactTimes::closed(double run_end) const {
  return finished_ + (closed_ ? run_end - since_ : 0.0);
}

void ContactTimes::state(Archive& archive) {
  whole(archive, "count", count_);
  whole(archive, "closings", closings_);
  archive.field("closed", closed_);
  archive.field("begin", begin_);
  archive.field("end", end_);
  archive.field("since", since_);
  archive.field("finished", finished_);
}

}  // namespace abut
