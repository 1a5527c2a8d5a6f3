#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/fields.hpp"

namespace abut {

/// Of the kernels of tied surfaces, in two and three dimensions.
struct TieKernelSpec {
  static constexpr std::string_view path = "schwarz.ties";
  double memory = 2048.0;      // [MiB] of bodies that ties hold together
  std::string band = "auto";   // auto | waves | a number of spacings of rows
  std::optional<double> rows;  // where a number is given
  void fields(Fields& f);
};

}  // namespace abut
