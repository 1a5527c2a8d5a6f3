#pragma once

#include <string>
#include <vector>

namespace abut {

/// What people want to know of a body before it moves, beside its Description.
struct BodyFacts {
  // [m] (dim) corners of the box around its mesh where the scene puts it; empty: it has no mesh
  std::vector<double> low, high;
  double wave_speed = 0.0;  // [m/s] of the fastest wave at rest; 0: nothing deforms
  double speed = 0.0;       // [m/s] with which all of it begins, of a solid
  // [s] up to which explicit steps would be stable on this mesh; 0: nothing deforms in time, or not
  // computed
  double explicit_limit = 0.0;
  // Paths below the body of the keys that say its size and its step; empty: there is none.
  std::string size_key, step_key;
  // Why its density and stiffness cannot both be meant, whose key, and what to do; empty: they may.
  std::string material_doubt, material_key, material_remedy;
};

}  // namespace abut
