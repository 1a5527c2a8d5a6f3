// Goal: where everything may touch everything, bodies of every kind take part: modal, rigid,
// without inertia, of elements of second order, rings, tools that stand. Oracle: the same scene
// with its interfaces written, bit for bit.

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::everything_of_kinds_tests {
namespace {

struct Kind {
  std::string name;
  int dim = 2;
  std::string model, keys;  // of the body in the middle
  std::string element, integrator, more;
  std::string outer;  // element of the others
};

void PrintTo(const Kind& k, std::ostream* out) { *out << k.name; }

const std::string leapfrog = "central_difference: {step: 0.0125}";
const std::string trapezoid = "newmark: {step: 0.0125}";
const std::string base = "    constraints: {base: {on: bottom, fixed: true}}\n";

std::vector<Kind> kinds() {
  return {
      {"modal", 2, "modal", "modes: 12, ", "", trapezoid, "", ""},
      {"modal_in_space", 3, "modal", "modes: 12, ", "", trapezoid, "", ""},
      {"rigid", 2, "rigid", "", "", "rigid_motion: {step: 0.0125}", "", ""},
      {"rigid_in_space", 3, "rigid", "", "", "rigid_motion: {step: 0.0125}", "", ""},
      {"tool", 2, "rigid_tool", "", "", "", "", ""},
      {"without_inertia", 2, "fe", "", "", "quasi_static: {step: 0.0125}", base, ""},
      {"quad8", 2, "fe", "", "quad8", "central_difference: {step: 0.003125}", "", "tri6"},
      {"hex20", 3, "fe", "", "hex20", "central_difference: {step: 0.003125}", "", ""},
  };
}

/// Bars of a length of 1 in a row, the outer ones on their way to the middle one at speeds of
/// their own.
std::string row(const Kind& k) {
  std::string text;
  for (const std::string name : {"middle", "left", "right"}) {
    const bool middle = name == "middle", left = name == "left";
    SolidText bar;
    bar.name = name;
    bar.dim = k.dim;
    bar.mesh = bar_mesh(k.dim, left ? 3 : 2, middle ? k.element : k.outer);
    bar.position = {middle ? 0.0 : left ? -1.0002 : 1.004};
    if (!middle) bar.velocity = {left ? 1.0e-3 : -1.0e-3, left ? 2.0e-4 : 0.0};
    bar.side = left ? "right" : "left";
    bar.integrator = middle            ? k.integrator
                     : k.outer.empty() ? leapfrog
                                       : "central_difference: {step: 0.003125}";
    if (!middle || k.model != "rigid_tool") bar.material = unit_law("linear_elastic", 0.25);
    if (middle) {
      bar.model = k.model;
      bar.keys = k.keys;
      bar.more = k.more;
      bar.side = "";
      bar.sides = {"left", "right"};
    }
    text += bar.text();
  }
  return text;
}

ResultPtr run(const std::string& bodies, const std::string& rest, double end) {
  return run_scene(end, 0.025, bodies, rest);
}

std::string written(const std::string& name, const std::string& sides, const std::string& law) {
  return fmt::format("  {}: {{sides: [{}], contact: {{{}}}}}\n", name, sides, law);
}

class EverythingOfKinds : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EverythingOfKinds, testing::ValuesIn(kinds()),
                         [](const auto& k) { return k.param.name; });

TEST_P(EverythingOfKinds, IsThePairsThatTouchBitForBit) {
  for (const std::string law : {"", "friction: 0.1, static_friction: 0.2"}) {
    if (law.empty() && GetParam().dim == 3) continue;
    SCOPED_TRACE(law);
    const std::string bodies = row(GetParam());
    const auto pairs = run(bodies,
                           "interfaces:\n" + written("west", "middle.left, left.face", law) +
                               written("east", "middle.right, right.face", law),
                           6.0);
    const auto all = run(bodies, fmt::format("contact: {{everything: {{{}}}}}\n", law), 6.0);
    ASSERT_TRUE(pairs->completed());
    ASSERT_TRUE(all->completed());
    EXPECT_EQ(all->end.body_hashes, pairs->end.body_hashes);
    EXPECT_EQ(all->measure("contact.everything.force_peak"),
              std::max(pairs->measure("contact.west.force_peak"),
                       pairs->measure("contact.east.force_peak")));
    EXPECT_GT(pairs->measure("contact.west.force_peak"), 0.0);
    EXPECT_GT(pairs->measure("contact.east.force_peak"), 0.0);
  }
}

TEST(EverythingOfRings, IsThePairsThatTouchBitForBit) {
  std::string bodies;
  for (const std::string name : {"middle", "low", "high"}) {
    const bool middle = name == "middle", low = name == "low";
    SolidText ring;
    ring.name = name;
    ring.mesh = block_mesh({0.25, 1.0}, {low ? 3 : 2, 8});
    ring.keys = "plane: axisymmetric, ";
    ring.material = unit_law("linear_elastic", 0.25);
    ring.integrator = leapfrog;
    ring.position = {0.0, middle ? 0.0 : low ? -1.0002 : 1.004};
    if (!middle) ring.velocity = {0.0, low ? 1.0e-3 : -1.0e-3};
    ring.port = middle ? "south" : "face";
    ring.side = middle ? "bottom}, north: {side: top" : low ? "top" : "bottom";
    ring.more = "    constraints: {axis: {on: left, symmetry: true}}\n";
    bodies += ring.text();
  }
  for (const std::string law : {"", "friction: 0.1, static_friction: 0.2"}) {
    const auto pairs = run(bodies,
                           "interfaces:\n" + written("south", "middle.south, low.face", law) +
                               written("north", "middle.north, high.face", law),
                           6.0);
    const auto all = run(bodies, fmt::format("contact: {{everything: {{{}}}}}\n", law), 6.0);
    ASSERT_TRUE(pairs->completed());
    ASSERT_TRUE(all->completed());
    EXPECT_EQ(all->end.body_hashes, pairs->end.body_hashes);
    EXPECT_GT(pairs->measure("contact.north.force_peak"), 0.0);
  }
}

}  // namespace
}  // namespace abut::everything_of_kinds_tests
