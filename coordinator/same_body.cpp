#include "coordinator/same_body.hpp"

#include <fmt/format.h>

#include <cmath>

namespace abut {
namespace {

// Machines differ in the last bits of sines and roots, and so do places of generated nodes and the
// mass between them; meshes of equal topology that somebody has changed differ by more.
constexpr double mass_tolerance = 1.0e-9;

bool same_mass(double own, double theirs) {
  return own == theirs || std::abs(own - theirs) <= mass_tolerance * std::abs(own);
}

}  // namespace

std::string difference_of(const Description& own, const Description& theirs) {
  if (own.dim != theirs.dim)
    return fmt::format("it has {} dimensions, here it has {}", theirs.dim, own.dim);
  if (own.dofs != theirs.dofs)
    return fmt::format("it has {} degrees of freedom, here it has {}", theirs.dofs, own.dofs);
  if (!same_mass(own.mass, theirs.mass))
    return fmt::format("its mass is {:.9g} kg, here it is {:.9g} kg", theirs.mass, own.mass);
  if (own.model != theirs.model)
    return fmt::format("it is \"{}\", here it is \"{}\"", theirs.model, own.model);
  return "";
}

}  // namespace abut
