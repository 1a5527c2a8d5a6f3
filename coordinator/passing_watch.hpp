#pragma once

#include <span>
#include <string>
#include <vector>

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Contacts that never closed although their sides went past each other, as those of ports on the
/// wrong side do, or of facets that look inwards.
class PassingWatch {
 public:
  /// After every accepted window or flight, whose replies are the latest.
  void watch(std::span<const Joint> joints, const Bodies& bodies);
  /// Names of the interfaces whose sides have come near, changed places, and never pressed.
  std::vector<std::string> passed(std::span<const Joint> joints, const Bodies& bodies) const;

 private:
  std::vector<bool> near_;  // by joint: the boxes that the sides swept overlapped
};

}  // namespace abut
