// Goal: bodies that pass through each other, or end inside each other, are told with the place and
// the depth, whatever they are and whyever nobody held them apart; and nothing is told of what is
// well.
// Oracles: the geometry: falls and flights of known length.

#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut {
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
                .block = {{1.0, 0.5}, {4, 2}, f.element}};
  if (space) {
    out.block.lengths.push_back(1.0);
    out.block.cells.push_back(4);
  }
  if (!tool) {
    out.velocity = {0.0, speed};
    out.material = "linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}";
    out.integrator = scheme_named(model == "rigid" ? 'R' : 'I', 1.0e-3);
  }
  return out.text();
}

ResultPtr fly(const Flight& f, const std::string& output = "") {
  return run_scene(
      f.end, 1.0e-3,
      body(f, "striker", f.striker, f.port, 0.6, -1.0) + body(f, "plate", f.plate, "top", 0.0, 0.0),
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
  EXPECT_NEAR(looked->end.overlaps.front().time, 0.2, roundoff(4.0, 0.2));
  EXPECT_EQ(warnings(*looked, "overlap by"), 1) << "once, not at every state";
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
}  // namespace abut
