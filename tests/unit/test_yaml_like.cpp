// Goal: a body is written once and used again with differences. Oracles: the body written out by
// hand; the place in the text where a key stands; the exact text of refusals.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "base/error.hpp"
#include "base/yaml_document.hpp"
#include "tests/support/refusal.hpp"

namespace abut::test_yaml_like {
namespace {

constexpr const char* scene = R"(bodies:
  right:
    like: middle
    initial: {velocity: [2.0]}
  left:
    model: {fe: {dimension: 1, mesh: {bar: {length: 1.0, area: 2.0}}}}
    material: {steel: {density: 3.0, modulus: 4.0}}
    integrator: {newmark: {step: 5.0, beta: 0.25}}
    initial: {position: [0.0], velocity: [1.0]}
    ports: {tip: {side: right}}
  middle:
    like: left
    model: {fe: {mesh: {bar: {length: 6.0}}}}
    material: {steel: {modulus: 7.0}}
    integrator: {central_difference: {step: 8.0}}
    initial: {position: [9.0]}
    ports: {tail: {side: left}}
    supports: {left: fixed}
)";

Document document(std::vector<std::string> overrides = {}) {
  return Document::from_text("s.yaml", scene, std::move(overrides));
}

/// A body in one line, its keys in their order.
std::string body(const Document& text, const std::string& name) {
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << YAML::Clone(text.root()["bodies"][name]);
  std::string line;
  for (const char letter : std::string(out.c_str()))
    if (letter != '\n' && letter != ' ') line += letter;
  return line;
}

std::string refusal(const std::string& text, std::vector<std::string> overrides = {}) {
  return abut::refusal([&] { Document::from_text("s.yaml", text, overrides); });
}

TEST(Like, MapsAreMergedAndTheRestReplaces) {
  EXPECT_EQ(body(document(), "middle"),
            "{model:{fe:{dimension:1,mesh:{bar:{length:6.0,area:2.0}}}},"
            "material:{steel:{density:3.0,modulus:7.0}},"
            "integrator:{central_difference:{step:8.0}},"
            "initial:{position:[9.0],velocity:[1.0]},"
            "ports:{tip:{side:right},tail:{side:left}},"
            "like:left,supports:{left:fixed}}");
}

TEST(Like, GoesOnThroughSeveralBodies) {
  EXPECT_EQ(body(document(), "right"),
            "{model:{fe:{dimension:1,mesh:{bar:{length:6.0,area:2.0}}}},"
            "material:{steel:{density:3.0,modulus:7.0}},"
            "integrator:{central_difference:{step:8.0}},"
            "initial:{position:[9.0],velocity:[2.0]},"
            "ports:{tip:{side:right},tail:{side:left}},"
            "supports:{left:fixed},like:middle}");
}

TEST(Like, AChoiceOfTheSameNameIsMerged) {
  const Document text = document({"bodies.middle.integrator={newmark: {step: 8.0}}"});
  EXPECT_TRUE(text.has("bodies.middle.integrator.newmark.beta"));
  EXPECT_TRUE(
      document({"bodies.middle.integrator=newmark"}).chooses("bodies.right.integrator", "newmark"));
  EXPECT_FALSE(
      document({"bodies.middle.integrator=newmark"}).has("bodies.middle.integrator.newmark"));
}

TEST(Like, NullLeavesAKeyOut) {
  const Document text = Document::from_text(
      "s.yaml", "bodies: {a: {x: 1, y: {z: 2, w: 3}}, b: {like: a, x: null, y: {z: null}}}");
  EXPECT_EQ(body(text, "b"), "{y:{w:3},like:a}");
  const Document set = document({"bodies.middle.material=null"});
  EXPECT_FALSE(set.has("bodies.middle.material"));
  EXPECT_TRUE(set.has("bodies.left.material"));
}

TEST(Like, OverridesChangeTheTextAndWhatABodyHasFromAnother) {
  EXPECT_EQ(body(document({"bodies.left.model=none"}), "right").substr(0, 12), "{model:{fe:{");
  EXPECT_NE(body(document({"bodies.left.initial.velocity=[3.5]"}), "middle").find("[3.5]"),
            std::string::npos);
  const Document own = document({"bodies.middle.initial.velocity[0]=3.5"});
  EXPECT_NE(body(own, "middle").find("[3.5]"), std::string::npos);
  EXPECT_EQ(body(own, "left").find("[3.5]"), std::string::npos);
  EXPECT_FALSE(document({"bodies.right.like=null"}).has("bodies.right.model"));
  EXPECT_EQ(refusal(scene, {"bodies.middle.initial.velocity[1]=3.5"}),
            "--set bodies.middle.initial.velocity[1]=3.5: has no place in the scene. Name an item "
            "that the list has, counted from 0.");
}

TEST(Like, KeysAreLocatedWhereTheyStand) {
  const Document text = document();
  EXPECT_EQ(text.where("bodies.middle.material.steel.modulus"),
            "s.yaml:14: bodies.middle.material.steel.modulus");
  EXPECT_EQ(text.where("bodies.middle.material.steel.density"),
            "s.yaml:7: bodies.middle.material.steel.density (like left)");
  EXPECT_EQ(text.where("bodies.right.material.steel.modulus"),
            "s.yaml:14: bodies.right.material.steel.modulus (like middle)");
  EXPECT_EQ(text.where("bodies.right.initial.velocity"), "s.yaml:4: bodies.right.initial.velocity");
  EXPECT_EQ(text.where("bodies.right.like"), "s.yaml:3: bodies.right.like");
  EXPECT_EQ(text.where("bodies.right.loads"), "s.yaml:2: bodies.right.loads");  // nobody has it
  EXPECT_EQ(text.where("bodies.left.ports.tip"), "s.yaml:10: bodies.left.ports.tip");
  const Document set = document({"bodies.left.material.steel.density=1"});
  EXPECT_EQ(set.where("bodies.right.material.steel.density"),
            "s.yaml, from --set bodies.left.material.steel.density=1: "
            "bodies.right.material.steel.density (like left)");
}

TEST(Like, RefusesNamesThatLeadNowhere) {
  EXPECT_EQ(refusal("bodies:\n  a: {like: [b]}"),
            "s.yaml:2: bodies.a.like: must be the name of a body, but is a list. Name another body "
            "of the scene.");
  EXPECT_EQ(refusal("bodies:\n  a: {like: b}\n  b: {like: c}\n  c: {like: b}"),
            "s.yaml:3: bodies.b.like: leads round in a circle: b, c, b. Write one of these bodies "
            "out.");
}

/// A list of bodies that share much is read as often as there are bodies.
TEST(Like, RefusesMoreThanAnySceneHolds) {
  std::string text = "bodies:\n  a: {x: [";
  for (int i = 0; i < 300; ++i) text += "1,";
  text += "1]}\n";
  for (int i = 0; i < 1000; ++i) text += "  b" + std::to_string(i) + ": {like: a}\n";
  EXPECT_EQ(refusal(text),
            "s.yaml:1: bodies: holds too many values, written out. Give large data in files of "
            "their own, such as meshes.");
  std::string chain = "bodies:\n  b0: {x: 1}\n";  // long ones are no matter
  for (int i = 1; i < 2000; ++i)
    chain += "  b" + std::to_string(i) + ": {like: b" + std::to_string(i - 1) + "}\n";
  EXPECT_EQ(refusal(chain), "not refused");
}

}  // namespace
}  // namespace abut::test_yaml_like
