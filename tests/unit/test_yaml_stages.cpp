// Goal: the scene of a stage is what the text says: the scene's keys, the stage's over them, from
// the end of the stage before. Oracle: the same scene, written out.

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/yaml_differences.hpp"
#include "base/yaml_document.hpp"

namespace abut::test_yaml_stages {
namespace {

const std::string scene = R"(units: SI
time: {begin: 0 s, end: 1 s, window: 0.1}
bodies:
  a:
    integrator: {quasi_static: {step: 0.1}}
    equations: {tolerance: 1e-9}
    ports: {tip: {side: right}}
  b: {like: a, equations: null, ports: {tip: {side: left}}}
  c: {copies: {grid: {count: [2, 1, 1], spacing: [1, 1, 1]}}, integrator: {newmark: {step: 0.1}}}
interfaces: {i: {sides: [a.tip, b.tip], contact: {friction: "0.3"}}}
schwarz: {tolerance: 1e-9, max_iterations: 50}
stages:
  hit:
    time: {end: 2 s, window: 1e-3}
    bodies: {a: {integrator: {central_difference: {step: 1e-3}}}}
    schwarz: {tolerance: null}
  rest: {time: {end: 3 s}, bodies: {a: {integrator: {newmark: {step: 0.5}}}}}
)";

/// The keys of two documents beside `stages`, as the first differences between them.
std::vector<std::string> keys_that_differ(const Document& one, const std::string& other) {
  std::vector<std::string> keys;
  for (const Difference& each : differences(other, one.text())) keys.push_back(each.key);
  return keys;
}

TEST(Stages, HaveTheirKeysOverThoseOfTheScene) {
  const Document first = Document::from_text("s.yaml", scene);
  const std::optional<Document> hit = first.next_stage();
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->name(), "s.yaml, stage hit");
  const std::string expected = R"(units: SI
time: {begin: 1 s, end: 2 s, window: 1e-3}
bodies:
  a:
    integrator: {central_difference: {step: 1e-3}}
    initial: {after_statics: true}
    ports: {tip: {side: right}}
  b: {like: a, equations: null, ports: {tip: {side: left}}}
  c: {copies: {grid: {count: [2, 1, 1], spacing: [1, 1, 1]}}, integrator: {newmark: {step: 0.1}}}
interfaces: {i: {sides: [a.tip, b.tip], contact: {friction: "0.3"}}}
schwarz: {max_iterations: 50}
stages:
  rest: {time: {end: 3 s}, bodies: {a: {integrator: {newmark: {step: 0.5}}}}}
)";
  EXPECT_EQ(keys_that_differ(*hit, expected), std::vector<std::string>{});
  EXPECT_TRUE(hit->has("bodies.b.integrator.central_difference")) << "b is like a";
  EXPECT_TRUE(hit->has("bodies.b.initial.after_statics"));
  EXPECT_FALSE(hit->has("bodies.c_1.initial.after_statics")) << "it moved before";
  EXPECT_TRUE(hit->has("bodies.c_1.integrator.newmark") && hit->has("bodies.c_2"));
  const std::optional<Document> rest = hit->next_stage();
  ASSERT_TRUE(rest);
  EXPECT_TRUE(rest->has("bodies.a.integrator.newmark"));
  EXPECT_FALSE(rest->has("bodies.a.integrator.central_difference")) << "another choice, instead";
  EXPECT_TRUE(rest->has("bodies.a.initial.after_statics")) << "as long as it moves";
  EXPECT_FALSE(rest->has("stages"));
  EXPECT_FALSE(rest->next_stage());
}

TEST(Stages, TakeOverridesOfTheSceneAndOfTheirOwn) {
  const Document first =
      Document::from_text("s.yaml", scene,
                          {"schwarz.max_iterations=7", "stages.hit.time.window=2e-3",
                           "bodies.c_2.ports={p: x}", "stages.rest=null"});
  const std::optional<Document> hit = first.next_stage();
  ASSERT_TRUE(hit);
  std::vector<std::string> shown;
  for (const Difference& each : differences(scene, hit->text()))
    if (each.key == "schwarz.max_iterations" || each.key == "time.window")
      shown.push_back(each.now);
  EXPECT_EQ(shown, (std::vector<std::string>{"2e-3", "7"}));
  EXPECT_TRUE(hit->has("bodies.c_2.ports.p")) << "of one copy";
  EXPECT_FALSE(hit->has("bodies.c_1.ports"));
  EXPECT_FALSE(hit->next_stage());
}

TEST(Stages, AreNoneWhereASceneHasNone) {
  EXPECT_FALSE(Document::from_text("s.yaml", "time: {end: 1}").next_stage());
}

TEST(Stages, WaitForTheirOwnEventsAlone) {
  const Document first = Document::from_text("s.yaml", R"(
time: {end: 1, window: 0.1, until: {contact: blow}}
stages:
  hit: {time: {end: 2, until: {apart: blow}}}
  rest: {time: {end: 3}}
)");
  const std::optional<Document> hit = first.next_stage();
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->has("time.until.apart"));
  EXPECT_FALSE(hit->has("time.until.contact"));
  const std::optional<Document> rest = hit->next_stage();
  ASSERT_TRUE(rest);
  EXPECT_FALSE(rest->has("time.until"));
}

TEST(Stages, HaveAnotherModelInPlaceOfTheBodys) {
  const Document first = Document::from_text("s.yaml", R"(
time: {end: 1, window: 0.1}
bodies:
  a: {model: {rigid: {dimension: 2, mesh: {disk: {radius: 1}}}}}
  b: {model: {fe: {dimension: 2, mesh: {rectangle: {lengths: [1, 1], elements: [2, 2]}}}}}
stages:
  hit:
    time: {end: 2}
    bodies:
      a: {model: {fe: {dimension: 2, mesh: {disk: {radius: 1}}}}}
      b: {model: {fe: {mesh: {rectangle: {elements: [4, 4]}}}}}
)");
  const std::optional<Document> hit = first.next_stage();
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->keys("bodies.a.model"), std::vector<std::string>{"fe"});
  EXPECT_TRUE(hit->has("bodies.b.model.fe.mesh.rectangle.lengths")) << "keys that stay";
}

}  // namespace
}  // namespace abut::test_yaml_stages
