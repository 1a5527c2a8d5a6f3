#pragma once

#include <array>
#include <string>

#include "base/fields.hpp"

namespace abut {

/// Of an interface what tells a body whom it meets; the rest is the coordinator's.
struct InterfaceSides {
  std::array<std::string, 2> sides;
  void fields(Fields& f) {
    f.required("sides", sides, "", "two ports that meet, as body.port");
    f.ignore_rest();
  }
};

}  // namespace abut
