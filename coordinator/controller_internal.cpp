#include <fmt/format.h>

#include "coordinator/controller.hpp"
#include "coordinator/coupling/internal_contact.hpp"

namespace abut {

/// Contact inside a body is computed there: the coordinator imposes nothing and tells what it saw.
void Controller::watch_internal() {
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].internal) continue;
    Interface& interface = coupling_.interfaces[i];
    const InternalContact seen = watch_internal_contact(interface, bodies_);
    reports_[i].closed = seen.pressed;
    for (const InternalContact::Change& change : seen.changes) {
      if (change.closes) {
        emit(RunEvent::Kind::contact_closed, change.time, interface.name,
             fmt::format("contact closes at {:.6g} m/s inside body {}", change.speed,
                         bodies_.describe(interface.sides[0].body).name),
             {{"closing_speed", change.speed}});
      } else {
        emit(RunEvent::Kind::contact_opened, change.time, interface.name, "contact opens");
      }
    }
  }
}

}  // namespace abut
