#pragma once

#include <functional>
#include <string>

#include "base/error.hpp"

namespace abut {

/// What an InputError of a call says, whole; or that there was none.
inline std::string refusal(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

}  // namespace abut
