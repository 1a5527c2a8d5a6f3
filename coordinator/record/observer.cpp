#include "coordinator/record/observer.hpp"

namespace abut {

const char* to_string(RunEvent::Kind kind) {
  switch (kind) {
    case RunEvent::Kind::contact_closed:
      return "contact_closed";
    case RunEvent::Kind::contact_opened:
      return "contact_opened";
    case RunEvent::Kind::swap:
      return "swap";
    case RunEvent::Kind::failure:
      return "failure";
    case RunEvent::Kind::warning:
      return "warning";
  }
  return "unknown";
}

}  // namespace abut
