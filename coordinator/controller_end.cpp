// What a run's end says of its bodies.

#include "coordinator/controller.hpp"
#include "coordinator/record/validity_notes.hpp"

namespace abut {

/// By the measures that it has told last.
void Controller::judge(int body) {
  const Description& about = bodies_.describe(body);
  for (const std::string& note : validity_notes(about, end_.body_measures.back()))
    narrator_.warning(clock_.time(), about.name, note);
  const std::string why = unheld(about, end_.body_measures.back());
  if (end_.status == "completed" && !why.empty()) fail(clock_.time(), why);
}

}  // namespace abut
