// Goal: nodes that meet up to the digits of a mesh file are tied as if they met. Rows of points
// that supports hold on both sides, and of an edge at which three bodies meet, reach a little of
// what is free beside them, and must have no forces for it. Oracle: the same bodies, exact.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::tied_digits_tests {
namespace {

/// The largest force of every interface [N].
struct Forces : Observer {
  void on_window(const WindowReport& report) override {
    most.resize(report.interfaces.size(), 0.0);
    for (std::size_t k = 0; k < most.size(); ++k)
      most[k] = std::max(most[k], report.interfaces[k].force);
    windows += report.interfaces[1].iterations > 0 ? 1 : 0;
  }
  std::vector<double> most;
  int windows = 0;  // that were iterated
};

SolidText block(const std::string& name, const std::vector<double>& place,
                const std::vector<double>& lengths, const std::vector<int>& cells,
                const std::string& element = "hex8") {
  const bool hammer = name == "hammer";
  return {.name = name,
          .material = fmt::format("linear_elastic: {{youngs_modulus: {:.1e}, poissons_ratio: 0.3, "
                                  "density: {:.1e}}}",
                                  hammer ? 1.0e9 : 1.0e7, hammer ? 3.0e3 : 1.0e3),
          .integrator = "newmark: {step: 2.0e-5}",
          .position = place,
          .velocity = {0.0, hammer ? -10.0 : 0.0, 0.0},
          .sides = {"left", "right", "top", "bottom"},
          .block = {lengths, cells, element}};
}

/// A post, beside it a plinth and on that a slab, all joined; a hammer of one cell hits the slab.
/// Post and plinth stand on the ground. The post's mesh is sheared by so much.
Forces run(double sheared) {
  const std::string held = "    constraints: {foot: {on: bottom, fixed: true}}\n";
  SolidText post = block("post", {0.0, 0.0, 0.0}, {0.06, 0.06, 0.4}, {2, 2, 2}, "tet4"),
            plinth = block("plinth", {0.06, 0.0, 0.0}, {0.1, 0.026, 0.4}, {1, 1, 2});
  post.keys = fmt::format("map: [\"x + {0} * y\", \"y + {0} * z\", \"z + {0} * x\"], ", sheared);
  post.more = plinth.more = held;
  const SolidText slab = block("slab", {0.06, 0.026, 0.0}, {0.1, 0.034, 0.4}, {2, 2, 1}),
                  hammer = block("hammer", {0.1, 0.0603, 0.1}, {0.05, 0.1, 0.1}, {1, 1, 1});
  const std::string text = scene_text(
      2.0e-3, 2.0e-5, post.text() + plinth.text() + slab.text() + hammer.text(),
      "interfaces:\n  hit: {sides: [slab.top, hammer.bottom], contact: {}}\n" +
          joined("foot", "post.right", "plinth.left") + joined("side", "post.right", "slab.left") +
          joined("seat", "plinth.top", "slab.bottom"));
  Forces forces;
  const ResultPtr run = run_text(text, &forces);
  EXPECT_TRUE(run->completed()) << run->end.reason;
  EXPECT_GT(run->end.given_up.windows, 0);  // both ways are gone
  EXPECT_GT(forces.windows, 0);
  return forces;
}

class TiedDigits : public testing::TestWithParam<double> {};

TEST_P(TiedDigits, AreNoForces) {
  const std::vector<double> exact = run(0.0).most, sheared = run(GetParam()).most;
  // Of the bodies' shape as much as of an edge of 0.026 m the far end of 0.4 m moves, and the
  // largest force over time changes by 5.9 times that, in proportion from 1e-7 to 1e-5: ten times.
  const double tolerance = std::max(1.0e-6, 10.0 * GetParam() * 0.4 / 0.026);
  ASSERT_EQ(exact.size(), sheared.size());
  for (std::size_t k = 0; k < exact.size(); ++k)
    EXPECT_NEAR(sheared[k], exact[k], tolerance * exact[k]) << k;
}

// Round-off, the digits of most files, and of files with few.
INSTANTIATE_TEST_SUITE_P(Shears, TiedDigits, testing::Values(1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5));

}  // namespace
}  // namespace abut::tied_digits_tests
