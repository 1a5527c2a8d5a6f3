#pragma once

#include "abut/v1/subdomain.pb.h"

namespace abut {

/// save() and restore() of a body that is elsewhere: they ride on the next request, whichever it
/// is.
class RidingFlags {
 public:
  void save() { save_first_ = true; }
  void restore() {
    // What is about to be saved is the present state, so there is nothing to return from.
    if (!save_first_) restore_first_ = true;
  }
  void ride(v1::Request& request) {
    request.set_restore_first(restore_first_);
    request.set_save_first(save_first_);
    restore_first_ = false;
    save_first_ = false;
  }

 private:
  bool save_first_ = false;     // wanted, not yet sent
  bool restore_first_ = false;  // before the save
};

}  // namespace abut
