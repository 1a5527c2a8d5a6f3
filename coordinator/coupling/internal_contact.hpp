#pragma once

#include <vector>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// What a window showed of a contact that a body keeps inside itself.
struct InternalContact {
  struct Change {
    bool closes = false;
    double time = 0.0;   // [s] where gap (closing) or force (opening) crosses zero, linearly
    double speed = 0.0;  // [m/s] of closing
  };

  bool pressed = false;  // at any substep
  std::vector<Change> changes;
};

/// Reads the latest traces of both sides, which hold every substep, and keeps joint.contact.
InternalContact watch_internal_contact(Joint& joint, const Bodies& bodies);

}  // namespace abut
