// Goal: `*` in a key path of the command line is every key at its place. Oracle: the same keys
// written one by one.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/yaml_document.hpp"
#include "base/yaml_tree.hpp"
#include "tests/support/refusal.hpp"

namespace abut::test_yaml_stars {
namespace {

const std::string scene =
    "bodies:\n"
    "  a: {integrator: {newmark: {step: 1}}, initial: {velocity: [1], field: [x]}}\n"
    "  b: {integrator: {central_difference: {step: 2}}, initial: {velocity: [2]}}\n"
    "  wall: {model: rigid_wall, layer: kick}\n"
    "  same: {like: a}\n";

using Overrides = std::vector<std::string>;

/// As the tree of all bodies reads.
std::string tree(const Overrides& overrides) {
  std::string text;
  const Document document = Document::from_text("s.yaml", scene, overrides);
  for (const std::string& body : document.keys("bodies")) {
    for (const char* key :
         {"integrator.newmark.step", "integrator.central_difference.step", "integrator.hht.step",
          "initial.velocity", "initial.field", "body_force", "layer.kick.factor"}) {
      const std::string path = "bodies." + body + "." + key;
      const auto found = document.tree().find(path);
      if (!found) continue;
      text += path + "=";
      for (const auto& item : *found) text += item.Scalar() + " ";
      text += found->IsScalar() ? found->Scalar() + "\n" : "\n";
    }
  }
  return text;
}

TEST(Stars, AreEveryKeyAtTheirPlace) {
  const struct {
    Overrides stars, plain;
  } cases[] = {
      {{"bodies.*.integrator.*.step=3"},
       {"bodies.a.integrator.newmark.step=3", "bodies.b.integrator.central_difference.step=3"}},
      {{"bodies.*.initial.*=[7]"},
       {"bodies.a.initial.velocity=[7]", "bodies.a.initial.field=[7]",
        "bodies.b.initial.velocity=[7]"}},
      // The last key need not be there.
      {{"bodies.*.body_force=[1]"},
       {"bodies.a.body_force=[1]", "bodies.b.body_force=[1]", "bodies.wall.body_force=[1]",
        "bodies.same.body_force=[1]"}},
      {{"bodies.*.initial.field=null"}, {"bodies.a.initial.field=null"}},
      // Each in the text that those before it have left; the last word counts.
      {{"bodies.a.integrator={hht: {step: 1}}", "bodies.*.integrator.*.step=5"},
       {"bodies.a.integrator={hht: {step: 5}}", "bodies.b.integrator.central_difference.step=5"}},
      {{"bodies.*.body_force=[1]", "bodies.b.body_force=[2]"},
       {"bodies.a.body_force=[1]", "bodies.b.body_force=[2]", "bodies.wall.body_force=[1]",
        "bodies.same.body_force=[1]"}},
      {{"bodies.b.initial.velocity=[4]", "bodies.*.initial.velocity=[5]"},
       {"bodies.a.initial.velocity=[5]", "bodies.b.initial.velocity=[5]"}},
      // A choice that is written as its name alone.
      {{"bodies.*.layer.*.factor=2"}, {"bodies.wall.layer={kick: {factor: 2}}"}},
      {{"bodies.wall.layer.kick.factor=2"}, {"bodies.wall.layer={kick: {factor: 2}}"}}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.stars.back());
    EXPECT_EQ(tree(c.stars), tree(c.plain));
    EXPECT_NE(tree(c.stars), tree({}));
  }
}

TEST(Stars, AreWrittenOutForAnotherProcess) {
  const Document document = Document::from_text("s.yaml", scene, {"bodies.*.integrator.*.step=3"});
  EXPECT_EQ(document.overrides(), (Overrides{"bodies.a.integrator.newmark.step=3",
                                             "bodies.b.integrator.central_difference.step=3"}));
}

TEST(Stars, ThatMeanNothingAreRefusedWithTheNearest) {
  const auto said = [](const std::string& override_text) {
    return refusal([&] { Document::from_text("s.yaml", scene, {override_text}); });
  };
  EXPECT_EQ(said("bodies.*.integratr.*.step=3"),
            "--set bodies.*.integratr.*.step=3: matches no key of the scene: bodies.a and others "
            "has no integratr. The nearest is integrator.");
  EXPECT_NE(said("bodys.*.step=3").find("it has no bodys. The nearest is bodies."),
            std::string::npos);
  EXPECT_NE(said("bodies.*.initial.nothing=null").find("Keys there are velocity, field."),
            std::string::npos);
  EXPECT_NE(said("bodies.*.initial.velocity.*=3").find("has no keys"), std::string::npos);
}

}  // namespace
}  // namespace abut::test_yaml_stars
