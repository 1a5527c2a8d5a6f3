#pragma once

#include <cstddef>
#include <string>

namespace abut {

/// "1 number", "2 numbers".
inline std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
}

}  // namespace abut
