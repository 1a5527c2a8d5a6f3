// Goal: a sweep that goes astray does not let the ones after it pass as converged.
// Oracle: a plate that is clamped by 20 kN: nothing of the scene could press it with a hundred
// times as much. With steps of 20 ms and roles that suit none of its three bodies, sweeps go as far
// as 1e8 N.

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::astray_sweeps_tests {
namespace {

std::string slow_bolted_joint() {
  std::ifstream file(std::string(ABUT_SOURCE_DIR) + "/configs/contact/bolted_joint_slips.yaml");
  std::stringstream text;
  text << file.rdbuf();
  std::string scene = text.str();
  const auto replace = [&scene](const std::string& old, const std::string& by) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = scene.find(old, at)) != std::string::npos; at += by.size()) {
      scene.replace(at, old.size(), by);
      ++found;
    }
    EXPECT_GT(found, 0u) << old;
  };
  replace("../meshes", std::string(ABUT_SOURCE_DIR) + "/configs/meshes");
  replace("100 * t", "t");
  replace("2.0e-4", "0.02");
  replace("end: 0.04", "end: 4.0");
  replace(", transmission: {unilateral: {kinematic: plate.lid}}", "");
  replace(", transmission: {unilateral: {kinematic: plate.sole}}", "");
  return scene;
}

TEST(AstraySweeps, LetNoLaterOnePass) {
  const auto result = run_text(slow_bolted_joint());
  EXPECT_LT(result->measure("contact.joint.force_peak"), 2.0e6);
}

}  // namespace
}  // namespace abut::astray_sweeps_tests
