// Goal: every scene of the comparison of methods gives the figures that it states.
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

std::vector<std::string> method_scenes() {
  std::vector<std::string> names;
  const std::filesystem::path folder = std::filesystem::path(ABUT_SOURCE_DIR) / "configs/methods";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class MethodScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Verification, MethodScene, testing::ValuesIn(method_scenes()),
                         [](const auto& scene) { return scene.param; });

TEST_P(MethodScene, MeetsItsOwnExpectations) {
  const Document document = Document::load(std::string(ABUT_SOURCE_DIR) + "/configs/methods/" +
                                           GetParam() + ".yaml");
  const std::unique_ptr<RunResult> r = run_document(document);
  ASSERT_TRUE(r->completed());
  const std::vector<ExpectationResult> results =
      evaluate(read_scene(document).meta.expect, r->measures);
  EXPECT_FALSE(results.empty());
  for (const ExpectationResult& e : results) EXPECT_TRUE(e.pass) << e.measure << " is " << e.got;
}

}  // namespace
}  // namespace abut
