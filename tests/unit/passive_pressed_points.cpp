// Goal: points that rows press on have their places among the values of their body in the order of
// its ports, whichever rows came first. Oracle: places counted from the list of all points.

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/passive/pressed_points.hpp"
#include "tests/support/solid_texts.hpp"

namespace abut::passive_pressed_points_tests {
namespace {

SolidText block(const std::string& name, int cells) {
  return {.name = name,
          .material = unit_law("linear_elastic", 0.3),
          .integrator = "rigid_motion: {step: 0.1}",
          .side = "boundary",
          .model = "rigid",
          .block = {{1.0, 1.0, 1.0}, {cells, cells, cells}}};
}

DistanceRow row(std::int32_t node, std::int32_t on) {
  DistanceRow out;
  out.features = {FeatureKind::node_facet, {node, on, on + 1, on + 2}};
  out.weights = {1.0, -0.5, 0.0, -0.5};
  return out;
}

TEST(PressedPoints, AreInTheOrderOfPortsWhicheverRowCameFirst) {
  const std::unique_ptr<Subdomain> one = build(block("one", 6)), other = build(block("other", 5));
  Bodies bodies({one.get(), other.get()});
  const TouchingSurfaces surfaces(std::vector<TouchingPair>{{{Side{0, 0}, Side{1, 0}}, 0.3}},
                                  bodies);
  std::vector<std::vector<std::int32_t>> of(2);
  for (std::int32_t p = 0; p < static_cast<std::int32_t>(surfaces.count()); ++p)
    of[index(surfaces[p].body)].push_back(p);
  PressedPoints points(surfaces, {0, 1});
  points.clear();
  std::vector<char> pressed(surfaces.count(), 0);
  const auto press = [&](std::size_t k) {  // the k-th from behind, on one that is far from it
    const std::int32_t node = of[0][of[0].size() - 1 - k],
                       on = of[1][(37 * k) % (of[1].size() - 2)];
    points.add(row(node, on));
    for (const std::int32_t p : {node, on, on + 2}) pressed[index(p)] = 1;
  };
  for (const auto& [from, until] : {std::pair<std::size_t, std::size_t>{0, 20}, {20, 60}}) {
    for (std::size_t k = from; k < until; ++k) press(k);
    EXPECT_FALSE(points.add(row(of[0].back(), of[1][0])));  // known
    points.number();
    for (const int body : {0, 1}) {
      int slot = 0;
      std::vector<std::int32_t> listed;
      for (const std::int32_t p : of[index(body)]) {
        EXPECT_EQ(points.slot(p), pressed[index(p)] != 0 ? slot : -1) << body << " " << p;
        if (pressed[index(p)] == 0) continue;
        slot += 3;
        listed.push_back(surfaces[p].point);
      }
      EXPECT_EQ(points.list(body, 1)[0], listed);
      EXPECT_EQ(points.values(body).size(), listed.size());
    }
  }
}

}  // namespace
}  // namespace abut::passive_pressed_points_tests
