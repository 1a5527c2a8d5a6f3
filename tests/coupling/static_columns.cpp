// Goal: blocks that stand on each other, held by contact alone, have an answer in statics: whatever
// their meshes, laws, ports and steps are, the ground bears their weights and what presses on them.
// Oracle: equilibrium.

#include <random>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::static_columns_tests {
namespace {

struct Column {
  std::string bodies = {}, interfaces = {};
  double load = 0.0;  // [N] weights and pressure
  int dim = 2;
  int steps = 1;
};

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  int one_of(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }

 private:
  std::mt19937 engine_;
};

constexpr double weight = 9.81, density = 2000.0;  // [m/s^2], [kg/m^3]

/// Of a block whose lengths are `width` across and `height`, in the middle of x = y = 0.
std::string block(Dice& dice, int dim, double width, double height, int cells) {
  static constexpr const char* in_plane[] = {"quad4", "tri3", "quad4", "quad8"};
  static constexpr const char* in_space[] = {"hex8", "tet4"};
  const std::string element = dim == 2 ? in_plane[dice.one_of(4)] : in_space[dice.one_of(2)];
  std::vector<double> lengths(index(dim), width);
  lengths.back() = height;
  std::vector<int> counts;
  for (int i = 0; i < dim; ++i) counts.push_back(1 + dice.one_of(cells));
  return block_mesh(lengths, counts, element);
}

std::string law(Dice& dice, double stiffness) {
  static constexpr const char* laws[] = {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean"};
  static constexpr double ratios[] = {0.0, 0.3, 0.45};
  return fmt::format("{}: {{youngs_modulus: {}, poissons_ratio: {}, density: {}}}",
                     laws[dice.one_of(3)], stiffness, ratios[dice.one_of(3)], density);
}

Column column(unsigned seed) {
  Dice dice(seed);
  Column out{.dim = dice.one_of(3) == 0 ? 3 : 2};
  const int dim = out.dim;
  out.steps = 1 + dice.one_of(4);
  const std::string step = fmt::format("quasi_static: {{step: {}}}", 1.0 / out.steps);
  const std::string top = dim == 2 ? "top" : "front", low = dim == 2 ? "bottom" : "back";
  const double stiffness = std::pow(10.0, dice.between(7.0, 11.0));
  const char* friction[] = {"0.2", "0.5", "rough"};
  const std::string rubs = friction[dice.one_of(3)];
  const auto side = [&](const std::string& own) { return dice.one_of(2) == 0 ? "boundary" : own; };
  const auto place = [&](double width, double height, double aside) {
    std::vector<double> at(index(dim), -0.5 * width + aside);
    at.back() = height;
    return at;
  };
  SolidText floor{.name = "floor",
                  .dim = dim,
                  .mesh = block(dice, dim, 2.0, 0.5, 4),
                  .material = law(dice, stiffness * dice.between(0.5, 5.0)),
                  .integrator = step,
                  .position = place(2.0, -0.5, 0.0),
                  .port = "high",
                  .side = side(top)};
  floor.more = fmt::format("    constraints: {{base: {{on: {}, fixed: true}}}}\n", low);
  out.bodies = floor.text();
  double height = 0.0, width = 1.4;
  const int count = 1 + dice.one_of(3);
  for (int k = 0; k < count; ++k) {
    const double own = width * dice.between(0.6, 0.95), tall = dice.between(0.3, 0.8);
    SolidText one{.name = fmt::format("block{}", k),
                  .dim = dim,
                  .mesh = block(dice, dim, own, tall, 4),
                  .material = law(dice, stiffness * dice.between(0.2, 3.0)),
                  .integrator = step,
                  .position = place(own, height, 0.2 * (width - own)),
                  .port = "low",
                  .side = side(low)};
    const std::string other = k == 0 ? "floor" : fmt::format("block{}", k - 1);
    out.interfaces += fmt::format("  c{0}: {{sides: [{1}.high, block{0}.low], contact: {{friction: "
                                  "{2}}}}}\n",
                                  k, other, rubs);
    const double area = dim == 2 ? own : own * own;
    one.more = fmt::format("    body_force: [{}-{}]\n", dim == 2 ? "0.0, " : "0.0, 0.0, ", weight);
    out.load += density * weight * area * tall;
    if (k + 1 == count) {
      const double pressure = stiffness * std::pow(10.0, dice.between(-5.0, -3.0));
      one.more +=
          fmt::format("    loads: {{press: {{on: {}, pressure: '{} * t'}}}}\n", top, pressure);
      out.load += pressure * area;
    }
    std::string text = one.text();
    const std::string ports = "ports: {";
    text.insert(text.find(ports) + ports.size(), fmt::format("high: {{side: {}}}, ", side(top)));
    out.bodies += text;
    height += tall;
    width = own;
  }
  return out;
}

TEST(StaticColumns, StandOnTheGround) {
  // Of 200 the first ones, and two in which something else than contact held a block at the end.
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u, 11u, 12u, 107u, 111u}) {
    SCOPED_TRACE(seed);
    const Column tower = column(seed);
    const auto result = run_scene(1.0, 1.0 / tower.steps, tower.bodies,
                                  "interfaces:\n" + tower.interfaces);
    EXPECT_TRUE(result->completed()) << result->end.reason;
    if (!result->completed()) continue;
    const std::string up = tower.dim == 2 ? "y" : "z";
    // What stabilises blocks may bear a hundredth of the forces on them at the end (at_most); of
    // the ground's it is what is left of that when all have settled.
    EXPECT_NEAR(result->measure("body.floor.base.reaction." + up), tower.load, 5.0e-3 * tower.load);
  }
}

}  // namespace
}  // namespace abut::static_columns_tests
