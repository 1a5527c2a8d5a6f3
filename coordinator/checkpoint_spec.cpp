#include "coordinator/checkpoint_spec.hpp"

#include "base/key.hpp"

namespace abut {

void WindowsBetween::fields(Fields& f) {
  f.required("every", every, "", "number of windows from one checkpoint to the next",
             between(1, 1000000000));
}

void TimeBetween::fields(Fields& f) {
  f.required("every", every, "s", "time of the scene from one checkpoint to the next", positive);
}

void WallTimeBetween::fields(Fields& f) {
  f.required("every", every, "s (clock)", "time on the clock from one checkpoint to the next",
             positive);
}

}  // namespace abut
