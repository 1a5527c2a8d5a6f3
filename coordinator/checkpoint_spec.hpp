#pragma once

#include <string_view>
#include <variant>

#include "base/fields.hpp"

namespace abut {

// From one checkpoint to the next.
struct WindowsBetween {
  static constexpr std::string_view name = "windows";
  static constexpr std::string_view shorthand = "every";
  int every = 1;
  void fields(Fields& f);
};
struct TimeBetween {
  static constexpr std::string_view name = "time";
  static constexpr std::string_view shorthand = "every";
  double every = 0.0;  // [s] of the scene
  void fields(Fields& f);
};
struct WallTimeBetween {
  static constexpr std::string_view name = "wall";
  static constexpr std::string_view shorthand = "every";
  double every = 0.0;  // [s] of a clock
  void fields(Fields& f);
};
using CheckpointSpec = std::variant<WindowsBetween, TimeBetween, WallTimeBetween>;

}  // namespace abut
