// Goal: how many contacts a row of bars has does not depend on the order in which a scene names
// them, nor on who finds contact. Oracle: the same row in another order, in other roles; impulses
// tell that the trajectories agree.

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::contacts_in_rows_tests {
namespace {

/// 3 to 5 bars of unlike steps, some of them touching, of which the first strikes.
std::vector<BarText> row_of(unsigned seed) {
  std::mt19937 dice(seed);
  const auto one_of = [&dice](const std::vector<double>& values) {
    return values[dice() % values.size()];
  };
  std::vector<BarText> bars(3 + dice() % 3);
  // Alike and touching, they come to rest beside each other; others hit each other again and again.
  const bool alike = seed % 2 == 0;
  double end = 0.0;
  for (std::size_t k = 0; k < bars.size(); ++k) {
    BarText& bar = bars[k] = unit_bar(fmt::format("b{}", k), 1.0, 1, "", end);
    bar.layer.clear();
    bar.sides = {"left", "right"};
    bar.length = alike ? one_of({1.0, 1.0, 0.5}) : one_of({1.0, 0.5, 0.7});
    bar.density = alike ? one_of({1.0, 1.0, 1.0, 2.0}) : one_of({1.0, 1.0, 2.0});
    const double step = one_of({0.004, 0.002, 0.001, 0.0004});
    bar.elements = static_cast<int>(bar.length * one_of({50.0, 100.0, 200.0}));
    const bool implicit = !alike && one_of({0.0, 1.0}) > 0.0;
    bar.integrator = implicit_scheme(implicit ? "newmark" : "central_difference", step);
    bar.velocity = k == 0 ? 1.0 : one_of({0.0, 0.0, 0.0, -0.5});
    end += bar.length + (alike ? one_of({0.0, 0.0, 0.0, 0.02}) : one_of({0.0, 0.02, 0.1}));
  }
  return bars;
}

enum class Roles { open, left, right };

std::string scene(const std::vector<BarText>& bars, bool reversed, Roles roles) {
  std::string bodies, interfaces = "interfaces:\n";
  for (std::size_t k = 0; k < bars.size(); ++k)
    bodies += bars[reversed ? bars.size() - 1 - k : k].text();
  for (std::size_t k = 0; k + 1 < bars.size(); ++k) {
    const std::string left = bars[k].name + ".right", right = bars[k + 1].name + ".left";
    const std::string kinematic = roles == Roles::open   ? "auto"
                                  : roles == Roles::left ? left
                                                         : right;
    interfaces +=
        touching(fmt::format("i{}", k), reversed ? right : left, reversed ? left : right,
                 fmt::format(", transmission: {{unilateral: {{kinematic: {}}}}}", kinematic));
  }
  return scene_text(3.0, 0.04, bodies, interfaces);
}

TEST(ContactsInRows, AreAsManyInAnyOrderAndRole) {
  int pushes = 0, stopped = 0;
  for (unsigned seed = 0; seed < 80; ++seed) {
    const std::vector<BarText> bars = row_of(seed);
    std::vector<double> counts, impulses;
    for (const bool reversed : {false, true}) {
      for (const Roles roles : {Roles::open, Roles::left, Roles::right}) {
        SCOPED_TRACE(
            fmt::format("row {} order {} roles {}", seed, reversed, static_cast<int>(roles)));
        const auto run = run_text(scene(bars, reversed, roles));
        if (!run->completed()) {  // the guard stops what unlike steps make of some coarse meshes
          ++stopped;
          continue;
        }
        std::vector<double> count, impulse;
        for (std::size_t k = 0; k + 1 < bars.size(); ++k) {
          count.push_back(run->measure(fmt::format("contact.i{}.count", k)));
          impulse.push_back(run->measure(fmt::format("contact.i{}.impulse", k)));
        }
        if (counts.empty()) {
          counts = count;
          impulses = impulse;
        }
        EXPECT_EQ(count, counts);
        // The coarsest meshes have 25 elements: trajectories agree to a per cent of the impulse of
        // a unit bar, 1.
        for (std::size_t k = 0; k < impulse.size(); ++k)
          EXPECT_NEAR(impulse[k], impulses[k], 2.0e-2) << "of interface " << k;
      }
    }
    for (const double count : counts) pushes += static_cast<int>(count);
  }
  EXPECT_LT(stopped, 20);  // of 480 runs
  EXPECT_GT(pushes, 200);  // of some 240 interfaces
}

}  // namespace
}  // namespace abut::contacts_in_rows_tests
