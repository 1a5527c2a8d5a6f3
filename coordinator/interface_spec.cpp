#include "coordinator/interface_spec.hpp"

#include <charconv>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace abut {

namespace {

/// Coulomb's coefficient of what is called rough, and the largest: with more, what friction lifts
/// may lift what presses, and there are no forces that fit.
constexpr double rough_friction = 10.0;

/// The keys of a friction law.
void friction_keys(Fields& f, FrictionLaw& law) {
  double& friction = law.kinetic_friction;
  std::optional<double> static_friction;  // absent: the same
  if (law.jumps()) static_friction = law.static_friction;
  std::string text = friction == rough_friction ? "rough" : fmt::format("{}", friction);
  f.optional(
      "friction", text, "",
      "of surfaces, Coulomb's coefficient: forces along the surface are at most this part of "
      "the pressing ones; rough: nothing slips while it presses");
  f.optional("static_friction", static_friction, "",
             "of surfaces, the coefficient while nothing slides; usual: that of friction");
  if (f.purpose() != Fields::Purpose::read) return;
  const char* end = text.data() + text.size();
  const std::from_chars_result parsed = std::from_chars(text.data(), end, friction);
  const bool whole = parsed.ec == std::errc() && parsed.ptr == end;
  if (text == "rough") friction = rough_friction;
  f.check(text == "rough" || (whole && friction >= 0.0 && friction <= rough_friction), "friction",
          fmt::format("is {}, which is no coefficient of friction", text),
          fmt::format("Give a number from 0 to {:g}, or rough.", rough_friction));
  f.check(!static_friction || (*static_friction >= friction && *static_friction <= rough_friction),
          "static_friction",
          fmt::format("is {}, below friction, {}, or above {:g}", static_friction.value_or(0.0),
                      friction, rough_friction),
          "What sticks holds at least as much as what slides: give both, or leave it out.");
  law.static_friction = static_friction.value_or(friction);
}

}  // namespace

void ContactSpec::fields(Fields& f) {
  f.word(
      "rows", points, {"mortar", "point_to_surface"},
      "of surfaces, where their gaps are held: on the average over a node's surroundings, or, for "
      "comparisons, at each node of the side that finds contact, which no constant pressure "
      "passes");
  friction_keys(f, friction);
  f.optional("restitution", restitution, "",
             "part of the speed at which rigid bodies meet that they part with: from 0, which is "
             "usual, to 1, which keeps the energy; what deforms bounces by itself",
             between(0.0, 1.0));
}

void OverlapSpec::fields(Fields& f) {
  f.word("material", doubled, {"halves", "doubled"},
         "of which the bodies have halves each where both are, or, for comparisons, all of it "
         "each, which reflects waves");
  f.word(
      "exchange", motions, {"forces", "motions"},
      "what bodies tell each other: forces, which act on both, so that energy is kept; or motions "
      "alone, as in alternating Schwarz with Dirichlet data: all of the material in each body, "
      "and each side moved as the other body moves there, which is for statics and for meshes "
      "whose nodes meet");
  f.word("answer", alternating, {"together", "alternating"},
         "of motions alone, how they are found: for both bodies at once, or, for comparisons, for "
         "each as if the other one stood still, as published: sweeps are its iterations, to which "
         "schwarz.accelerator applies");
  f.optional("unstable", unstable, "",
             "of motions alone, for comparisons: runs bodies with inertia whose nodes do not meet, "
             "which gain energy by themselves");
  f.idle(motions, "material", "bodies that exchange motions alone have all of it each");
  f.idle(!motions, "answer", "forces are found for both bodies at once");
  f.idle(!motions, "unstable", "bodies that exchange forces keep their energy");
}

void TiedSpec::fields(Fields& f) {
  f.word("steps", finer, {"coarser", "finer"},
         "of surfaces, in whose steps the force between them is constant: of the side with coarser "
         "ones, or, for comparisons, of the other, which keeps energy and moves wrongly");
  f.optional_section("overlap", overlap,
                     "of surfaces of bodies that take the same place: each side is inside the "
                     "other body, and moves as that one does there");
}

void SceneContactSpec::fields(Fields& f) {
  f.optional_section(
      "everything", everything,
      "law of contact between all surfaces (ports) of different bodies, but for pairs that "
      "have an interface and bodies that ties hold together; a port that is part of another one, "
      "as a tied side is of boundary, touches as that one; measures name it contact.everything");
  f.optional(
      "self", self, "",
      "contact of bodies with themselves, on each port of theirs that has facets and between "
      "those that have no node in common, where strains are finite: windows in which a "
      "surface comes upon itself are gone passively");
  f.optional("self_friction", self_friction, "",
             "Coulomb's coefficient of bodies on themselves; usual: that of everything, or 0",
             between(0.0, rough_friction));
  f.idle(!self, "self_friction", "bodies do not touch themselves");
}

void InterfaceSpec::fields(Fields& f) {
  f.required("sides", sides, "", "two ports that meet, as body.port");
  f.optional_section("contact", contact, "contact between the sides");
  f.choice("transmission", transmission, "rule that couples the sides while they are closed",
           Presence::optional);
  f.optional_section("tied", tied, "sides that are one from the start and never part");
  f.check(contact.has_value() || tied.has_value(), "contact", "is missing",
          "Write contact: {}, or tied: {} where the sides are joined from the start.");
  f.check(!contact || !tied, "tied", "stands beside contact",
          "Keep one of the two: tied sides never part.");
  f.idle(tied.has_value(), "transmission.dirichlet_neumann.impact_projection",
         "tied sides never hit each other");
  f.idle(tied.has_value(), "transmission.unilateral.kernel_memory", "tied sides need no kernel");
}

}  // namespace abut
