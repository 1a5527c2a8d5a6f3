#pragma once

#include "base/fields.hpp"

namespace abut {

/// Of bodies that contact alone holds.
struct StabilisationSpec {
  double stiffness = 1.0e-2;
  double at_most = 1.0e-2;
  void fields(Fields& f) {
    f.optional("stiffness", stiffness, "",
               "part of the body's stiffness in tension along its largest extent, E V / L^2, that "
               "holds it as a whole; the force begins every step at nothing",
               between(1.0e-9, 1.0));
    f.optional("at_most", at_most, "",
               "part of the forces on the body that may be left to it at the end; a run that "
               "leaves more fails",
               between(0.0, 1.0));
  }
};

}  // namespace abut
