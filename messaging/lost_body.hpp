#pragma once

#include "base/error.hpp"

namespace abut {

/// A body does not answer any more: its process, its machine or the way to it is gone.
class LostBody : public RunError {
 public:
  using RunError::RunError;
};

}  // namespace abut
