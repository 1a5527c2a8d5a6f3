// Goal: a run goes on with another scene only where that can be meant. Oracle: the lists of
// docs/USE.md, key by key.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_differences.hpp"
#include "coordinator/scene_changes.hpp"

namespace abut::test_scene_changes {
namespace {

const std::string scene = R"(
meta: {title: "a", expect: [{measure: m, equals: 1}]}
time: {begin: 0.0, end: 1.0, window: 0.1}
bodies:
  a:
    launch: {spawn: {program: ""}}
    material: {linear_elastic: {youngs_modulus: 2.0}}
    integrator: {trapezoidal: {step: 0.1}}
schwarz: {tolerance: 1e-6, form: alternating}
output: {records_per_window: 1, force_filter: {mean: {time: 0.1}}}
network: {processes: 0}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& now, const std::vector<std::string>& overrides = {}) {
  try {
    check_changes(scene, now, overrides);
  } catch (const InputErrorList& errors) {
    return errors.all.at(0).what();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SceneChanges, OfWhatNoStateDependsOnAreTaken) {
  EXPECT_EQ(refusal(scene), "accepted");
  const std::vector<std::pair<std::string, std::string>> changes{
      {"title: \"a\"", "title: b"},
      {", expect: [{measure: m, equals: 1}]", ""},
      {"end: 1.0", "end: 2.0"},
      {"spawn: {program: \"\"}", "connect: {patience: 3}"},
      {"records_per_window: 1", "records_per_window: 5, fields: {every: 3}"},
      {"processes: 0", "processes: 2"}};
  for (const auto& [from, to] : changes)
    EXPECT_EQ(refusal(replaced(scene, from, to)), "accepted") << to;
}

TEST(SceneChanges, OfTheMotionAreRefusedWithBothValues) {
  const std::string words = refusal(replaced(scene, "youngs_modulus: 2.0", "youngs_modulus: 3.0"));
  EXPECT_NE(words.find("bodies.a.material.linear_elastic.youngs_modulus: was 2.0 when the "
                       "checkpoint was written, and is 3.0"),
            std::string::npos)
      << words;
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"begin: 0.0", "begin: 0.1"},
           {"form: alternating", "form: parallel"},
           {"{mean: {time: 0.1}}", "{mean: {time: 0.2}}"},
           {", force_filter: {mean: {time: 0.1}}", ""},
           {"integrator: {trapezoidal: {step: 0.1}}", "integrator: {newmark: {step: 0.1}}"},
           {"schwarz:", "gravity: 9.81\nschwarz:"}})
    EXPECT_NE(refusal(replaced(scene, from, to)), "accepted") << to;
}

TEST(SceneChanges, OfStepsAreTakenWhereTheCommandSaysSo) {
  const std::string finer =
      replaced(replaced(scene, "window: 0.1", "window: 0.05"), "step: 0.1", "step: 0.05");
  const std::vector<std::string> says{"time.window=0.05",
                                      "bodies.a.integrator.trapezoidal.step=0.05"};
  EXPECT_NE(refusal(finer).find("Say so with --set"), std::string::npos) << refusal(finer);
  EXPECT_NE(refusal(finer, std::vector<std::string>{says[0]}), "accepted");
  EXPECT_EQ(refusal(finer, says), "accepted");
  const std::string stiffer = replaced(scene, "youngs_modulus: 2.0", "youngs_modulus: 3.0");
  EXPECT_NE(
      refusal(stiffer,
              std::vector<std::string>{"bodies.a.material.linear_elastic.youngs_modulus=3.0"}),
      "accepted");
}

TEST(SceneChanges, AreFoundKeyByKey) {
  const std::vector<Difference> found =
      differences("a: {b: 1, c: [1, 2]}\nd: x", "a: {b: 2, c: [1, 3], e: {f: 1}}\ng: y");
  std::vector<std::string> keys;
  for (const Difference& each : found) keys.push_back(each.key);
  EXPECT_EQ(keys, (std::vector<std::string>{"a.b", "a.c", "a.e", "d", "g"}));
  EXPECT_EQ(found[2].before, "");
  EXPECT_EQ(found[3].now, "");
}

}  // namespace
}  // namespace abut::test_scene_changes
