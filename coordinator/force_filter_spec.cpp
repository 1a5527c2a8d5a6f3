#include "coordinator/force_filter_spec.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace abut {

void MeanForceSpec::fields(Fields& f) {
  f.required("time", time, "s", "time over which the force is averaged", positive);
}

void ChannelClassSpec::fields(Fields& f) {
  constexpr std::array<int, 4> classes = {60, 180, 600, 1000};
  f.required("class", channel_class, "", "channel frequency class: 60, 180, 600 or 1000");
  f.check(std::ranges::find(classes, channel_class) != classes.end(), "class",
          fmt::format("is {}, which is no channel frequency class of SAE J211-1", channel_class),
          "Give 60, 180, 600 or 1000.");
}

}  // namespace abut
