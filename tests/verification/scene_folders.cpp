// Goal: every scene in a folder of its own (the comparison of methods, bars in rows) gives the
// figures that it states.
// Oracle: the scene's own expectations, each with its reason.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/record/expectations.hpp"
#include "tests/support/runs.hpp"

namespace abut {
namespace {

std::vector<std::string> scenes_of(const std::string& folder) {
  std::vector<std::string> names;
  const std::filesystem::path configs = std::filesystem::path(ABUT_SOURCE_DIR) / "configs";
  for (const auto& entry : std::filesystem::directory_iterator(configs / folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void expect_own_figures(const std::string& scene) {
  const Document document =
      Document::load(std::string(ABUT_SOURCE_DIR) + "/configs/" + scene + ".yaml");
  const std::unique_ptr<RunResult> r = run_document(document);
  ASSERT_TRUE(r->completed());
  const std::vector<ExpectationResult> results =
      evaluate(read_scene(document).meta.expect, r->measures);
  EXPECT_FALSE(results.empty());
  for (const ExpectationResult& e : results) EXPECT_TRUE(e.pass) << e.measure << " is " << e.got;
}

class MethodScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Verification, MethodScene, testing::ValuesIn(scenes_of("methods")),
                         [](const auto& scene) { return scene.param; });

TEST_P(MethodScene, MeetsItsOwnExpectations) { expect_own_figures("methods/" + GetParam()); }

class BarScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Verification, BarScene, testing::ValuesIn(scenes_of("bars")),
                         [](const auto& scene) { return scene.param; });

TEST_P(BarScene, MeetsItsOwnExpectations) { expect_own_figures("bars/" + GetParam()); }

}  // namespace
}  // namespace abut
