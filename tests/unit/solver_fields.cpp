// Goal: what bodies of bars and walls tell all over themselves is their state, in VTK's terms.
// Oracles: a front that the explicit scheme moves exactly at step h/c, the traces of the ports, the
// definition of the stress on current lengths.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "surface/check.hpp"
#include "tests/support/solid_texts.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_fields_tests {
namespace {

constexpr int vtk_vertex = 1, vtk_line = 3;

/// The values of a field by its name; fails the test where there is none.
FieldValues told(Subdomain& body, const std::string& name) {
  const std::vector<FieldInfo>& fields = body.describe().fields;
  for (std::size_t k = 0; k < fields.size(); ++k)
    if (fields[k].name == name) return body.fields()[k];
  ADD_FAILURE() << "no field " << name;
  return {};
}

void expect_sound(Subdomain& body) {
  const Grid grid = body.grid();
  const std::vector<FieldInfo>& fields = body.describe().fields;
  EXPECT_EQ(unsound(fields), "");
  EXPECT_EQ(unsound(grid), "");
  EXPECT_EQ(unsound(body.fields(), fields, grid.nodes(), grid.cells()), "");
}

TEST(BarFields, ABarIsARowOfLineCellsInItsReferencePlace) {
  BarText bar;
  bar.length = 3.0;
  bar.elements = 3;
  bar.position = -1.0;
  bar.integrator = explicit_scheme(1.0e-7);
  const std::unique_ptr<Subdomain> body = build(bar);
  expect_sound(*body);
  const Grid grid = body->grid();
  EXPECT_EQ(grid.points, (std::vector<double>{-1, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0}));
  EXPECT_EQ(grid.types, std::vector<std::int32_t>(3, vtk_line));
  EXPECT_EQ(grid.connectivity, (std::vector<std::int32_t>{0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(grid.offsets, (std::vector<std::int32_t>{0, 2, 4, 6}));
}

TEST(BarFields, AFrontStandsWhereDAlembertPutsIt) {
  // A unit bar runs into a wall: behind the front it is at rest under the stress -rho c v.
  constexpr double speed = 0.1;
  constexpr int time = 10;
  const std::unique_ptr<Subdomain> body =
      build(case_bar({"front", explicit_scheme(1.0), "kick: {}", {"right"}}, speed));
  Advance request = free_request(*body, 0.0, time);
  meet_point(*body, 0, false);
  Obstacle& wall = request.boundary[0].obstacles.emplace_back();
  wall.motion.time = substep_times(0.0, time, 1.0);
  wall.motion.u.assign(wall.motion.time.size(), 0.0);
  Response response;
  step(*body, request, response);
  const FieldValues stress = told(*body, "stress"), von_mises = told(*body, "von_mises");
  for (std::size_t e = 0; e < case_elements; ++e) {
    EXPECT_NEAR(stress[6 * e], e < case_elements - time ? 0.0 : -speed, roundoff(1000, speed)) << e;
    EXPECT_EQ(von_mises[e], std::abs(stress[6 * e]));
    for (std::size_t k = 1; k < 6; ++k) EXPECT_EQ(stress[6 * e + k], 0.0);
  }
  const FieldValues u = told(*body, "displacement");
  for (int i = 0; i <= case_elements; ++i) {
    const std::size_t at = 3 * index(i);
    const double arrival = case_elements - i;  // of the front, at wave speed 1
    EXPECT_NEAR(u[at], speed * std::min<double>(arrival, time), roundoff(1000, speed * time)) << i;
    EXPECT_EQ(u[at + 1], 0.0);
    EXPECT_EQ(u[at + 2], 0.0);
  }
}

class BarFieldsOf : public testing::TestWithParam<SolverCase> {};
INSTANTIATE_TEST_SUITE_P(Solver, BarFieldsOf, testing::ValuesIn(complete_cases()), case_name);

TEST_P(BarFieldsOf, AgreeWithTheTracesOfThePorts) {
  const std::unique_ptr<Subdomain> body = build(case_bar(GetParam(), 0.02));
  expect_sound(*body);
  constexpr double end = 12.0;
  const std::vector<double> times = substep_times(0.0, end, case_step);
  Advance request = free_request(*body, 0.0, end);
  meet_point(*body, 0, true);
  request.boundary[0].obstacles = {pushing_surface(*body, 0, times, 0.3)};
  Response response;
  step(*body, request, response);
  const std::uint64_t hash = body->state_hash();
  const FieldValues u = told(*body, "displacement"), v = told(*body, "velocity");
  const FieldValues stress = told(*body, "stress");
  EXPECT_EQ(body->state_hash(), hash);
  for (std::size_t p = 0; p < response.ports.size(); ++p) {
    const Waveform& trace = response.ports[p].trace;
    const bool left = outward(*body, p) < 0.0;
    EXPECT_EQ(u[left ? 0 : u.size() - 3], trace.u.back());
    if (trace.support == ForceSupport::step) continue;  // the node has mass, the trace a mean
    EXPECT_EQ(v[left ? 0 : v.size() - 3], trace.v.back());
    // The corrected operator of several terms takes the contact force from several elements.
    const std::string& name = GetParam().name;
    if (name.starts_with("explicit") && !name.starts_with("explicit1_")) continue;
    // Without mass the contact element passes on all of the contact force; area 1.
    const double axial = stress[left ? 0 : stress.size() - 6];
    EXPECT_NEAR(axial, outward(*body, p) * trace.f.back(), roundoff(1000, 0.3));
  }
}

TEST(PairFields, StressOnCurrentLengthsIsLogarithmic) {
  const std::unique_ptr<Subdomain> pair = make_body(
      Document::from_text(
          "test",
          "bodies:\n  pair:\n"
          "    model: {bar_pair: {left: {length: 20.0, area: 2.0, elements: 20, position: -20.0, "
          "velocity: 0.1}, right: {length: 30.0, area: 1.0, elements: 10, position: 0.0, "
          "velocity: -0.1}, contact: {penalty: {stiffness: 0.2}}, lengths: current}}\n"
          "    material: {linear_elastic: {youngs_modulus: 3.0, density: 3.0}}\n"
          "    integrator: {central_difference: {step: 0.5}}\n"),
      "bodies.pair");
  expect_sound(*pair);
  Response response;
  step(*pair, free_request(*pair, 0.0, 20.0), response);
  const Grid grid = pair->grid();
  const FieldValues u = told(*pair, "displacement"), stress = told(*pair, "stress");
  ASSERT_EQ(grid.cells(), 30U);  // none between the bars
  ASSERT_EQ(grid.nodes(), 32U);
  double most = 0.0;
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    const std::size_t a = index(grid.connectivity[2 * c]) * 3;
    const std::size_t b = index(grid.connectivity[2 * c + 1]) * 3;
    const double before = grid.points[b] - grid.points[a];
    const double now = before + u[b] - u[a];
    EXPECT_NEAR(stress[6 * c], 3.0 * std::log(now / before), roundoff(1000, 3.0)) << c;
    most = std::max(most, std::abs(stress[6 * c]));
  }
  EXPECT_GT(most, 0.1);  // they have met: E v / c is 0.3
}

/// Laws with a history have none before the first advance.
TEST(SolidFields, AreSoundBeforeTheBodyBegins) {
  for (const std::string law : {"linear_elastic", "neo_hookean", "j2_plasticity"}) {
    SCOPED_TRACE(law);
    const std::unique_ptr<Subdomain> body =
        build(SolidText{.name = "block",
                        .material = law == "j2_plasticity"
                                        ? "j2_plasticity: {youngs_modulus: 1, poissons_ratio: 0.3, "
                                          "density: 1, yield_stress: 0.01}"
                                        : unit_law(law, 0.3),
                        .integrator = implicit_scheme("newmark", 0.1),
                        .side = "boundary",
                        .block = {{2.0, 1.0}, {2, 1}}});
    expect_sound(*body);
    for (const double entry : told(*body, "stress")) EXPECT_EQ(entry, 0.0);
  }
}

/// The warped top of a sound cell, one corner of which points inward in the mean plane.
TEST(SolidPorts, OfFacetsThatAreNotConvexAreDivided) {
  const auto moved = [](const char* axis, std::array<const char*, 4> by) {
    return fmt::format(
        "\"{0} + z * ((1 - x) * ((1 - y) * {1} + y * {2}) + x * ((1 - y) * {3} + y * "
        "{4}))\"",
        axis, by[0], by[1], by[2], by[3]);
  };
  const std::string warped =
      fmt::format("map: [{}, {}, {}], ", moved("x", {"0.5", "(-0.1)", "0.1", "0.3"}),
                  moved("y", {"0.5", "0.5", "(-0.5)", "(-0.5)"}),
                  moved("z", {"0.3", "(-0.2)", "(-0.4)", "0.5"}));
  for (const bool warp : {false, true}) {
    SolidText cell{.name = "cell",
                   .material = unit_law("linear_elastic", 0.3),
                   .integrator = implicit_scheme("newmark", 0.1),
                   .side = "boundary",
                   .block = {{1.0, 1.0, 1.0}, {1, 1, 1}}};
    if (warp) cell.keys = warped;
    const std::unique_ptr<Subdomain> body = build(cell);
    const PortGeometry& port = body->describe().ports[0].geometry;
    EXPECT_EQ(port.offsets.size(), warp ? 8u : 7u);
    EXPECT_EQ(port.facets.size(), warp ? 26u : 24u);
    EXPECT_FALSE(check(posed(port)).has_value());
  }
}

TEST(WallFields, AWallIsAPointThatStays) {
  const std::unique_ptr<Subdomain> wall = build_wall(0.5, "left");
  expect_sound(*wall);
  EXPECT_EQ(wall->grid().points, (std::vector<double>{0.5, 0.0, 0.0}));
  EXPECT_EQ(wall->grid().types, std::vector<std::int32_t>{vtk_vertex});
  EXPECT_EQ(told(*wall, "displacement"), FieldValues(3, 0.0));
}

}  // namespace
}  // namespace abut::solver_fields_tests
