#include "coordinator/wanted_fit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/coupling/roles.hpp"
#include "coordinator/surface_start.hpp"

namespace abut {

namespace {

/// Bodies without inertia take an overlap at once, or have taken it in the stages before: nobody
/// draws it for another reason.
bool statics_alone(const Scene& scene, const Joint& joint, const Bodies& bodies) {
  const auto is_static = [&](const Side& side) {
    const Description& body = bodies.describe(side.body);
    return body.quasi_static || std::isinf(body.mass) || scene.bodies[side.body].second.stood;
  };
  return std::ranges::all_of(joint.sides, is_static);
}

}  // namespace

void find_fit(const std::array<std::string, 2>& sides, const std::string& where, const Scene& scene,
              const Bodies& bodies, Joint& joint) {
  if (joint.role.fitted < 0 && !statics_alone(scene, joint, bodies)) return;
  const auto side = [&](std::size_t s) {
    return named_surface(sides[s], bodies.describe(joint.sides[s].body), joint.sides[s].port);
  };
  const int found_by = contact_finder(joint, bodies);
  const NamedSurface one = side(index(found_by)), other = side(index(1 - found_by));
  joint.fit = overlap_of(one, other);
  if (joint.role.fitted < 0 || joint.fit == 0.0) return;
  const Description& finder = bodies.describe(joint.sides[index(joint.role.fitted)].body);
  if (found_by != joint.role.fitted || !finder.can.obstacle)
    throw InputError(fmt::format("has initial.interference, but {} finds the contact",
                                 sides[index(1 - joint.role.fitted)]),
                     where,
                     "Give the key to that body, or let this one find contact by "
                     "transmission.unilateral.kinematic.");
}

void check_fits(const Scene& scene, std::span<const Joint> joints) {
  for (std::size_t b = 0; b < scene.bodies.size() && scene.everything() == nullptr; ++b) {
    if (!scene.bodies[b].second.fits) continue;
    const bool used = std::ranges::any_of(joints, [b](const Joint& joint) {
      return joint.fit > 0.0 && joint.role.fitted >= 0 &&
             index(joint.sides[index(joint.role.fitted)].body) == b;
    });
    if (used) continue;
    throw InputError("has no effect: the body overlaps nothing that it touches",
                     "bodies." + scene.bodies[b].first + ".initial.interference",
                     "Draw the body with its interference, or leave the key out.");
  }
}

void check_nothing_before(const Scene& scene) {
  for (const auto& [name, entry] : scene.bodies) {
    if (!entry.stood) continue;
    throw InputError("is true, but nothing was before: it is written into stages",
                     "bodies." + name + ".initial.after_statics",
                     "Leave it out, and write statics and what follows them as stages.");
  }
}

}  // namespace abut
