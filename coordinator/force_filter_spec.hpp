#pragma once

#include <string_view>
#include <variant>

#include "base/fields.hpp"

namespace abut {

/// Mean over a fixed time.
struct MeanForceSpec {
  static constexpr std::string_view name = "mean";
  double time = 0.0;  // [s]
  void fields(Fields& f);
};
/// Channel frequency class of SAE J211-1.
struct ChannelClassSpec {
  static constexpr std::string_view name = "cfc";
  int channel_class = 0;  // key class: 60, 180, 600 or 1000
  void fields(Fields& f);
};

/// What contact forces pass through before the largest is taken.
using ForceFilterSpec = std::variant<MeanForceSpec, ChannelClassSpec>;

}  // namespace abut
