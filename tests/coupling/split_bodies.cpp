// Goal: a body that was divided moves as the whole one. Oracles: the undivided body, step by step
// the same equations for implicit bodies; for explicit ones, whose steps are cut differently where
// bodies are tied, other numbers of parts.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "coordinator/launch_local.hpp"
#include "coordinator/record/expectations.hpp"
#include "coordinator/split/split_scene.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"

namespace abut::split_bodies_tests {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes with the test.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "abut_split_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Held at one end, pushed on a side, with a start that is no field of one part alone.
struct Plate {
  std::string element = "quad4", integrator = implicit_scheme("newmark", 0.02);
  std::string law = "linear_elastic";
  bool still = false;                       // no field of velocity
  double end = 2.0, window = 0.2;           // [s]
  std::string port = "corner", start = {};  // the side of its name; other keys of initial
  std::string others = {}, rest = {};       // bodies before it; what comes after it

  std::string text() const {
    const bool space = element_named(element).dim == 3;
    SolidText plate{.name = "plate",
                    .material = unit_law(law, 0.25),
                    .integrator = integrator,
                    .position = {0.3, 0.0, 0.1},
                    .start = start,
                    .sides = {port},
                    .block = space ? SolidText::Block{{2.0, 0.9, 0.8}, {6, 3, 3}, element}
                                   : SolidText::Block{{2.0, 0.9}, {10, 5}, element}};
    plate.keys =
        space ? "map: [\"x\", \"y\", \"z + 0.1*x*z\"], " : "map: [\"x\", \"y + 0.1*x*y\"], ";
    if (!still)
      plate.field =
          space ? "\"0.1*sin(2*x)*y\", \"0.02*z\", \"0.03*x*y\"" : "\"0.1*sin(2*x)\", \"0.03*x*y\"";
    plate.more = fmt::format(
        "    constraints: {{wall: {{on: left, fixed: true}}, ground: {{on: bottom, symmetry: "
        "true}}}}\n    loads: {{push: {{on: top, traction: [{}]}}}}\n"
        "    points: {{corner: {{at: {}}}}}\n",
        space ? "\"0\", \"0.001\", \"0.002\"" : "\"0.002\", \"0.001\"",
        space ? "[2.3, 0.9, 1.06]" : "[2.3, 1.08]");
    return scene_text(end, window, others + plate.text() + rest);
  }
};

Document written(const fs::path& folder, const std::string& text) {
  std::ofstream(folder / "plate.yaml") << text;
  return Document::load((folder / "plate.yaml").string());
}

SplitScene split(const Document& document, int bodies, const fs::path& out,
                 const std::string& body = "plate") {
  return split_scene(document, read_scene(document), {bodies, body, out});
}

/// The file of the parts' scene, which is written with their meshes.
std::string put(const SplitScene& parts, const fs::path& out) {
  fs::create_directory(out);
  for (const auto& [name, mesh] : parts.meshes) std::ofstream(out / name) << mesh;
  std::ofstream(out / "plate.yaml") << parts.scene;
  return out / "plate.yaml";
}

ResultPtr run_split(const Folder& folder, const std::string& text, int bodies) {
  const fs::path out = folder.path() / std::to_string(bodies);
  return run_file(put(split(written(folder.path(), text), bodies, out), out));
}

/// The sum over the parts.
double sum(const RunResult& run, const std::string& measure, int bodies) {
  double all = 0.0;
  for (int p = 1; p <= bodies; ++p) all += run.measure(fmt::format("body.plate_{}.{}", p, measure));
  return all;
}

/// Of a point that one part has.
double corner(const RunResult& run, const std::string& measure) {
  for (const auto& [name, value] : run.measures.values)
    if (name.starts_with("body.plate") && name.ends_with(".corner." + measure)) return value;
  ADD_FAILURE() << "no part has the corner";
  return 0.0;
}

// Displacements and velocities are of the order of 0.1, a hundred steps; Newton's method leaves
// 1e-9 of the forces in each. Goal of the method: 1e-8 over 1e4 steps.
constexpr double same_motion = 1.0e-9;

TEST(SplitBodies, MoveAsTheWholeOne) {
  for (const char* element : {"quad4", "tri3", "quad8", "hex8", "tet4", "tet10"}) {
    const Folder folder;
    const Plate plate{.element = element};
    const auto whole = run_document(written(folder.path(), plate.text()));
    for (const int bodies : {2, 3, 4}) {
      SCOPED_TRACE(fmt::format("{} {}", element, bodies));
      const auto parts = run_split(folder, plate.text(), bodies);
      ASSERT_TRUE(parts->completed());
      for (const char* measure : {"energy.kinetic", "energy.stored", "momentum.x", "momentum.y"})
        EXPECT_NEAR(sum(*parts, measure, bodies),
                    whole->measure(fmt::format("body.plate.{}", measure)), same_motion)
            << measure;
      for (const char* measure : {"displacement.x", "displacement.y", "velocity.y"})
        EXPECT_NEAR(corner(*parts, measure), corner(*whole, measure), same_motion) << measure;
      double mass = 0.0, all = 0.0;
      for (const double m : parts->masses) mass += m;
      for (const double m : whole->masses) all += m;
      EXPECT_NEAR(mass, all, 1.0e-13);                           // sums of some hundred cells
      EXPECT_EQ(parts->measure("schwarz.iterations_max"), 2.0);  // the first window has a trial
      EXPECT_LE(parts->measure("schwarz.iterations_mean"), 1.1);
    }
  }
}

/// Schemes that damp keep accelerations, in which forces between parts have no share.
TEST(SplitBodies, DampedOnesToo) {
  const Folder folder;
  // Of a step to a window and more than a transit of a cell, which is where it shows.
  for (const char* integrator : {"generalized_alpha: {step: 0.2, spectral_radius: 0.5}",
                                 "hht_alpha: {step: 0.2, alpha: -0.2}"}) {
    SCOPED_TRACE(integrator);
    const std::string text = Plate{.integrator = integrator}.text();
    const auto whole = run_document(written(folder.path(), text));
    const auto parts = run_split(folder, text, 3);
    // Momenta have other parts of what the scheme holds back: it is told where no node is held
    // [M.24], of the whole not, of some of its parts yes.
    for (const char* measure : {"energy.kinetic", "energy.stored"})
      EXPECT_NEAR(sum(*parts, measure, 3), whole->measure(fmt::format("body.plate.{}", measure)),
                  same_motion)
          << measure;
    for (const char* measure : {"displacement.x", "displacement.y", "velocity.y"})
      EXPECT_NEAR(corner(*parts, measure), corner(*whole, measure), same_motion) << measure;
  }
}

TEST(SplitBodies, NonlinearOnesToo) {
  const Folder folder;
  const Plate plate{.element = "hex8", .law = "neo_hookean"};
  const auto whole = run_document(written(folder.path(), plate.text()));
  const auto parts = run_split(folder, plate.text(), 3);
  // The tolerance of the iteration, 1e-6 of what moves in a step, in each of a hundred windows.
  constexpr double close = 1.0e-6 * 0.02 * 0.2 * 100.0;
  EXPECT_NEAR(corner(*parts, "displacement.x"), corner(*whole, "displacement.x"), close);
  EXPECT_NEAR(corner(*parts, "displacement.y"), corner(*whole, "displacement.y"), close);
}

TEST(SplitBodies, ExplicitOnesMoveAlikeHoweverManyTheyAre) {
  for (const char* element : {"quad4", "tet4"}) {
    const Folder folder;
    const Plate plate{.element = element, .integrator = explicit_scheme(0.01)};
    const auto two = run_split(folder, plate.text(), 2);
    for (const int bodies : {3, 4, 6}) {
      SCOPED_TRACE(fmt::format("{} {}", element, bodies));
      const auto more = run_split(folder, plate.text(), bodies);
      for (const char* measure : {"displacement.x", "displacement.y", "velocity.y"})
        EXPECT_NEAR(corner(*more, measure), corner(*two, measure), same_motion) << measure;
      EXPECT_NEAR(sum(*more, "energy.kinetic", bodies), sum(*two, "energy.kinetic", 2),
                  same_motion);
    }
  }
}

/// Parts without inertia hold each other; those that no support holds, too.
TEST(SplitBodies, WithoutInertiaToo) {
  for (const char* element : {"quad4", "tri6", "hex8"}) {
    const Folder folder;
    const Plate plate{
        .element = element, .integrator = "quasi_static: {step: 0.2}", .still = true, .end = 0.4};
    const std::string text = plate.text();
    const auto whole = run_document(written(folder.path(), text));
    for (const int bodies : {2, 3, 5}) {
      SCOPED_TRACE(fmt::format("{} {}", element, bodies));
      const auto parts = run_split(folder, text, bodies);
      ASSERT_TRUE(parts->completed());
      for (const char* measure : {"displacement.x", "displacement.y"})
        EXPECT_NEAR(corner(*parts, measure), corner(*whole, measure), same_motion) << measure;
      EXPECT_NEAR(sum(*parts, "energy.stored", bodies), whole->measure("body.plate.energy.stored"),
                  same_motion);
      double reaction = 0.0;  // of the parts that are held
      for (const auto& [name, value] : parts->measures.values)
        if (name.starts_with("body.plate_") && name.ends_with(".wall.reaction.x"))
          reaction += value;
      EXPECT_NEAR(reaction, whole->measure("body.plate.wall.reaction.x"), same_motion);
    }
  }
}

/// A scene of parts holds keys that belong there alone: it is read again, and changed again.
TEST(SplitBodies, HaveKeysThatBelongThereAlone) {
  const Folder folder;
  for (const char* scheme : {"central_difference", "newmark", "hht_alpha"}) {
    SCOPED_TRACE(scheme);
    const Plate plate{.integrator = implicit_scheme(scheme, scheme[0] == 'n' ? 0.02 : 0.01)};
    const fs::path out = folder.path() / scheme;
    const SplitScene parts = split(written(folder.path(), plate.text()), 2, out);
    const std::string file = put(parts, out);
    for (const char* key : {"equations:", "threads:", "contact_layer:", "formulation:"})
      EXPECT_EQ(parts.scene.find(key), std::string::npos) << key;
    for (const char* edit : {"time.end=0.2", "bodies.plate_1.ports.corner=null",
                             "bodies.*.integrator={newmark: {step: 0.02}}",
                             "bodies.*.integrator={hht_alpha: {step: 0.02, alpha: -0.1}}"}) {
      const Document document = Document::load(file, {edit});
      EXPECT_EQ(refusal([&] { check_body_keys(read_scene(document), document); }), "not refused")
          << edit;
    }
  }
}

TEST(SplitBodies, AreTheSameBytesEveryTime) {
  const Folder folder;
  const Document document = written(folder.path(), Plate{.element = "tet4"}.text());
  const SplitScene one = split(document, 3, folder.path() / "out");
  const SplitScene other = split(document, 3, folder.path() / "out");
  EXPECT_EQ(one.scene, other.scene);
  EXPECT_EQ(one.meshes, other.meshes);
}

/// A parts' scene is a scene: one of its bodies is divided again, ties and all.
TEST(SplitBodies, AreDividedAgain) {
  const Folder folder;
  const Plate plate{.element = "hex8"};
  const auto whole = run_document(written(folder.path(), plate.text()));
  run_split(folder, plate.text(), 2);
  const fs::path once = folder.path() / "2", twice = folder.path() / "again";
  const Document document = Document::load((once / "plate.yaml").string());
  const SplitScene parts = split(document, 2, twice, "plate_1");
  const auto again = run_file(put(parts, twice));
  ASSERT_EQ(again->masses.size(), 3u);
  EXPECT_NEAR(corner(*again, "displacement.y"), corner(*whole, "displacement.y"), same_motion);
}

/// What touched the whole touches the part that has the face: a block that strikes the plate.
TEST(SplitBodies, TouchWithFacesThatStayWhole) {
  const Folder folder;
  const SolidText block{.name = "block",
                        .material = unit_law("linear_elastic", 0.25),
                        .integrator = explicit_scheme(0.01),
                        .position = {2.31, 0.2},
                        .velocity = {-0.1},
                        .sides = {"left"},
                        .block = {{1.0, 0.4}, {8, 3}}};
  // A window of one step: what lies behind a cut is not known to a contact before it is over.
  const Plate plate{
      .integrator = explicit_scheme(0.01),
      .still = true,
      .window = 0.01,
      .port = "right",
      .rest = block.text() + "interfaces:\n" + touching("hit", "plate.right", "block.left")};
  const std::string text = plate.text();
  const auto whole = run_document(written(folder.path(), text));
  const double after = whole->measure("body.block.momentum.x");
  EXPECT_GT(after, 0.0);  // it springs back
  for (const int bodies : {2, 3, 4, 6}) {
    SCOPED_TRACE(bodies);
    const auto parts = run_split(folder, text, bodies);
    ASSERT_TRUE(parts->completed());
    // Explicit bodies step differently where they are tied; those that touch do not.
    EXPECT_NEAR(parts->measure("body.block.momentum.x"), after, 1.0e-3 * after);
    EXPECT_NEAR(parts->measure("contact.hit.impulse"), whole->measure("contact.hit.impulse"),
                1.0e-3 * after);
  }
}

/// Expectations follow what they are of: what holds of the whole holds of the parts or is left out.
TEST(SplitBodies, KeepTheExpectationsThatMakeSense) {
  const Folder folder;
  const Plate plate;
  const auto whole = run_document(written(folder.path(), plate.text()));
  std::vector<std::string> expect;
  for (const auto& [measure, value] : whole->measures.values) {
    if (std::isnan(value)) continue;
    const double close = 1.0e-6 * std::abs(value) + same_motion;
    expect.push_back(fmt::format("{{measure: {}, equals: {}, absolute: {}, because: a}}", measure,
                                 number(value), number(close)));
    expect.push_back(
        fmt::format("{{measure: {}, at_most: {}, because: b}}", measure, number(value + close)));
    expect.push_back(
        fmt::format("{{measure: {}, at_least: {}, because: c}}", measure, number(value - close)));
  }
  std::string text = plate.text();
  text.replace(0, text.find('\n'),
               fmt::format("meta: {{title: test, expect: [{}]}}", fmt::join(expect, ", ")));
  for (const int bodies : {2, 3}) {
    SCOPED_TRACE(bodies);
    const fs::path out = folder.path() / fmt::format("expect_{}", bodies);
    const SplitScene parts = split(written(folder.path(), text), bodies, out);
    const Document divided = Document::load(put(parts, out));
    const auto run = run_document(divided);
    const std::vector<Expectation> kept = read_scene(divided).meta.expect;
    EXPECT_GT(kept.size(), 20u);
    for (const ExpectationResult& result : evaluate(kept, run->measures))
      EXPECT_TRUE(result.pass) << result.measure << " is " << result.got << ", expected "
                               << result.expected;
    const auto has = [&kept](const std::string& measure) {
      return std::ranges::any_of(kept, [&](const Expectation& e) { return e.measure == measure; });
    };
    EXPECT_TRUE(has("momentum.total"));
    EXPECT_TRUE(has("body.plate_1.displacement.x.max"));  // as a bound
    EXPECT_TRUE(has("body.plate_2.displacement.x.max"));
    EXPECT_EQ(parts.scene.find("body.plate."), std::string::npos);
    for (const auto& [measure, why] : parts.left_out) EXPECT_FALSE(why.empty()) << measure;
  }
}

TEST(SplitBodies, WhatCannotBeDividedIsRefusedByName) {
  const Folder folder;
  const auto said = [&](const Plate& plate, const std::string& body = "plate") {
    const Document document = written(folder.path(), plate.text());
    return refusal([&] { split(document, 2, folder.path() / "out", body); });
  };
  const auto tool = [](const char* name) {
    return SolidText{.name = name,
                     .mesh = "disk: {radius: 1.0, core: 2, layers: 1}",
                     .side = "mantle",
                     .model = "rigid_tool"}
        .text();
  };
  expect_words(said({}, "disk"), {"has no body disk. Choose one of plate."});
  expect_words(said({.start = "adjust: true"}), {"moves nodes of the whole body"});
  expect_words(said({.integrator = implicit_scheme("quasi_static", 0.02),
                     .still = true,
                     .rest = "contact: {everything: {}}\n"}),
               {"bodies.plate.ports.corner: may touch another body"});
  expect_words(said({.others = tool("plate_1")}), {"is the name that a part would have"});
  expect_words(said({.others = tool("tool")}, "tool"), {"rigid_tool has no cells to deal out"});
}

}  // namespace
}  // namespace abut::split_bodies_tests
