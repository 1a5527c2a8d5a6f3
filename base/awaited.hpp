#pragma once

#include <string>

namespace abut {

/// Somebody else starts the processes of all bodies, whatever the scene says of them.
struct Awaited {
  std::string endpoint;    // where they find this program
  std::string keys;        // folder; empty: they have none
  double patience = 60.0;  // [s] for all of them to come
};

}  // namespace abut
