// Goal: bodies that are like others replace a choice as a whole. Oracle: the reference, which the
// keys themselves print.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <span>
#include <sstream>
#include <string>

#include "base/fields_reference.hpp"
#include "base/yaml_like.hpp"
#include "coordinator/launch_local.hpp"

namespace abut::scene_choices_tests {
namespace {

/// keys.
TEST(BodyChoices, AreThoseThatLikeKnows) {
  Reference reference;
  reference.add<Scene>("", "");
  document_body_keys(reference);
  std::istringstream lines(reference.markdown());
  std::set<std::string> found;
  for (std::string line; std::getline(lines, line);) {
    std::smatch row;
    if (std::regex_match(line, row, std::regex("\\| `bodies\\.<name>\\.(.*)` \\| choice of .*")))
      found.insert(std::regex_replace(row[1].str(), std::regex("^model\\.[^.]+"), "model.*"));
  }
  const std::span<const std::string_view> known = body_choices();
  EXPECT_EQ(found, std::set<std::string>(known.begin(), known.end()));
}

}  // namespace
}  // namespace abut::scene_choices_tests
