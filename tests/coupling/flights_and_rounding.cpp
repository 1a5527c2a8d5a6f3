// Goal: a body that nothing but rounding disturbs never fails, whatever its numbers: free flight,
// free fall and rest of bodies of any law, element, scheme and size, far from where they began.
// Oracles: uniform motion and free fall; a run that ends as completed without a word of energy.

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/fe/element.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/solids.hpp"

namespace abut::flights_and_rounding_tests {
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

/// A block of three cells each way.
SolidText block(const std::string& element, const std::vector<double>& lengths) {
  return {.name = "it", .block = block_in(element_named(element).dim, lengths, {3, 3, 3}, element)};
}

ResultPtr run(const Flight& f) {
  SolidText it = block(f.element, {f.size, 0.93 * f.size, f.size});
  const int dim = element_named(f.element).dim;
  it.material =
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
  it.integrator = implicit_scheme(f.scheme, f.step());
  it.position = {f.away * f.size, 0.1 * f.away * f.size};
  it.velocity = {f.speed()};
  it.port = "skin";
  it.side = "boundary";
  it.more = fmt::format("    body_force: {}\n", components({0.0, -f.weight()}, dim));
  const SolidText far =
      tool("far", block_in(dim, {1.0, 1.0, 1.0}, {1, 1, 1}), {0.0, -1.0e7 * f.size}, "top");
  return run_solids(f.time(), 5 * f.step(), {it, far}, touching("never", "it.skin", "far.face"));
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
  std::vector<std::string> elements = solid_elements();  // what came later draws last
  std::stable_partition(elements.begin(), elements.end(),
                        [](const std::string& name) { return name != "quad9"; });
  for (const std::string& element : elements) {
    for (const std::string& scheme : schemes) {
      const bool dear = element_named(element).dim == 3 && element_named(element).order > 1;
      for (int k = 0; k < 6; k += dear ? 4 : 1) {
        Flight f{element, laws[static_cast<std::size_t>(k)], scheme, pick(moduli), pick(sizes)};
        // A tenth of a crossing is below the stable step of every element here.
        f.crossings = scheme == "central_difference" ? 0.1 : pick(crossings);
        f.away = pick(far);
        f.flown = pick(far);
        f.fallen = pick(falls);
        // Surfaces without mass lag by the acceleration of a step: beyond yield that is a matter of
        // their own solve, which may find no answer, and not of rounding.
        if (f.law == "j2_plasticity") f.fallen = std::min(f.fallen, 1.0);
        all.push_back(f);
      }
    }
  }
  return all;
}

TEST(Flights, NeverFailByTheirRounding) {
  for (const Flight& f : flights()) {
    SCOPED_TRACE(testing::PrintToString(f));
    const auto end = run(f);
    EXPECT_EQ(end->end.status, "completed");
    for (const RunEvent& event : end->events) {
      const bool of_meshes = event.text.find("moment of inertia") != std::string::npos;
      EXPECT_TRUE(event.kind != RunEvent::Kind::failure &&
                  (event.kind != RunEvent::Kind::warning || of_meshes))
          << event.text;
    }
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

/// Fields are told at the end of every window, which then is a flight of its own: what a body keeps
/// from step to step beside its state, as the factors of a surface without mass, shows in no bit.
TEST(Flights, EndAsTheirWindowsDoOneByOne) {
  for (const char* law : {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean", "hencky"}) {
    for (const char* scheme : {"newmark", "hht_alpha", "central_difference"}) {
      for (const int dim : {2, 3}) {
        SCOPED_TRACE(fmt::format("{} {} {}D", law, scheme, dim));
        SolidText it = block(dim == 2 ? "quad4" : "hex8", {1.0, 0.93, 1.0});
        it.material = unit_law(law, 0.3);
        it.integrator = implicit_scheme(scheme, 0.05);
        it.velocity = {1.0};
        it.field = dim == 2 ? "\"0.1 * y - 0.05 * x * y\", \"-0.1 * x\""
                            : "\"0.1 * y - 0.05 * x * y\", \"-0.1 * x\", \"0.02 * z\"";
        it.port = "skin";
        it.side = "boundary";
        const SolidText far =
            tool("far", block_in(dim, {1.0, 1.0, 1.0}, {1, 1, 1}), {0.0, -1.0e4, 0.0}, "top");
        const auto whole =
            run_solids(3.0, 0.1, {it, far}, touching("never", "it.skin", "far.face"));
        const auto each = run_solids(3.0, 0.1, {it, far}, touching("never", "it.skin", "far.face"),
                                     "output: {fields: {every: 1}}\n");
        ASSERT_TRUE(whole->completed() && each->completed());
        EXPECT_GT(whole->measure("body.it.energy.stored"), 1.0e-6);  // it shakes
        EXPECT_EQ(whole->end.body_hashes, each->end.body_hashes);
      }
    }
  }
}

/// The load is that of the scheme's own mass: of second-order elements, whose lumped and consistent
/// masses have other sums, too. As heavy as it is stiff, the body would be strained by its own
/// size.
TEST(FreeFall, StrainsNothingWhateverTheMass) {
  for (const std::string& element : solid_elements()) {
    for (const char* scheme :
         {"newmark: {mass: lumped, step", "newmark: {mass: averaged, step",
          "newmark: {mass: consistent, step", "hht_alpha: {step", "central_difference: {step"}) {
      SCOPED_TRACE(element + " " + scheme);
      SolidText it = block(element, {1.0, 0.9, 1.0});
      it.material = unit_law("linear_elastic", 0.3);
      it.integrator = fmt::format("{}: 0.02}}", scheme);
      it.more =
          fmt::format("    body_force: {}\n", components({0.0, -1.0}, element_named(element).dim));
      const auto end = run_solids(1.0, 0.1, {it});
      ASSERT_TRUE(end->completed());
      // Strains of 1e-10: what solving leaves of forces of the body's stiffness.
      EXPECT_LT(std::abs(end->measure("body.it.energy.stored")), 1.0e-20);
    }
  }
}

/// Bars that are tied and fly: nothing but the rounding of their places acts in the joint.
TEST(Flights, OfTiedBodiesNeverFailByTheirRounding) {
  for (const char* schemes : {"newmark newmark", "newmark central_difference",
                              "hht_alpha generalized_alpha", "central_difference newmark"}) {
    const std::string both = schemes;
    const std::string first = both.substr(0, both.find(' ')),
                      second = both.substr(first.size() + 1);
    for (const double ratio : {1.0, 2.0, 10.0}) {
      for (const double speed : {0.0, 1.0e-3, 1.0, 1.0e3}) {
        SCOPED_TRACE(fmt::format("{} {} {}", both, ratio, speed));
        const auto bar = [&](const char* name, const std::string& scheme, double step, double place,
                             const char* side) {
          BarText out = unit_bar(name, 0.5, 50, implicit_scheme(scheme, step), place, speed);
          out.sides = {side};
          out.tied = side;
          return out.text();
        };
        const auto end = run_scene(
            4.0, 0.01,
            bar("a", first, 0.005 / ratio, 0.0, "right") + bar("b", second, 0.005, 0.5, "left"),
            "interfaces:\n" + joined("j", "a.right", "b.left"));
        EXPECT_EQ(end->end.status, "completed");
        for (const std::size_t b : {0, 1})
          // A rounding of a place, of 1 m and of the way of 4 s, over the shortest step, 5e-4 s.
          EXPECT_NEAR(end->velocity(b), speed, 1.0e-9 * std::max(speed, 1.0e-3));
      }
    }
  }
}

/// What a tool does on a body is the energy of the body, to round-off: explicit and linear. It is
/// hit within its step, which is the whole window, and hardly moves otherwise than its way tells.
TEST(ToolWork, IsTheEnergyOfWhatItPressesInAnyWindows) {
  for (const double window : {1.0e-5, 2.0e-6}) {
    for (const char* way : {"-1.0 * t", "-1000 * t^2", "-4.0e-4 * sin(4000 * t)"}) {
      SCOPED_TRACE(fmt::format("{} {}", window, way));
      const SolidText block{.name = "block",
                            .material =
                                "linear_elastic: {youngs_modulus: 2.1e11, poissons_ratio: "
                                "0.3, density: 7800.0}",
                            .integrator = "central_difference: {step: 5.0e-7}",
                            .sides = {"top"},
                            .more = "    constraints: {base: {on: bottom, fixed: true}}\n",
                            .block = {{0.1, 0.1}, {8, 8}}};
      const SolidText press = tool("press", {{0.2, 0.02}, {1, 1}}, {-0.05, 0.1003}, "bottom",
                                   fmt::format("way: [\"0\", \"{}\"], ", way));
      const auto end = run_solids(1.0e-3, window, {block, press},
                                  touching("pressed", "block.top", "press.face"));
      EXPECT_EQ(end->end.status, "completed");
      EXPECT_GT(end->measure("contact.pressed.closings"), 0.0);
      const bool on_time = std::string(way) == "-1.0 * t";
      // Sums of some thousand steps of forces and ways; where the tool does not arrive on the end
      // of a step, half of the first force over the part of that step's way that was gone before.
      EXPECT_LT(std::abs(end->measure("energy.total.relative_drift_end")),
                on_time ? 1.0e-10 : 1.0e-4);
    }
  }
}

}  // namespace
}  // namespace abut::flights_and_rounding_tests
