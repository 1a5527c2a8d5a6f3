// Goal: a body that nothing but rounding disturbs never fails, whatever its numbers: free flight,
// free fall and rest of bodies of any law, element, scheme and size, far from where they began.
// Oracles: uniform motion and free fall; a run that ends as completed without a word of energy.

#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/fe/element.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/solids.hpp"

namespace abut {
namespace {

constexpr int steps = 60;

struct Flight {
  std::string element, law, scheme;
  double youngs = 1.0;                           // [Pa]
  double size = 1.0;                             // [m] of the body
  double crossings = 1.0;                        // of a cell, by waves in a step
  double away = 0.0, flown = 0.0, fallen = 0.0;  // sizes; from the origin, and in the whole flight
  double density() const { return 1000.0; }
  double poisson() const { return 0.3; }
  double step() const {  // [s]
    const double p_wave =
        youngs * (1.0 - poisson()) / ((1.0 + poisson()) * (1.0 - 2.0 * poisson()));
    return crossings * 0.3 * size / std::sqrt(p_wave / density());
  }
  double time() const { return steps * step(); }
  double speed() const { return flown * size / time(); }                     // [m/s]
  double weight() const { return 2.0 * fallen * size / (time() * time()); }  // [m/s^2]
};

std::ostream& operator<<(std::ostream& out, const Flight& f) {
  return out << fmt::format(
             "{} {} {} E {:g} size {:g} crossings {:g} away {:g} flown {:g} fallen {:g}", f.element,
             f.law, f.scheme, f.youngs, f.size, f.crossings, f.away, f.flown, f.fallen);
}

std::string text(const Flight& f) {
  const bool space = element_named(f.element).dim == 3;
  const std::string law =
      f.law == "mooney_rivlin"
          ? fmt::format("mooney_rivlin: {{c10: {}, c01: {}, bulk_modulus: {}, density: {}}}",
                        number(0.15 * f.youngs), number(0.05 * f.youngs), number(f.youngs),
                        number(f.density()))
          : fmt::format("{}: {{youngs_modulus: {}, poissons_ratio: {}, density: {}{}}}", f.law,
                        number(f.youngs), number(f.poisson()), number(f.density()),
                        f.law == "j2_plasticity"
                            ? fmt::format(", yield_stress: {}, hardening: {}",
                                          number(1.0e-3 * f.youngs), number(1.0e-2 * f.youngs))
                            : "");
  const double third = f.size * 0.93;
  const std::string mesh =
      space ? fmt::format("box: {{lengths: [{0}, {1}, {0}], elements: [3, 3, 3], element: {2}}}",
                          number(f.size), number(third), f.element)
            : fmt::format("rectangle: {{lengths: [{}, {}], elements: [3, 3], element: {}}}",
                          number(f.size), number(third), f.element);
  const std::string back = space ? ", 0.0" : "";
  const double dt = f.step();
  return fmt::format(
      "meta: {{title: test}}\ntime: {{begin: 0.0, end: {}, window: {}}}\nbodies:\n"
      "  it: {{model: {{fe: {{dimension: {}, mesh: {{{}}}}}}}, material: {{{}}}, integrator: "
      "{{{}: {{step: {}}}}}, body_force: [0.0, {}{}], initial: {{position: [{}, {}{}], velocity: "
      "[{}, 0.0{}]}}, ports: {{skin: {{side: boundary}}}}}}\n"
      "  far: {{model: {{rigid_tool: {{dimension: {}, mesh: {}}}}}, initial: {{position: [0.0, "
      "{}{}]}}, ports: {{top: {{side: top}}}}}}\n"
      "interfaces: {{never: {{sides: [it.skin, far.top], contact: {{}}}}}}\n",
      number(f.time()), number(5 * dt), space ? 3 : 2, mesh, law, f.scheme, number(dt),
      number(-f.weight()), back, number(f.away * f.size), number(0.1 * f.away * f.size), back,
      number(f.speed()), back, space ? 3 : 2,
      space ? "{box: {lengths: [1.0, 1.0, 1.0], elements: [1, 1, 1]}}"
            : "{rectangle: {lengths: [1.0, 1.0], elements: [1, 1]}}",
      number(-1.0e7 * f.size), back);
}

std::vector<Flight> flights() {
  std::mt19937_64 engine(11);
  const auto pick = [&engine](const auto& list) { return list[engine() % list.size()]; };
  const std::vector<std::string> laws = {"linear_elastic", "saint_venant_kirchhoff",
                                         "neo_hookean",    "hencky",
                                         "mooney_rivlin",  "j2_plasticity"};
  const std::vector<std::string> schemes = {"newmark", "hht_alpha", "generalized_alpha",
                                            "central_difference"};
  const std::vector<double> moduli = {1.0e3, 1.0e6, 2.1e11}, sizes = {1.0e-3, 1.0, 30.0},
                            far = {0.0, 1.0, 1.0e3}, crossings = {0.5, 3.0, 50.0},
                            falls = {0.0, 1.0, 30.0};  // 5 % of a cell per square of a step
  std::vector<Flight> all;
  for (const std::string& element : solid_elements()) {
    for (const std::string& scheme : schemes) {
      const bool dear = element_named(element).dim == 3 && element_named(element).order > 1;
      for (int k = 0; k < 6; k += dear ? 4 : 1) {
        Flight f{element, laws[static_cast<std::size_t>(k)], scheme, pick(moduli), pick(sizes)};
        // A tenth of a crossing is below the stable step of every element here.
        f.crossings = scheme == "central_difference" ? 0.1 : pick(crossings);
        f.away = pick(far);
        f.flown = pick(far);
        f.fallen = pick(falls);
        all.push_back(f);
      }
    }
  }
  return all;
}

TEST(Flights, NeverFailByTheirRounding) {
  for (const Flight& f : flights()) {
    SCOPED_TRACE(testing::PrintToString(f));
    const auto end = run_document(Document::from_text("test", text(f)));
    EXPECT_EQ(end->end.status, "completed");
    for (const RunEvent& event : end->events)
      EXPECT_TRUE(event.kind != RunEvent::Kind::failure && event.kind != RunEvent::Kind::warning)
          << event.text;
    if (!end->completed()) continue;
    // Velocities are rounded in each step by what places are, over the step; 16 such in the sums
    // of a step, and as many in a row as chance lets add up. Implicit steps end when forces are
    // balanced to their rounding, that of places times the stiffness: the square of the crossings.
    const double farthest = f.size * (1.0 + f.away + f.flown + f.fallen);
    const double balanced = std::max(1.0, 4.0 * f.crossings * f.crossings);
    const double rounded = 16.0 * std::sqrt(steps) * 2.2e-16 * balanced * farthest / f.step();
    EXPECT_NEAR(end->velocity(0), f.speed(), rounded);
  }
}

}  // namespace
}  // namespace abut
