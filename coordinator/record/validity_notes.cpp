#include "coordinator/record/validity_notes.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace abut {

namespace {

/// Of length: what tables are read to.
constexpr double lengthened = 0.01;
/// Of the stored energy: the usual bound for cells of one point.
constexpr double in_hourglasses = 0.1;
/// Of the moment of inertia, of bodies that have turned by more than the angle [rad], and of any:
/// what rolls is a thirtieth faster, and of any an impact is off by some hundredths.
constexpr double inertia_of_what_turns = 0.9, inertia_of_all = 0.75, has_turned = 0.1;
/// Of the kinetic and stored energy: what a body stores below this is vibration of no interest.
constexpr double worth_a_look = 1.0e-6;

/// Of what a body stores: springs that have taken less bore some hundredths of the forces at most.
constexpr double springs_may_take = 0.05;

/// Of the forces on a body: springs that bear as much leave nothing to what may lie under it.
constexpr double everything = 0.99;

/// Of the forces along a motion: springs that bear as much are all that holds it.
constexpr double nothing_else = 0.5;
/// The same: less than this is not worth a word.
constexpr double along_told = 0.1;

/// 0: the body does not tell it.
double told(const Description& body, std::span<const double> values, const std::string& name) {
  const auto found = std::find(body.measures.begin(), body.measures.end(), name);
  const auto at = index(found - body.measures.begin());
  return found != body.measures.end() && at < values.size() ? values[at] : 0.0;
}

/// The motion along which a body was held, for people.
std::string stabilised_motion(const Description& body, std::span<const double> values) {
  std::string words;
  double most = 0.0;
  for (const char axis : std::string("xyz")) {
    const double force = told(body, values, std::string("stabilisation.force.") + axis);
    if (std::abs(force) <= most) continue;
    most = std::abs(force);
    words = fmt::format("moving along {}{}", force > 0.0 ? '-' : '+', axis);
  }
  const bool turns = most < 0.5 * told(body, values, "stabilisation.force");
  return turns ? "turning as a whole" : words;
}

std::string stabilisation_note(const Description& body, std::span<const double> values) {
  const double work = told(body, values, "stabilisation.work");
  std::string note = fmt::format(
      "'{}' is held as a whole by contact alone and was stabilised: at the end that "
      "bears {:.3g} % "
      "of the forces on it, {:.3g} % at most on the way; it took {:.3g} J",
      body.name, 100.0 * told(body, values, "stabilisation.share"),
      100.0 * told(body, values, "stabilisation.share_max"), work);
  if (const double along = told(body, values, "stabilisation.share_along"); along > along_told)
    note += fmt::format("; of the forces along the motion that it holds it bears {:.3g} %",
                        100.0 * along);
  if (work > springs_may_take * told(body, values, "energy.stored"))
    note += fmt::format(
        ", which is much beside what the body stores: forces before the end are too large by what "
        "it bore then. A hundredth of bodies.{}.integrator.quasi_static.stabilisation.stiffness "
        "(0.01 where nothing is said) bears less, and so do shorter steps",
        body.name);
  return note;
}

}  // namespace

double borne_over_allowed(const Description& body, std::span<const double> values) {
  const double share = told(body, values, "stabilisation.share");
  const double allowed = told(body, values, "stabilisation.at_most");
  return share > 0.0 ? share / allowed : 0.0;  // infinite where it may bear nothing
}

std::string unheld(const Description& body, std::span<const double> values) {
  const double share = told(body, values, "stabilisation.share");
  const double allowed = told(body, values, "stabilisation.at_most");
  const double along = told(body, values, "stabilisation.share_along");
  if (share <= allowed && along <= std::max(nothing_else, allowed)) return "";
  if (share <= allowed)
    return fmt::format(
        "body '{0}' is held against {1} by nothing: of the forces along this its stabilisation "
        "bears {2:.3g} % at the end, however hard it is pressed across. Hold it by a constraint, "
        "lay something in its way, or give friction where it is pressed",
        body.name, stabilised_motion(body, values), 100.0 * along);
  if (share >= everything)
    return fmt::format(
        "body '{0}' presses on nothing at the end: its stabilisation bears all forces on it, {1:g} "
        "% are allowed. Where there is a gap between it and what it shall lie on, put it where it "
        "touches, or let it move farther in a step by a hundredth of bodies.{0}.integrator."
        "quasi_static.stabilisation.stiffness (0.01 where nothing is said); else hold it against "
        "{2} by a constraint",
        body.name, 100.0 * allowed, stabilised_motion(body, values));
  return fmt::format(
      "body '{0}' is held against {1} by nothing: its stabilisation bears {2:.3g} % of the forces "
      "on it at the end, {3:g} % are allowed. Hold it by a constraint, lay something in its way, "
      "let the load stand for some more steps, or lower stabilisation.stiffness of its integrator "
      "where partners move it far (bodies.{0}.integrator.quasi_static.stabilisation)",
      body.name, stabilised_motion(body, values), 100.0 * share, 100.0 * allowed);
}

std::string sweeps_remedy(std::span<const Description* const> bodies) {
  for (const Description* body : bodies)
    if (body->stabilised)
      return fmt::format(
          "let windows be halved (schwarz.on_nonconvergence: halve), or hold the bodies that "
          "contact alone holds by stiffer springs (bodies.{}.integrator.quasi_static."
          "stabilisation.stiffness)",
          body->name);
  return "raise schwarz.max_iterations or choose another accelerator";
}

std::vector<std::string> validity_notes(const Description& body, std::span<const double> values) {
  std::vector<std::string> notes;
  if (const double left = told(body, values, "inertia.left");  // 0: all of it
      left > 0.0 && (left < inertia_of_all || (left < inertia_of_what_turns &&
                                               told(body, values, "inertia.turned") > has_turned)))
    notes.push_back(fmt::format(
        "'{0}' has {1:.0f} % of its moment of inertia in windows that are not passive, as the mass "
        "of its surface lies further inside there: it turns that much more easily, and is shorter "
        "for waves. Let the port be the side that touches, use a finer mesh, or "
        "bodies.{0}.contact_layer: massive",
        body.name, 100.0 * left));
  const double turned = told(body, values, "rotation.max");
  const double longer = std::hypot(1.0, turned) - 1.0;  // a law of small rotations sees no strain
  if (longer > lengthened) {
    notes.push_back(fmt::format(
        "'{}' has turned by up to {:.2g} rad under a law for small rotations, which lengthens it "
        "there "
        "by {:.3g} %: use a law of finite strain, saint_venant_kirchhoff for instance, or model: "
        "rigid",
        body.name, turned, 100.0 * longer));
  }
  if (told(body, values, "contact.crossings") > 0.0)
    notes.push_back(fmt::format(
        "facets of '{}' have passed through each other on its ports, and what follows is "
        "not to be trusted: bodies are kept off themselves by the passive way alone, "
        "which contact.self, schwarz.on_nonconvergence or a body without a passive "
        "form has kept away",
        body.name));
  if (told(body, values, "stabilisation.at_most") > 0.0)
    notes.push_back(stabilisation_note(body, values));
  const double share = told(body, values, "energy.hourglass_share");
  const double stored = told(body, values, "energy.stored");
  const double all = stored + told(body, values, "energy.kinetic");
  if (share > in_hourglasses && stored > worth_a_look * all) {
    notes.push_back(
        fmt::format("'{}' has {:.2g} % of its stored energy in hourglasses at the end: use a finer "
                    "mesh, or formulation: full or mean_dilatation",
                    body.name, 100.0 * share));
  }
  return notes;
}

}  // namespace abut
