// Goal: contact neither makes nor loses energy over many impacts, whatever the scheme, step, window
// and form. Oracles: energy and momentum, which are constant; the exact solution where numbers are
// exact in binary.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::many_impacts_tests {
namespace {

/// A bar of unit length, wave speed and impedance with one side in contact, or both.
struct Bouncer {
  int elements = 50;
  double cfl = 0.5;
  std::string scheme = "central_difference";  // its keys beside the step follow
  std::string keys;
  std::string layer = "massless: {stiffness_factor: 1.0}";
  double speed = 0.1;
  int window = 5;  // [steps]
  double length = 1.0, modulus = 1.0, weight = 0.0;
  std::string support;
  double position = -0.5;
  std::vector<std::pair<double, std::string>> walls = {{-0.75, "left"}, {0.75, "right"}};

  double step() const { return cfl * length / elements / std::sqrt(modulus); }

  std::string text(double end) const {
    BarText bar =
        unit_bar("bar", length, elements,
                 fmt::format("{}: {{step: {}{}}}", scheme, number(step()), keys), position, speed);
    bar.modulus = modulus;
    bar.layer = layer;
    bar.body_force = -weight;
    bar.fixed = support;
    bar.sides.clear();
    std::string bodies, interfaces;
    for (const auto& [place, side] : walls) {
      const std::string face = side == "left" ? "right" : "left", wall = side + "_wall";
      bar.sides.push_back(side);
      bodies += wall_text(place, face, wall);
      interfaces += touching(side, "bar." + side, wall + "." + face);
    }
    return scene_text(std::round(end / (window * step())) * window * step(), window * step(),
                      bar.text() + bodies,
                      "interfaces:\n" + interfaces + "schwarz: {energy_guard: 0.5}\n");
  }
  ResultPtr run(double end) const { return run_text(text(end)); }
};

/// Largest change of energy less external work, over the most there was in motion; and at the end.
std::pair<double, double> energy_errors(const RunResult& r) {
  return {r.measure("energy.total.relative_drift_max"),
          std::abs(r.measure("energy.total.relative_drift_end"))};
}

TEST(ManyImpacts, BetweenTwoWallsKeepTheEnergyForAnyWindow) {  // catalogue A10
  struct Case {
    double cfl;
    const char* scheme;
    const char* keys;
    const char* layer;
    double most;  // what contact may owe at a time: 1 % explicit, 2 % implicit, and of kicks what
                  // the contact node holds while the bar rattles
  };
  const std::string plain = "massless: {stiffness_factor: 1.0}";
  for (const Case& c : {Case{0.5, "central_difference", "", plain.c_str(), 0.01},
                        {0.9, "central_difference", "", plain.c_str(), 0.01},
                        {0.5, "central_difference", ", dispersion_terms: 6", plain.c_str(), 0.01},
                        {0.5, "central_difference", "", "kick: {}", 0.2},
                        {0.9, "central_difference", ", dispersion_terms: 4", "kick: {}", 0.2},
                        {1.0, "newmark", "", plain.c_str(), 0.02},
                        {1.0, "newmark", ", mass: averaged", plain.c_str(), 0.02}}) {
    for (int window : {1, 5, 100}) {
      Bouncer bar;
      bar.cfl = c.cfl;
      bar.scheme = c.scheme;
      bar.keys = c.keys;
      bar.layer = c.layer;
      bar.window = window;
      const ResultPtr r = bar.run(50 * 14.0);
      const std::string what =
          fmt::format("{} {} {} {} {}", c.cfl, c.scheme, c.keys, c.layer, window);
      ASSERT_TRUE(r->completed()) << what;
      const auto [most, end] = energy_errors(*r);
      EXPECT_LT(most, c.most) << what;
      // At the end contact may still owe what the last event in flight has moved.
      EXPECT_LT(end, r->rows.back().closed ? c.most : 1.0e-6) << what;
      // One arrival in every period; vibration takes up to a tenth of the mean velocity by then,
      // so periods grow, and what rattles at one arrival is one contact or a few.
      EXPECT_GE(r->measure("contact.left.count"), 40.0) << what;
      EXPECT_GE(r->measure("contact.right.count"), 40.0) << what;
    }
  }
}

TEST(ManyImpacts, AreExactWhereNumbersAre) {
  for (int window : {1, 4, 100}) {
    Bouncer bar;
    bar.elements = 64;
    bar.cfl = 1.0;
    bar.layer = "kick: {}";
    bar.speed = 0.125;
    bar.window = window;
    const ResultPtr r = bar.run(50 * 12.0);
    ASSERT_TRUE(r->completed()) << window;
    EXPECT_EQ(r->measure("contact.left.closings"), 50.0) << window;
    EXPECT_EQ(r->measure("contact.right.closings"), 50.0) << window;
    const auto [most, end] = energy_errors(*r);
    EXPECT_LE(most, (1.0 + 1e-12) / (2.0 * 64)) << window;  // half an element's, while it touches
    EXPECT_LT(end, roundoff(1000.0, 1.0)) << window;
  }
}

TEST(ManyImpacts, OfALargeImplicitStepNeitherPumpNorFail) {
  for (double cfl : {2.0, 5.0}) {  // accuracy is gone, stability is not
    Bouncer bar;
    bar.cfl = cfl;
    bar.scheme = "newmark";
    const ResultPtr r = bar.run(100 * 14.0);
    ASSERT_TRUE(r->completed()) << cfl;
    EXPECT_LT(energy_errors(*r).first, 0.3)
        << cfl;  // owed for a while; without paying: 1.2, failed
  }
}

TEST(ManyImpacts, OfADissipativeSchemeLoseWhatTheSchemeLoses) {
  Bouncer bar;
  bar.cfl = 1.0;
  bar.scheme = "generalized_alpha";
  bar.keys = ", spectral_radius: 0.9";
  const ResultPtr r = bar.run(50 * 14.0);
  ASSERT_TRUE(r->completed());
  EXPECT_LT(r->measure("energy.total.relative_drift_end"), -0.1);
}

TEST(ManyImpacts, UnderWeightKeepTheEnergy) {  // catalogue A9, a hundred impacts
  for (const auto& [scheme, cfl] :
       {std::pair("central_difference", 0.4), {"central_difference", 0.9}, {"newmark", 0.9}}) {
    Bouncer bar;
    bar.elements = 100;
    bar.cfl = cfl;
    bar.scheme = scheme;
    bar.length = 10.0;
    bar.modulus = 900.0;
    bar.weight = 10.0;
    bar.speed = 0.0;
    bar.position = 5.0;
    bar.walls = {{0.0, "left"}};
    const ResultPtr r = bar.run(800.0 / 3.0);
    ASSERT_TRUE(r->completed()) << scheme << cfl;
    EXPECT_LT(energy_errors(*r).first, 5.0e-3) << scheme << cfl;
    EXPECT_NEAR(r->measure("contact.left.begin"), 1.0, bar.step()) << scheme << cfl;
  }
}

TEST(ManyImpacts, OfAClampedBarWithAnObstacleKeepTheEnergy) {  // catalogue A8, 300 transits
  for (const char* keys : {"", ", dispersion_terms: 6"}) {
    for (double cfl : {0.4, 0.9}) {
      Bouncer bar;
      bar.cfl = cfl;
      bar.keys = keys;
      bar.layer = "massless: {stiffness_factor: 1.4}";
      bar.speed = -0.5;
      bar.support = "right";
      bar.position = 0.0;
      bar.walls = {{0.0, "left"}};
      const ResultPtr r = bar.run(300.0);
      ASSERT_TRUE(r->completed()) << keys << cfl;
      // 0.2 % is the goal; at CFL 0.9 with six terms what is owed at a time comes to 0.22 %.
      EXPECT_LT(energy_errors(*r).first, 2.5e-3) << keys << cfl;
      EXPECT_LT(energy_errors(*r).second, iteration(1.0e-6)) << keys << cfl;
    }
  }
}

/// Five bars of unit length that touch; the first one comes with velocity 1.
ResultPtr cradle(int elements, int window, const std::string& form) {
  const double step = 0.08 / elements;
  constexpr const char* names[] = {"one", "two", "three", "four", "five"};
  SceneText scene;
  scene.begin = 0.0;
  scene.end = std::round(6.0 / (window * step)) * window * step;
  scene.window = window * step;
  scene.form = "bars: {}";
  for (int b = 0; b < 5; ++b) {
    BarText bar =
        unit_bar(names[b], 1.0, elements, explicit_scheme(step, 6), b, b == 0 ? 1.0 : 0.0);
    bar.layer = BarText().layer;
    bar.sides.clear();
    if (b > 0) bar.sides.push_back("left");
    if (b < 4) bar.sides.push_back("right");
    scene.bars.push_back(bar);
    if (b > 0)
      scene.interfaces.push_back(
          {std::string(names[b - 1]) + ".right", std::string(names[b]) + ".left"});
  }
  scene.schwarz = "form: " + form;
  return run(scene);
}

TEST(TouchingBars, PassTheBlowOnForAnyMeshWindowAndForm) {  // catalogue A6
  // Forerunners of the front come to the next interface at 1e-300 m/s and grow to it.
  for (int elements : {100, 200, 400}) {
    for (int window : {1, 10, 100}) {
      if (elements == 400 && window == 1) continue;  // 10 s
      for (const char* form : {"alternating", "parallel"}) {
        const ResultPtr r = cradle(elements, window, form);
        const std::string what = fmt::format("{} {} {}", elements, window, form);
        ASSERT_TRUE(r->completed()) << what;
        for (const char* name : {"first", "second", "third", "fourth"})
          EXPECT_EQ(r->measure(fmt::format("contact.{}.closings", name)), 1.0) << what << name;
        // It leaves at 5, 2 after it was hit; the release is early by dispersion, about a cell.
        EXPECT_NEAR(r->measure("contact.fourth.release_error"), 0.0, 0.6 / elements) << what;
        EXPECT_NEAR(r->velocity(4), 1.0, 0.3 / elements) << what;
        // Four contacts, closed in one window and opened in another.
        EXPECT_LT(energy_errors(*r).first, iteration(1.0e-6, 8.0)) << what;
        EXPECT_LE(r->measure("schwarz.iterations_max"), 3.0) << what;
      }
    }
  }
}

}  // namespace
}  // namespace abut::many_impacts_tests
