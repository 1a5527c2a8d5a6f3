// Goal: a body whose port is a surface presses on a partner's moving surface, is rewound, resumed
// and probed like any other. Oracles: the same window gives the same bits; forces on the partner
// are those on the body, and never pull; what the surfaces overlap is round-off; an obstacle that
// gives way by the partner's kernel lies where that kernel says.

#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solver_surface_contact_tests {
namespace {

struct Case {
  std::string name, element, law, integrator;
  int dim = 2;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const std::string law : {"linear_elastic: {", "neo_hookean: {",
                                "j2_plasticity: {yield_stress: 1.0e-2, hardening: 0.1, "}) {
    for (const std::string scheme :
         {"central_difference", "newmark", "hht_alpha", "generalized_alpha", "quasi_static"}) {
      for (const auto& [dim, element] : {std::pair(2, "quad4"), std::pair(2, "tri6"),
                                         std::pair(3, "hex8"), std::pair(3, "tet4")})
        out.push_back({scheme + "_" + law.substr(0, law.find(':')) + "_" + element, element, law,
                       scheme + ": {step: 0.02}", dim});
    }
  }
  return out;
}

/// A block on the floor, its top free to be pressed; `more`: other constraints, after a comma.
std::unique_ptr<Subdomain> block(const Case& c, const std::string& more = "") {
  const std::string mesh =
      c.dim == 2
          ? "rectangle: {lengths: [1.0, 1.0], elements: [3, 3], element: " + c.element + "}"
          : "box: {lengths: [1.0, 1.0, 1.0], elements: [2, 2, 2], element: " + c.element + "}";
  const std::string text = fmt::format(
      "bodies: {{it: {{model: {{fe: {{dimension: {}, mesh: {{{}}}}}}}, material: "
      "{{{}youngs_modulus: "
      "1.0, poissons_ratio: 0.3, density: 1.0}}}}, integrator: {{{}}}, ports: {{face: {{side: "
      "{}}}}}, constraints: {{floor: {{on: {}, fixed: true}}{}}}}}}}\n",
      c.dim, mesh, c.law, c.integrator, c.dim == 2 ? "top" : "front",
      c.dim == 2 ? "bottom" : "back", more);
  return make_body(Document::from_text("test", text), "bodies.it",
                   {.ports = {{.port = "face", .touches = true, .partners = {}}}});
}

/// A plate over the block's face, wider than it, of one facet.
PortGeometry plate(int dim) {
  PortGeometry surface;
  surface.dim = dim;
  if (dim == 2) {
    surface.points = {-0.3, 1.0, 1.4, 1.0};
    surface.facets = {0, 1};
    surface.offsets = {0, 2};
  } else {
    surface.points = {-0.3, -0.2, 1.0, -0.2, 1.4, 1.0, 1.3, 1.2, 1.0, 1.2, -0.3, 1.0};
    surface.facets = {0, 1, 2, 3};
    surface.offsets = {0, 4};
  }
  surface.spacing = 1.5;
  return surface;
}

/// A request in which the plate comes down and goes up again, slanting a little.
Advance pressing(const Subdomain& body, int dim, double begin, double end) {
  Advance request;
  request.window = {0, begin, end};
  request.boundary.resize(body.describe().ports.size());
  Obstacle& obstacle = request.boundary[0].obstacles.emplace_back();
  Waveform& motion = obstacle.motion;
  const std::size_t points = index(plate(dim).count());
  motion.width = static_cast<int>(points) * dim;
  constexpr int parts = 7;  // other times than the body's
  for (int i = 0; i <= parts; ++i) {
    const double time = i == parts ? end : begin + i * (end - begin) / parts;
    motion.time.push_back(time);
    for (std::size_t p = 0; p < points; ++p) {
      for (int d = 0; d + 1 < dim; ++d) motion.u.push_back(0.002 * time);
      motion.u.push_back(-0.02 * std::sin(4.0 * time) * (1.0 + 0.02 * static_cast<double>(p)));
    }
  }
  return request;
}

class SurfaceContactOf : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    body = block(GetParam());
    ASSERT_TRUE(body->describe().can.obstacle);
    press_plate(*body);
  }
  static void press_plate(Subdomain& on) {
    const PortGeometry surface = plate(GetParam().dim);
    on.meet({0, 0, &surface});
  }
  Response advance(Subdomain& of, double begin, double end) {
    Response response;
    const Advance request = pressing(of, GetParam().dim, begin, end);
    const Outcome outcome = of.advance(request, response);
    if (const Failed* failed = std::get_if<Failed>(&outcome)) ADD_FAILURE() << failed->detail;
    return response;
  }
  std::unique_ptr<Subdomain> body;
};
INSTANTIATE_TEST_SUITE_P(Bodies, SurfaceContactOf, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.name; });

TEST_P(SurfaceContactOf, PressesAndNeverPulls) {
  const std::size_t dim = index(GetParam().dim);
  double most = 0.0;
  for (int window = 0; window < 4; ++window) {
    const Response r = advance(*body, 0.2 * window, 0.2 * (window + 1));
    const Waveform& trace = r.ports[0].trace;
    const Waveform& reaction = r.ports[0].reactions.at(0).force;
    ASSERT_EQ(reaction.time, trace.time);
    ASSERT_EQ(reaction.support, ForceSupport::linear);
    for (std::size_t i = 0; i < trace.size(); ++i) {
      for (std::size_t d = 0; d < dim; ++d) {
        double on_body = 0.0, on_plate = 0.0, size = 0.0;
        for (std::size_t k = d; k < index(trace.width); k += dim) {
          on_body += trace.f[i * index(trace.width) + k];
          size += std::abs(trace.f[i * index(trace.width) + k]);
        }
        for (std::size_t k = d; k < index(reaction.width); k += dim)
          on_plate += reaction.f[i * index(reaction.width) + k];
        EXPECT_NEAR(on_body, -on_plate, 1.0e-14 * (1.0 + size));  // rows sum to 1
        if (d + 1 == dim) {
          EXPECT_LE(on_body, roundoff(40.0, 1.0));
          most = std::max(most, -on_body);
        }
      }
    }
  }
  EXPECT_GT(most, 1.0e-3);  // it was pressed
}

/// Forces balance without inertia.
std::vector<Case> static_cases() {
  std::vector<Case> out = cases();
  std::erase_if(out, [](const Case& c) { return !c.name.starts_with("quasi_static"); });
  return out;
}

class StaticContactOf : public SurfaceContactOf {};
INSTANTIATE_TEST_SUITE_P(Bodies, StaticContactOf, testing::ValuesIn(static_cases()),
                         [](const auto& c) { return c.param.name; });

/// Nodes of the port at its rim are held as well, and pressed: what presses there goes into them.
TEST_P(StaticContactOf, ReactionsBearAllThatPresses) {
  const std::size_t dim = index(GetParam().dim);
  body = block(GetParam(), ", wall: {on: left, fixed: true}");
  press_plate(*body);
  const Response r = advance(*body, 0.0, 0.2);
  const Waveform& trace = r.ports[0].trace;
  const std::size_t last = trace.size() - 1;
  double pressing = 0.0, borne = 0.0;
  for (std::size_t k = dim - 1; k < index(trace.width); k += dim)
    pressing += trace.f[last * index(trace.width) + k];
  const std::vector<double> values = body->measure();
  const std::vector<std::string>& names = body->describe().measures;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == (dim == 2 ? "reaction.y" : "reaction.z")) borne = values[k];
  EXPECT_LT(pressing, -1.0e-3);                             // it was pressed
  EXPECT_NEAR(borne / pressing, -1.0, 1.0e-7) << pressing;  // Newton's residual, 1e-9 of a force
}

TEST_P(SurfaceContactOf, ComesBackBitForBit) {
  advance(*body, 0.0, 0.2);
  body->save();
  const std::uint64_t before = body->state_hash();
  const std::vector<std::byte> durable = body->checkpoint();
  const std::vector<double> measures = body->measure();
  const std::vector<FieldValues> drawn = body->fields();
  const Response first = advance(*body, 0.2, 0.4);
  const std::uint64_t after = body->state_hash();
  body->restore();
  EXPECT_EQ(body->state_hash(), before);
  EXPECT_EQ(body->measure(), measures);
  EXPECT_EQ(body->fields(), drawn);
  const Response second = advance(*body, 0.2, 0.4);
  EXPECT_EQ(body->state_hash(), after);
  EXPECT_EQ(first.ports[0].reactions[0].force.f, second.ports[0].reactions[0].force.f);
  EXPECT_EQ(first.ports[0].trace.u, second.ports[0].trace.u);
  const std::unique_ptr<Subdomain> twin = block(GetParam());
  press_plate(*twin);
  twin->resume(durable);
  EXPECT_EQ(twin->state_hash(), before);
  EXPECT_EQ(twin->measure(), measures);
  EXPECT_EQ(twin->fields(), drawn);
  const Response third = advance(*twin, 0.2, 0.4);
  EXPECT_EQ(twin->state_hash(), after);
  EXPECT_EQ(first.ports[0].reactions[0].force.f, third.ports[0].reactions[0].force.f);
}

/// Where it looks is where it flies, and it has not moved.
TEST_P(SurfaceContactOf, LooksAheadAndStays) {
  const std::size_t width = body->describe().ports[0].geometry.points.size();
  Advance request;
  request.window = {0, 0.0, 0.2};
  request.boundary.resize(1);
  Waveform& force = request.boundary[0].forces.emplace_back(static_cast<int>(width));
  force.support = ForceSupport::linear;
  force.time = {0.0, 0.2};
  force.f.assign(2 * width, 0.0);
  for (std::size_t k = 0; k < width; ++k) force.f[width + k] = -1.0e-4;
  Response plain, looking;
  body->save();
  ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, plain)));
  const std::uint64_t hash = body->state_hash();
  EXPECT_TRUE(plain.ports[0].ahead.empty());
  body->restore();
  request.ahead = 0.1;
  ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, looking)));
  EXPECT_EQ(body->state_hash(), hash);
  const Waveform& look = looking.ports[0].ahead;
  Advance flight;
  flight.window = {1, 0.2, 0.2 + 0.1};
  flight.boundary.resize(1);
  Waveform& gone = flight.boundary[0].forces.emplace_back(static_cast<int>(width));
  gone.support = ForceSupport::linear;
  gone.time = look.time;
  gone.f.assign(gone.time.size() * width, 0.0);
  for (std::size_t k = 0; k < width; ++k) gone.f[k] = -1.0e-4;
  Response flown;
  ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(flight, flown)));
  EXPECT_EQ(look.time, flown.ports[0].trace.time);
  EXPECT_EQ(look.u, flown.ports[0].trace.u);
}

TEST_P(SurfaceContactOf, ProbesLeaveItAlone) {
  advance(*body, 0.0, 0.2);
  const std::uint64_t before = body->state_hash();
  const std::size_t width = body->describe().ports[0].geometry.points.size();
  std::vector<double> unit(width, 0.0);
  unit[width - 1] = 1.0;
  const PortKernel kernel = body->probe({0, unit, 0.02, 2});
  EXPECT_GT(kernel.displacement[width - 1], 0.0);
  EXPECT_EQ(body->state_hash(), before);
}

}  // namespace
}  // namespace abut::solver_surface_contact_tests
