// Goal: a bar by the model of solids, of any law, spacing and scheme, meets a surface as the bars'
// own core does: it never pulls, never passes through it, and what it gives is what it loses.
// Oracles: the bars' own core, whose contact element has the stiffness of the mesh;
// complementarity; balance of momentum; work of the surface.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/solid_texts.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_layer_tests {
namespace {

struct Layered {
  std::string name, law, integrator;
  double grading = 0.7;
  friend std::ostream& operator<<(std::ostream& out, const Layered& l) { return out << l.name; }
};

const std::string elastic = "youngs_modulus: 1.0, density: 1.0";

/// Of a bar of 20 elements, length 20, E A = rho A = 1: the smallest element of the graded one is
/// 0.85 long.
constexpr int elements = 20;
constexpr double step = 0.5, speed = 0.02;

std::vector<std::string> schemes() {
  std::vector<std::string> all = {fmt::format("central_difference: {{step: {}}}", step)};
  for (const char* mass : {"lumped", "averaged", "consistent"}) {
    for (const char* scheme : {"newmark", "hht_alpha", "generalized_alpha"})
      all.push_back(fmt::format("{}: {{step: {}, mass: {}}}", scheme, step, mass));
  }
  return all;
}

std::string label(const std::string& scheme) {
  const std::string name = scheme.substr(0, scheme.find(':'));
  const std::size_t mass = scheme.find("mass: ");
  if (mass == std::string::npos) return name;
  return name + "_" + scheme.substr(mass + 6, scheme.size() - mass - 7);
}

std::vector<Layered> all_layered() {
  const std::string solid = elastic + ", poissons_ratio: 0.3";
  std::vector<Layered> all;
  for (const std::string& scheme : schemes()) {
    const auto add = [&](const char* name, const std::string& law, double grading = 0.7) {
      all.push_back({fmt::format("{}_{}", name, label(scheme)), law, scheme, grading});
    };
    add("equal", "linear_elastic: {" + elastic + "}", 1.0);
    add("graded", "linear_elastic: {" + elastic + "}");
    add("saint_venant_kirchhoff", "saint_venant_kirchhoff: {" + solid + "}");
    add("neo_hookean", "neo_hookean: {" + solid + "}");
    add("hencky", "hencky: {" + solid + "}");
    add("mooney_rivlin", "mooney_rivlin: {c10: 0.15, c01: 0.05, bulk_modulus: 1.0, density: 1.0}");
    add("j2_plasticity", "j2_plasticity: {" + solid + ", yield_stress: 0.01, hardening: 0.1}");
  }
  return all;
}

/// By the model of solids: a mesh that is graded, if only by a rounding.
std::unique_ptr<Subdomain> build_layered(const Layered& l, const std::string& ports,
                                         double velocity) {
  const double grading = l.grading == 1.0 ? 1.0 + 0x1p-52 : l.grading;
  SolidText it{.name = "it", .dim = 1, .material = l.law, .integrator = l.integrator};
  it.mesh = fmt::format("bar: {{length: {0}, elements: {0}, area: 1.0, grading: {1}}}", elements,
                        number(grading));
  if (velocity != 0.0) it.velocity = {velocity};
  it.more = "    ports: {" + ports + "}\n";
  return build(it);
}

const std::string both = "left: {side: left}, right: {side: right}";

class LayeredBar : public testing::TestWithParam<Layered> {};
INSTANTIATE_TEST_SUITE_P(Solver, LayeredBar, testing::ValuesIn(all_layered()),
                         [](const auto& m) { return m.param.name; });

/// A surface that comes in from `away` of the port, pushes it by `depth` and goes back.
Obstacle passing_surface(const Subdomain& body, std::size_t port, const std::vector<double>& times,
                         double period, double away, double depth) {
  Obstacle obstacle;
  for (const double t : times) {
    const double in = 0.5 * (1.0 - std::cos(2.0 * M_PI * t / period));
    obstacle.motion.time.push_back(t);
    obstacle.motion.u.push_back(outward(body, port) * (away - (away + depth) * in));
  }
  return obstacle;
}

struct History {
  std::vector<double> u, f, surface;  // of one port, at all substeps
  double work = 0.0;                  // [J] of the surface
};

/// Windows of seven substeps, the last one shorter, in which a surface pushes every port and
/// leaves.
std::vector<History> push(Subdomain& body, double depth, BodyRecord& end) {
  constexpr double period = 60.0, window = 6.7 * step;
  const std::size_t ports = body.describe().ports.size();
  for (std::size_t p = 0; p < ports; ++p) meet_point(body, p, false);
  std::vector<History> told(ports);
  Response response;
  for (int w = 0; w * window < 1.3 * period; ++w) {
    const double from = w * window, to = (w + 1) * window;
    const std::vector<double> times = substep_times(from, to, step);
    Advance request = free_request(body, from, to);
    request.window.index = w;
    for (std::size_t p = 0; p < ports; ++p)
      request.boundary[p].obstacles = {
          passing_surface(body, p, times, period, 0.01, depth * (p == 0 ? 1.0 : 0.7))};
    body.save();
    abut::step(body, request, response);
    for (std::size_t p = 0; p < ports; ++p) {
      const double n = outward(body, p);
      const std::vector<double>& f = response.ports[p].reactions[0].force.f;
      const std::vector<double>& y = request.boundary[p].obstacles[0].motion.u;
      for (std::size_t i = w == 0 ? 0 : 1; i < f.size(); ++i) {
        told[p].u.push_back(n * response.ports[p].trace.u[i]);
        told[p].f.push_back(n * f[i]);
        told[p].surface.push_back(n * y[i]);
        if (i > 0) told[p].work -= 0.5 * (f[i] + f[i - 1]) * (y[i] - y[i - 1]);
      }
    }
  }
  end = response.records.back();
  return told;
}

TEST_P(LayeredBar, NeitherPullsNorPassesThroughASurface) {
  const std::unique_ptr<Subdomain> body = build_layered(GetParam(), both, 0.0);
  ASSERT_TRUE(body->describe().can.obstacle);
  BodyRecord end;
  for (const History& port : push(*body, 0.3, end)) {
    double most = 0.0;
    for (std::size_t i = 1; i < port.f.size(); ++i) {
      most = std::max(most, port.f[i]);
      EXPECT_GE(port.f[i], 0.0);
      // Newton's method leaves 1e-9 of a force of 0.05, where 1 N makes 1 m.
      EXPECT_LT(port.u[i] - port.surface[i], 1.0e-9) << i;
      EXPECT_LT(port.f[i] * std::abs(port.u[i] - port.surface[i]), 1.0e-10)
          << i;  // that times the force
    }
    EXPECT_GT(most, 5.0e-3);
  }
}

TEST_P(LayeredBar, GivesTheMomentumAndTheEnergyThatItLoses) {
  const std::unique_ptr<Subdomain> body = build_layered(GetParam(), "right: {side: right}", 0.0);
  BodyRecord end;
  constexpr double depth = 0.3;
  const History port = push(*body, depth, end)[0];
  // The mean of forces over every substep, whose lengths are those of its windows.
  double impulse = 0.0;
  const std::vector<double> times = substep_times(0.0, 6.7 * step, step);
  for (std::size_t i = 1; i < port.f.size(); ++i) {
    const std::size_t k = (i - 1) % (times.size() - 1);
    impulse -= 0.5 * (port.f[i] + port.f[i - 1]) * (times[k + 1] - times[k]);
  }
  const bool means = GetParam().name.find("alpha") == std::string::npos;
  // Schemes that weigh forces of both ends otherwise lag behind the mean by part of a step.
  EXPECT_NEAR(end.momentum[0], impulse, means ? 1.0e-9 : 2.0e-2 * std::abs(impulse));
  // Second order in the step: nodal energies of central differences swing by (w dt)^2 / 8.
  const double total = end.energy.total() + end.energy.dissipated;
  EXPECT_GT(port.work, 1.0e-4);
  const bool damped = GetParam().name.find("alpha") != std::string::npos;
  EXPECT_NEAR(total, port.work, (damped ? 0.2 : 2.0e-2) * port.work);
}

/// The bars' own core with the stiffness of the mesh at its ends, under the same surfaces.
TEST_P(LayeredBar, OfEqualElementsIsTheBarsOwnCore) {
  if (GetParam().grading != 1.0) return;
  BarText bar = unit_bar("it", elements, elements, GetParam().integrator);
  bar.layer = "massless: {stiffness_factor: 1.0}";
  bar.sides = {"left", "right"};
  const std::unique_ptr<Subdomain> core = build(bar);
  const std::unique_ptr<Subdomain> solid = build_layered(GetParam(), both, 0.0);
  BodyRecord at_core, at_solid;
  const std::vector<History> of_core = push(*core, 0.3, at_core);
  const std::vector<History> of_solid = push(*solid, 0.3, at_solid);
  // Balances of both cores are solved to 1e-9 of the forces, 0.05.
  const double rounding = 1.0e-9;
  for (std::size_t p = 0; p < of_core.size(); ++p) {
    EXPECT_LT(largest_difference(of_core[p].u, of_solid[p].u), rounding);
    EXPECT_LT(largest_difference(of_core[p].f, of_solid[p].f), rounding);
  }
  EXPECT_NEAR(at_core.momentum[0], at_solid.momentum[0], 0.1 * speed);
}

TEST(LayeredBars, KeepTheirMassAndTheirLimit) {
  for (const std::string& scheme : schemes()) {
    const Layered l{"", "linear_elastic: {" + elastic + "}", scheme, 0.7};
    const std::unique_ptr<Subdomain> free =
        build_layered(l, "right: {side: right, tied: true}", speed);
    const std::unique_ptr<Subdomain> layered = build_layered(l, both, speed);
    EXPECT_DOUBLE_EQ(free->describe().mass, layered->describe().mass);
    EXPECT_EQ(free->describe().stable_step, layered->describe().stable_step);
    EXPECT_FALSE(free->describe().can.obstacle);
    Response response;
    abut::step(*layered, free_request(*layered, 0.0, 2.0), response);
    // Four steps of so many nodes.
    EXPECT_NEAR(response.records[0].momentum[0], speed * elements,
                roundoff(10.0 * 4 * elements, speed * elements));
    EXPECT_NEAR(response.records[0].energy.total(), 0.5 * speed * speed * elements,
                roundoff(10.0 * 4 * elements, 0.5 * speed * speed * elements));
  }
}

TEST(LayeredBars, OfOneElementHaveOneLayer) {
  const auto text = [](const char* ports) {
    return fmt::format(
        "bodies: {{it: {{model: {{fe: {{dimension: 1, mesh: {{bar: {{length: 1.0, elements: 1, "
        "area: "
        "1.0}}}}}}}}, material: {{neo_hookean: {{youngs_modulus: 1.0, poissons_ratio: 0.3, "
        "density: "
        "1.0}}}}, integrator: {{newmark: {{step: 0.1}}}}, ports: {{{}}}}}}}",
        ports);
  };
  const auto make = [&](const char* ports) {
    return make_body(Document::from_text("test", text(ports)), "bodies.it");
  };
  EXPECT_TRUE(make("tip: {side: right}")->describe().can.obstacle);
  try {
    make("tip: {side: right}, root: {side: left}");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no free node inside the mesh near it"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace abut::solver_layer_tests
