// Goal: bodies that pass through each other, or end inside each other, are told with the place and
// the depth, whatever they are and whyever nobody held them apart; and nothing is told of what is
// well.
// Oracles: the geometry: falls and flights of known length.

#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::overlaps_told_tests {
namespace {

/// A brick that flies down onto a plate, and a contact on sides that do not meet.
struct Flight {
  std::string name;
  int dim = 2;
  std::string striker = "fe", plate = "fe";
  std::string element = "";  // of both; empty: the linear one
  std::string port = "top";  // of the striker; its bottom would meet the plate
  std::string interfaces = "interfaces: {met: {sides: [striker.face, plate.face], contact: {}}}\n";
  double end = 0.2;  // [s] at 1 m/s from .1 m above
  std::vector<int> cells = {4, 2};
  double thickness = 0.5;  // [m] of the plate, below .5 m
};

void PrintTo(const Flight& flight, std::ostream* out) { *out << flight.name; }

std::string body(const Flight& f, const std::string& name, const std::string& model,
                 const std::string& side, double place, double speed) {
  const bool space = f.dim == 3, tool = model == "rigid_tool";
  SolidText out{.name = name,
                .position = {0.0, place},
                .side = side,
                .model = model,
                .keys = model == "modal" ? "modes: 6, " : "",
                .block = {{1.0, name == "plate" ? f.thickness : 0.5}, f.cells, f.element}};
  if (space) {
    out.block.lengths.push_back(1.0);
    out.block.cells.push_back(f.cells[0]);
  }
  if (!tool) {
    out.velocity = {0.0, speed};
    out.material = "linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}";
    out.integrator = scheme_named(model == "rigid" ? 'R' : 'I', 1.0e-3);
  }
  return out.text();
}

ResultPtr fly(const Flight& f, const std::string& output = "") {
  return run_scene(f.end, 1.0e-3,
                   body(f, "striker", f.striker, f.port, 0.6, -1.0) +
                       body(f, "plate", f.plate, "top", 0.5 - f.thickness, 0.0),
                   f.interfaces + output);
}

int warnings(const RunResult& run, const std::string& words) {
  int count = 0;
  for (const RunEvent& event : run.events)
    count += event.kind == RunEvent::Kind::warning && event.text.find(words) != std::string::npos;
  return count;
}

class Passing : public testing::TestWithParam<Flight> {};

TEST_P(Passing, IsToldWithDepthAndPlace) {
  const auto run = fly(GetParam());
  ASSERT_TRUE(run->completed()) << run->events.back().text;
  ASSERT_EQ(run->end.overlaps.size(), 1u);
  const Overlap& told = run->end.overlaps.front();
  EXPECT_EQ(told.body[0], 0);
  EXPECT_EQ(told.body[1], 1);
  EXPECT_NEAR(told.depth, 0.1, 1.0e-9);  // .2 m gone, .1 m apart; the bodies fly free
  EXPECT_NEAR(told.place[1], told.place[1] > 0.45 ? 0.5 : 0.4, 1.0e-9);
  EXPECT_EQ(told.time, GetParam().end);
  EXPECT_EQ(warnings(*run, "bodies 'striker' and 'plate' overlap by 0.1 m"), 1);
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, Passing,
    testing::Values(
        Flight{.name = "port_on_the_wrong_side"}, Flight{.name = "no_interface", .interfaces = ""},
        Flight{.name = "of_triangles", .element = "tri3"},
        Flight{.name = "of_second_order", .element = "quad8"},
        Flight{.name = "of_triangles_of_second_order", .element = "tri6"},
        Flight{.name = "rigid", .striker = "rigid"}, Flight{.name = "modal", .striker = "modal"},
        Flight{.name = "tool", .plate = "rigid_tool"}, Flight{.name = "in_space", .dim = 3},
        Flight{.name = "in_space_tool", .dim = 3, .plate = "rigid_tool"},
        Flight{.name = "in_space_tetrahedra", .dim = 3, .striker = "rigid", .element = "tet4"},
        Flight{.name = "in_space_hexahedra_of_second_order", .dim = 3, .element = "hex20"},
        Flight{.name = "one_cell", .cells = {1, 1}},
        Flight{.name = "in_space_one_cell", .dim = 3, .cells = {1, 1}},
        Flight{.name = "thin_plate", .thickness = 0.01},
        Flight{.name = "in_space_thin_plate", .dim = 3, .thickness = 0.01},
        Flight{.name = "in_space_tetrahedra_of_second_order", .dim = 3, .element = "tet10"}),
    [](const testing::TestParamInfo<Flight>& of) { return of.param.name; });

/// All the way through: nothing overlaps any more, but where fields were written it did.
TEST(PassingThrough, IsToldOfFieldsAndOfSidesThatChangedPlaces) {
  const Flight through{.name = "through", .end = 1.5};
  const auto blind = fly(through);
  EXPECT_TRUE(blind->end.overlaps.empty());
  EXPECT_EQ(blind->end.never_met, std::vector<std::string>{"met"});
  EXPECT_EQ(warnings(*blind, "contact 'met' has never closed"), 1);
  const auto looked = fly(through, "output: {fields: {every: 100}}\n");
  ASSERT_EQ(looked->end.overlaps.size(), 1u);
  EXPECT_EQ(warnings(*looked, "overlap by 0.1 m"), 1);
  EXPECT_LE(warnings(*looked, "overlap by"), 3) << "where it is twice as deep, not at every state";
}

/// Neither's nodes near the other's surface: a small body that rests deep inside another.
TEST(PassingThrough, IsToldOfABodyInsideAnother) {
  for (const int dim : {2, 3}) {
    Flight large{.name = "large", .dim = dim};
    SolidText small = {.name = "striker",
                       .material =
                           "linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, "
                           "density: 1000.0}",
                       .integrator = scheme_named('I', 1.0e-3),
                       .position = {0.45, 0.6, 0.45},
                       .velocity = {0.0, -1.0},
                       .side = "top",
                       .block = block_in(dim, {0.1, 0.1, 0.1}, {1, 1, 1})};
    const auto run =
        run_scene(0.4, 1.0e-3, small.text() + body(large, "plate", "fe", "top", 0.0, 0.0));
    ASSERT_EQ(run->end.overlaps.size(), 1u) << dim;
    // From .2 m to .3 m of .5 m: nodes are .2 m deep, middles of sides up to .05 m more.
    const double flown = roundoff(1000.0, 0.6);  // in 400 steps
    EXPECT_GT(run->end.overlaps.front().depth, 0.2 - flown) << dim;
    EXPECT_LT(run->end.overlaps.front().depth, 0.25 + flown) << dim;
    EXPECT_EQ(warnings(*run, "bodies 'striker' and 'plate' overlap by 0.2"), 1) << dim;
  }
}

/// Told again only where it has become much worse; the summary has the deepest that was told.
TEST(PassingThrough, IsToldAgainWhereItGrows) {
  const auto run = fly({.name = "sinks", .end = 0.35}, "output: {fields: {every: 10}}\n");
  ASSERT_EQ(run->end.overlaps.size(), 1u);
  const int told = warnings(*run, "bodies 'striker' and 'plate' overlap by");
  EXPECT_GE(told, 2);
  EXPECT_LE(told, 5) << "from a tenth of a facet on, twice as deep each time";
  EXPECT_GE(run->end.overlaps.front().depth, 0.1);
}

/// Contact on the right sides, and bodies that have not come near yet.
TEST(PassingThrough, NothingIsToldOfWhatIsWell) {
  for (const Flight& flight :
       {Flight{.name = "contact", .port = "bottom"}, Flight{.name = "not_yet", .end = 0.09}}) {
    const auto run = fly(flight, "output: {fields: {every: 10}}\n");
    EXPECT_TRUE(run->completed()) << flight.name;
    EXPECT_TRUE(run->end.overlaps.empty()) << flight.name;
    EXPECT_TRUE(run->end.never_met.empty()) << flight.name;
  }
}

/// Variants of one body beside each other in one scene are no overlap.
TEST(PassingThrough, BodiesThatLieInOnePlaceFromTheStartAreMeant) {
  const auto run = run_scene(
      0.01, 1.0e-3,
      body({}, "one", "fe", "top", 0.0, -1.0) + body({}, "other", "rigid", "top", 0.0, -1.0));
  EXPECT_TRUE(run->end.overlaps.empty());
}

/// In one dimension bars are as long as their cells, and a wall goes on behind its end.
TEST(PassingThrough, IsToldOfBarsThatNobodyJoins) {
  SceneText scene = two_bars();
  scene.closed_form = false;
  scene.interfaces.clear();
  const auto run = abut::run(scene);
  ASSERT_EQ(run->end.overlaps.size(), 1u);
  EXPECT_GT(run->end.overlaps.front().depth, 0.0);
  EXPECT_TRUE(abut::run(two_bars())->end.overlaps.empty());
}

}  // namespace
}  // namespace abut::overlaps_told_tests
