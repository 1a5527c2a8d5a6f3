#pragma once

namespace abut {

/// One end of an interface.
struct Side {
  int body = 0, port = 0;
};

}  // namespace abut
