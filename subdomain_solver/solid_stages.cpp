// How a solid goes on where another scheme has left it: stages of a scene.

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/quasi_static.hpp"

namespace abut {

/// From its own scheme: all of it; what holds it is given with the first window. From statics:
/// displacements, history and what was pressed stay, accelerations are none, since
/// all forces are in balance, and velocities are those that the body was built with, its
/// initial.velocity: work is done to give them. A massless surface stays where contact has pressed
/// it. From another scheme of motion: displacements and velocities stay, and
/// accelerations where forces act on ports, which the new scheme does not know of.
void SolidInterior::take_over(Archive& archive, Before by) {
  const bool statics = by == Before::statics;
  const std::string of = fmt::format("body '{}'", description_.name);
  if (by == Before::motion && description_.quasi_static)
    throw RunError("moves, and a stage without inertia cannot go on from there", of,
                   "Give statics before motion, or an implicit integrator");
  const std::vector<double> start = state_.motion.v;
  // Contact in passive form finds its forces anew, and has no place for those of before.
  const bool anew = by != Before::own && parts_.massive_surface;
  anew ? state_of_motion(archive) : state(archive);
  if (by == Before::own) {
    stands_ = state_.begun && !is_passive();
    return;
  }
  if (surfaces_ == nullptr) archive.leave_rest();
  Motion& motion = state_.motion;
  if (is_passive())
    throw RunError("is in its passive form where the stage before ends", of,
                   "Let that stage end at another time");
  if (statics) motion.v = start;
  const Motion before = motion;
  motion.control.clear();
  motion.step = 0.0;
  if (std::optional<Failed> failed = parts_.scheme.integrator->begin(motion, state_.time))
    throw RunError("cannot begin the stage: " + failed->detail, of, "Give another integrator");
  // Its beginning knows of no forces on ports.
  const bool held = std::ranges::any_of(state_.port_force, [](double f) { return f != 0.0; });
  stands_ = statics || held;
  if (!stands_) return;
  motion.q = before.q;
  motion.force = before.force;
  motion.stored = before.stored;
  if (!statics) {
    motion.a = before.a;
    return;
  }
  std::ranges::fill(motion.a, 0.0);
  motion.external_work += parts_.scheme.integrator->kinetic(motion);  // of what sets it in motion
}

}  // namespace abut
