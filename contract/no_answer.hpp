#pragma once

#include <string>

#include "base/error.hpp"
#include "contract/outcome.hpp"

namespace abut {

/// What keeps the accurate method from a window: a body has no port kernel in its state, or roles
/// go round in a circle. Bodies are where they were saved, or can be restored to it.
class NoAnswer : public RunError {
 public:
  using RunError::RunError;

  /// Of a body that was asked for a kernel.
  NoAnswer(const Failed& failure, const std::string& body)
      : RunError("has no port kernel: " + failure.detail, "body '" + body + "'",
                 "Give the body inertia or supports that hold it."),
        failed(failure) {}

  Failed failed;
};

}  // namespace abut
