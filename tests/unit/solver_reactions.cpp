// Goal: reactions are the forces that the supports exert. Oracles: the balance of forces in
// statics, the balance of momentum in dynamics, finite elements for bodies in modes.

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solver_reactions_tests {
namespace {

/// A unit square, cube or bar of two cells along each edge, of mass density 1.
struct Part {
  std::string element = "quad4", plane;
  std::string law = "linear_elastic: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}";
  std::string integrator = "quasi_static: {step: 1.0}";
  std::string constraints = {}, loads = {};
  std::string model = "fe", options;  // options of the model, each followed by a comma
  std::string more;                   // keys of the body

  int dim() const { return element_named(element).dim; }
  std::string mesh() const {
    if (dim() == 1) return "bar: {length: 1.0, elements: 2, area: 1.0, grading: 1.5}";
    const std::string ones = dim() == 2 ? "[1.0, 1.0]" : "[1.0, 1.0, 1.0]";
    return fmt::format("{}: {{lengths: {}, elements: {}, element: {}}}",
                       dim() == 2 ? "rectangle" : "box", ones, dim() == 2 ? "[2, 2]" : "[2, 2, 2]",
                       element);
  }
  std::unique_ptr<Subdomain> build() const {
    const std::string text = fmt::format(
        "bodies:\n  part:\n    model: {{{}: {{dimension: {}, {}{}mesh: {{{}}}}}}}\n"
        "    material: {{{}}}\n    integrator: {{{}}}\n    constraints: {{{}}}\n"
        "    loads: {{{}}}\n{}",
        model, dim(), plane.empty() ? "" : "plane: " + plane + ", ", options, mesh(),
        law_in(dim(), law), integrator, constraints, loads, more);
    return make_body(Document::from_text("test", text), "bodies.part");
  }
};

const char* const axis_names[] = {"x", "y", "z"};

/// A list of expressions, one per dimension: along the last axis, or none.
std::string along_y(int dim, const std::string& value) {
  if (dim == 1) return "[\"" + value + "\"]";
  return dim == 2 ? "[\"0\", \"" + value + "\"]" : "[\"0\", \"" + value + "\", \"0\"]";
}

/// The planes that an element is tried in; space and the bar have none.
std::vector<std::string> planes_of(const std::string& element) {
  if (element_named(element).dim != 2) return {""};
  return {"strain", "stress", "axisymmetric"};
}

/// [m^2] of the unit part's top, or end: of a bar its cross section.
double top_of(const std::string& plane) { return plane == "axisymmetric" ? std::numbers::pi : 1.0; }

double told(Subdomain& body, const std::string& name) {
  const std::vector<std::string>& names = body.describe().measures;
  const std::vector<double> values = body.measure();
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return values[k];
  ADD_FAILURE() << "no measure " << name;
  return 0.0;
}

FieldValues field(Subdomain& body, const std::string& name) {
  const std::vector<FieldInfo>& fields = body.describe().fields;
  for (std::size_t k = 0; k < fields.size(); ++k)
    if (fields[k].name == name) return body.fields()[k];
  ADD_FAILURE() << "no field " << name;
  return {};
}

/// Advances by one window; the last record.
BodyRecord advance(Subdomain& body, double begin, double end) {
  Response response;
  const Advance request = free_request(body, begin, end);
  const Outcome outcome = body.advance(request, response);
  EXPECT_TRUE(std::holds_alternative<Advanced>(outcome));
  return response.records.empty() ? BodyRecord{} : response.records.back();
}

/// The laws at finite strain, and the linear one.
const std::vector<std::string> laws = {
    "linear_elastic: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}",
    "neo_hookean: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}",
    "j2_plasticity: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0, yield_stress: 0.02, "
    "hardening: 0.1}"};

TEST(Reactions, OfAClampAreTheLoadInEveryElementPlaneAndLaw) {
  for (const std::string& element : fe_elements()) {
    for (const std::string& plane : planes_of(element)) {
      for (const std::string& law : laws) {
        SCOPED_TRACE(element + " " + plane + " " + law);
        Part part;
        part.element = element;
        part.plane = plane;
        part.law = law;
        const int dim = part.dim();
        const bool flat = dim > 1;
        part.constraints = fmt::format("clamp: {{on: {}, fixed: true}}", flat ? "bottom" : "left");
        part.loads = fmt::format("top: {{on: {}, traction: {}}}, weight: {{acceleration: {}}}",
                                 flat ? "top" : "right", along_y(dim, "0.03 * t"),
                                 along_y(dim, "-0.01 * t"));
        const std::unique_ptr<Subdomain> body = part.build();
        const BodyRecord record = advance(*body, 0.0, 1.0);
        const double load = top_of(plane) * (0.03 - 0.01);
        const std::size_t loaded = flat ? 1 : 0;
        ASSERT_EQ(record.columns.size(), index(dim));
        for (std::size_t i = 0; i < record.columns.size(); ++i) {
          if (plane == "axisymmetric" && i == 0) continue;  // hoop stress has a part in it
          // Newton's method leaves 1e-9 of the forces' norm; these are a few times the load.
          EXPECT_NEAR(record.columns[i], i == loaded ? -load : 0.0, 1.0e-8 * load) << i;
          EXPECT_EQ(told(*body, fmt::format("clamp.reaction.{}", axis_names[i])),
                    record.columns[i]);
          EXPECT_EQ(told(*body, fmt::format("reaction.{}", axis_names[i])), record.columns[i]);
        }
        const FieldValues nodal = field(*body, "reaction");
        for (std::size_t i = 0; i < 3; ++i) {
          double sum = 0.0;
          for (std::size_t k = i; k < nodal.size(); k += 3) sum += nodal[k];
          const double column = i < record.columns.size() ? record.columns[i] : 0.0;
          EXPECT_NEAR(sum, column, roundoff(1.0e3, load));
        }
      }
    }
  }
}

TEST(Reactions, AreNamedByConstraintAndAxisAndMeetOnlyOnce) {
  Part part;
  part.constraints = "floor: {on: bottom, y: \"0\"}, wall: {on: left, fixed: true}";
  part.loads = "lid: {on: top, pressure: \"0.1\"}, push: {on: right, pressure: \"0.2\"}";
  const std::unique_ptr<Subdomain> body = part.build();
  EXPECT_EQ(body->describe().columns,
            (std::vector<std::string>{"floor.reaction_x [N]", "floor.reaction_y [N]",
                                      "wall.reaction_x [N]", "wall.reaction_y [N]"}));
  const BodyRecord record = advance(*body, 0.0, 1.0);
  // The corner belongs to the floor in y and to the wall in x; the sum has every node once.
  const double bound = roundoff(1.0e4, 0.2);
  EXPECT_EQ(record.columns[0], 0.0);
  EXPECT_NEAR(record.columns[2], 0.2, bound);
  EXPECT_NEAR(record.columns[1] + record.columns[3], 0.1, bound);
  EXPECT_NEAR(told(*body, "reaction.y"), 0.1, bound);
  EXPECT_NEAR(told(*body, "reaction.x"), 0.2, bound);
}

TEST(Reactions, OfAnInclinedRollerAreAlongItsDirection) {
  for (const char* law : {laws[0].c_str(), laws[1].c_str()}) {
    Part part;
    part.law = law;
    part.constraints = "floor: {on: bottom, fixed: true}, ramp: {on: top, direction: [1.0, 2.0]}";
    part.loads = "push: {on: right, traction: [\"-0.1\", \"0.02\"]}";
    const std::unique_ptr<Subdomain> body = part.build();
    const BodyRecord record = advance(*body, 0.0, 1.0);
    const std::vector<double>& r = record.columns;
    EXPECT_GT(r[2], 1.0e-3);
    EXPECT_NEAR(r[3], 2.0 * r[2], roundoff(100.0, r[2]));
    EXPECT_NEAR(r[0] + r[2], 0.1, 1.0e-9);  // Newton's tolerance
    EXPECT_NEAR(r[1] + r[3], -0.02, 1.0e-9);
  }
}

TEST(Reactions, OfAMovedSideArePushAndPullOfTheClosedForm) {
  // A bar of uniform strain e under neo-Hookean uniaxial stress is met in solids_bar.cpp: here the
  // two ends of any law pull equally, and the linear one by E A e.
  for (const std::string& law : laws) {
    Part part;
    part.element = "bar2";
    part.law = law;
    part.constraints = "wall: {on: left, fixed: true}, pull: {on: right, x: \"0.01 * t\"}";
    const std::unique_ptr<Subdomain> body = part.build();
    const BodyRecord record = advance(*body, 0.0, 1.0);
    EXPECT_EQ(body->describe().columns,
              (std::vector<std::string>{"wall.reaction [N]", "pull.reaction [N]"}));
    EXPECT_NEAR(record.columns[0] + record.columns[1], 0.0, 1.0e-10);  // Newton's tolerance
    if (law == laws[0]) {
      EXPECT_NEAR(record.columns[1], 0.01, roundoff(100.0, 0.01));
    }
    EXPECT_NEAR(told(*body, "reaction.x"), 0.0, 1.0e-10);  // Newton's tolerance
  }
}

TEST(Reactions, ComeBackBitForBit) {
  Part part;
  part.constraints = "clamp: {on: bottom, fixed: true}";
  part.loads = "top: {on: top, traction: [\"0\", \"sin(t)\"]}";
  part.integrator = "newmark: {step: 0.1}";
  const std::unique_ptr<Subdomain> body = part.build();
  advance(*body, 0.0, 1.0);
  body->save();
  const BodyRecord first = advance(*body, 1.0, 2.0);
  const std::vector<double> measured = body->measure();
  body->restore();
  const BodyRecord second = advance(*body, 1.0, 2.0);
  EXPECT_EQ(first.columns, second.columns);
  EXPECT_EQ(measured, body->measure());
}

// ---- in motion

/// Supports at rest and moved ones, under a load that changes.
Part driven(const std::string& element, const std::string& plane, bool moved) {
  Part part;
  part.element = element;
  part.plane = plane;
  const bool flat = part.dim() > 1;
  const std::string move = moved ? "0.02 * t^2" : "0";
  part.constraints = fmt::format("floor: {{on: {}, {}: \"{}\"}}", flat ? "bottom" : "left",
                                 flat ? "y" : "x", move);
  if (part.dim() == 2) part.constraints += ", wall: {on: left, x: \"0\"}";
  if (part.dim() == 3)
    part.constraints += ", wall: {on: left, x: \"0\"}, back: {on: back, z: \"0\"}";
  part.loads = fmt::format("top: {{on: {}, traction: {}}}", flat ? "top" : "right",
                           along_y(part.dim(), "0.1 * sin(3 * t)"));
  return part;
}

/// Largest imbalance of momentum along the load over the steps of a run to time 1: the change over
/// a step [N] less the mean of reactions and loads at its ends. Without the first step, in which
/// the momentum of moved supports under central differences goes from the begin to a half step, and
/// without what is before a time [s].
double imbalance(Part part, const std::string& integrator, int steps, double from = 0.0) {
  const double dt = 1.0 / steps;
  part.integrator = fmt::format(fmt::runtime(integrator), number(dt));
  const std::unique_ptr<Subdomain> body = part.build();
  const std::size_t axis = part.dim() == 1 ? 0 : 1, dim = index(part.dim());
  const auto force = [&](const BodyRecord& record) {
    double sum = top_of(part.plane) * 0.1 * std::sin(3.0 * record.time);
    for (std::size_t k = axis; k < record.columns.size(); k += dim) sum += record.columns[k];
    return sum;
  };
  BodyRecord before = advance(*body, 0.0, 0.0);
  double most = 0.0;
  for (int k = 0; k < steps; ++k) {
    const BodyRecord now = advance(*body, k * dt, (k + 1) * dt);
    const double rate = (now.momentum[axis] - before.momentum[axis]) / dt;
    if (k > 0 && before.time >= from)
      most = std::max(most, std::abs(rate - 0.5 * (force(before) + force(now))));
    before = now;
  }
  return most;
}

TEST(ReactionsInMotion, AreTheChangeOfMomentumLessTheLoadToRoundOff) {
  for (const std::string& element : fe_elements()) {
    for (const std::string& plane : planes_of(element)) {
      for (const bool moved : {false, true}) {
        for (const char* integrator :
             {"newmark: {{step: {}}}", "newmark: {{step: {}, mass: lumped}}",
              "central_difference: {{step: {}}}"}) {
          for (const std::string& law : laws) {
            SCOPED_TRACE(element + " " + plane + " " + integrator + (moved ? " moved " : " ") +
                         law);
            Part part = driven(element, plane, moved);
            part.law = law;
            // Solves end at 1e-9 of the forces that they balance, of the order of the load: 0.1.
            EXPECT_LT(imbalance(part, integrator, 64), 1.0e-9 * top_of(plane));
          }
        }
      }
    }
  }
}

TEST(ReactionsInMotion, OfDampedSchemesAreSoToSecondOrder) {
  for (const std::string& element : fe_elements()) {
    for (const std::string& plane : planes_of(element)) {
      for (const bool moved : {false, true}) {
        for (const char* integrator : {"hht_alpha: {{step: {}, alpha: -0.1}}",
                                       "generalized_alpha: {{step: {}, spectral_radius: 0.8}}"}) {
          SCOPED_TRACE(element + " " + plane + " " + integrator + (moved ? " moved" : ""));
          const Part part = driven(element, plane, moved);
          // The accelerations of the start do not lag, those of later steps do: the difference
          // fades by a half in every step, and is gone after a third of the run.
          const double coarse = imbalance(part, integrator, 64, 0.3),
                       fine = imbalance(part, integrator, 128, 0.3);
          EXPECT_LT(coarse, 2.0e-3 * top_of(plane));  // of forces of 0.1
          // Second order; terms of third order and a part of a step in the first time looked at.
          EXPECT_GT(observed_order(coarse, fine), 1.7);
        }
      }
    }
  }
}

TEST(ReactionsInMotion, OfASideWhoseExpressionBeginsWithTheRunAreFiniteAtOnce) {
  for (const char* integrator :
       {"newmark: {step: 0.01}", "hht_alpha: {step: 0.01}", "generalized_alpha: {step: 0.01}",
        "central_difference: {step: 0.01}", "quasi_static: {step: 0.01}"}) {
    Part part;
    part.element = "bar2";
    part.integrator = integrator;
    part.constraints =
        "wall: {on: left, fixed: true}, pull: {on: right, x: \"0.1 * t^2 * sqrt(t)\"}";
    const std::unique_ptr<Subdomain> body = part.build();
    // Half of the last element of the two moves with the end, which starts without acceleration.
    EXPECT_NEAR(advance(*body, 0.0, 0.0).columns[1], 0.0, 0.02) << integrator;
    EXPECT_TRUE(std::isfinite(advance(*body, 0.0, 0.5).columns[1])) << integrator;
  }
}

TEST(ReactionsInMotion, OfAnAcceleratedSideDoNotAlternate) {
  // Newmark 1/4, 1/2 carries a wrong acceleration of the start on for ever, with changing sign:
  // here 0.04 m/s^2 times the mass of a node, 0.3 kg, which changes by four times that over two
  // steps.
  for (const char* mass : {"lumped", "consistent"}) {
    Part part = driven("bar2", "", true);
    constexpr double dt = 1.0 / 64.0;
    part.integrator = fmt::format("newmark: {{step: {}, mass: {}}}", number(dt), mass);
    const std::unique_ptr<Subdomain> body = part.build();
    std::vector<double> force = {advance(*body, 0.0, 0.0).columns[0]};
    for (int k = 0; k < 64; ++k) force.push_back(advance(*body, k * dt, (k + 1) * dt).columns[0]);
    for (std::size_t k = 2; k < force.size(); ++k) {
      const double bend = force[k] - 2.0 * force[k - 1] + force[k - 2];
      // The force itself, 0.1 N at 3 rad/s and waves of some 4 rad/s that it makes, bends by
      // 0.1 (4 dt)^2 = 4e-4 N.
      EXPECT_LT(std::abs(bend), 1.0e-3) << mass << " step " << k;
    }
  }
}

TEST(ReactionsInMotion, OfBodiesInModesBalanceHoweverFewModes) {
  for (const char* element : {"bar2", "quad4", "tri6", "hex8"}) {
    for (const char* modes : {"modes: 1, ", "modes: 2, "}) {
      for (const char* integrator : {"newmark: {{step: {}}}", "central_difference: {{step: {}}}"}) {
        SCOPED_TRACE(std::string(element) + " " + modes + integrator);
        Part part = driven(element, "", false);
        part.model = "modal";
        part.options = modes;
        EXPECT_LT(imbalance(part, integrator, 64), 1.0e-9);  // as of finite elements
      }
    }
  }
}

TEST(Reactions, OfBodiesInModesAreThoseOfFiniteElementsInStatics) {
  for (const char* element : {"bar2", "quad4", "tri6", "hex8"}) {
    for (const bool inclined : {false, true}) {
      Part fe = driven(element, "", false);
      if (inclined && fe.dim() != 2) continue;
      if (inclined)
        fe.constraints = "floor: {on: bottom, fixed: true}, ramp: {on: top, direction: [1.0, 2.0]}";
      fe.integrator = "quasi_static: {step: 1.0}";
      Part modal = fe;
      modal.model = "modal";
      modal.options = "modes: 1, ";
      const std::unique_ptr<Subdomain> a = fe.build(), b = modal.build();
      const BodyRecord one = advance(*a, 0.0, 1.0), other = advance(*b, 0.0, 1.0);
      EXPECT_GT(largest_size(one.columns), 1.0e-3);
      // Round-off of two solves; few modes do not matter.
      EXPECT_LT(largest_difference(one.columns, other.columns), 1.0e-12) << element;
      EXPECT_LT(largest_difference(field(*a, "reaction"), field(*b, "reaction")), 1.0e-12);
    }
  }
}

TEST(ReactionsInMotion, OfAllModesAreThoseOfFiniteElements) {
  for (const char* integrator :
       {"newmark: {step: 0.05}", "hht_alpha: {step: 0.05, alpha: -0.1}",
        "generalized_alpha: {step: 0.05}", "central_difference: {step: 0.02}"}) {
    Part fe = driven("quad4", "", false);
    fe.integrator = integrator;
    Part modal = fe;
    modal.model = "modal";
    modal.options = "modes: 12, ";  // 18 coordinates less three on each of two sides
    const std::unique_ptr<Subdomain> a = fe.build(), b = modal.build();
    const BodyRecord one = advance(*a, 0.0, 1.0), other = advance(*b, 0.0, 1.0);
    EXPECT_GT(largest_size(one.columns), 0.01);
    const double steps = 1.0e-12 * 50.0;  // each as in statics
    EXPECT_LT(largest_difference(one.columns, other.columns), steps) << integrator;
    EXPECT_LT(largest_difference(field(*a, "reaction"), field(*b, "reaction")), steps);
  }
}

TEST(ReactionsInMotion, OfARollerInModesBalanceWhileTheBodySlides) {
  Part part;
  part.model = "modal";
  part.options = "modes: 2, ";
  part.constraints = "floor: {on: bottom, y: \"0\"}";
  part.loads = "top: {on: top, traction: [\"0.05\", \"0.1 * sin(3 * t)\"]}";
  EXPECT_LT(imbalance(part, "newmark: {{step: {}}}", 64), 1.0e-9);  // as of finite elements
}

TEST(ReactionsInMotion, OfAPortUnderForceHoldAgainstIt) {
  for (const char* model : {"fe", "modal"}) {
    Part part;
    part.model = model;
    if (part.model == "modal") part.options = "modes: 1, ";
    part.constraints = "clamp: {on: bottom, fixed: true}";
    part.more = "    ports: {lid: {side: top}}\n";
    const std::unique_ptr<Subdomain> body = part.build();
    Advance request = free_request(*body, 0.0, 1.0);
    Waveform& push = request.boundary[0].forces.emplace_back();
    push.width = 6;  // three nodes
    push.time = {0.0, 1.0};
    push.f = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.1, 0.0, -0.2, 0.0, -0.1};
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
    const double solved = roundoff(1000.0, 0.4);  // a solve of some coordinates
    EXPECT_NEAR(response.records[0].columns[1], 0.4, solved) << model;
    EXPECT_NEAR(response.records[0].columns[0], 0.0, solved);
  }
}

/// What stands for the size of a port's facets is that of the mesh, whatever its bodies have across
/// the plane: how near something is seen depends on it.
TEST(Ports, HaveTheSpacingOfTheMeshInAllPlanes) {
  for (const std::string& plane : planes_of("quad4")) {
    for (const char* thickness : {"", "thickness: 1.0e-3, ", "thickness: 50.0, "}) {
      if (plane == "axisymmetric" && *thickness != '\0') continue;  // it has none
      SCOPED_TRACE(plane + " " + thickness);
      const auto part = Part{.plane = plane,
                             .integrator = "newmark: {step: 0.1}",
                             .options = thickness,
                             .more = "    ports: {top: {side: top}, right: {side: right}}\n"}
                            .build();
      for (const auto& port : part->describe().ports)
        EXPECT_NEAR(port.geometry.spacing, 0.5, roundoff(20.0, 0.5)) << port.name;
    }
  }
}

}  // namespace
}  // namespace abut::solver_reactions_tests
