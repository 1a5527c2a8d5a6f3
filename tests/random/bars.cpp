// Rows of bars in one dimension.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/random/kinds.hpp"

namespace abut {

namespace {

using Kind = RandomBody::Kind;

RandomBody random_bar(Draw& draw, int number, double speed) {
  RandomBody bar;
  bar.name = "bar_" + std::to_string(number);
  bar.shape.dim = 1;
  bar.shape.kind = "bar";
  bar.shape.element = "bar2";
  const double length = draw.decades(0.2, 1.0);
  const int count = std::max(2, draw.whole(1, 40));  // one cannot be free of mass at both ends
  for (int i = 0; i <= count; ++i) bar.shape.points.emplace_back(length * i / count, 0.0, 0.0);
  for (int i = 0; i < count; ++i) bar.shape.cells.push_back({i, i + 1});
  bar.law = draw.of<std::string>(
      {"linear_elastic", "linear_elastic", "neo_hookean", "saint_venant_kirchhoff"});
  bar.density = 1000.0 * draw.decades(0.1, 10.0);
  const double wave = speed / draw.decades(0.002, 0.1);
  bar.modulus = bar.density * wave * wave;
  bar.ratio = draw.uniform(0.0, 0.45);
  bar.area = draw.decades(0.1, 1.0);
  bar.scheme = draw.of<std::string>(
      {"central_difference", "central_difference", "newmark", "hht_alpha", "generalized_alpha"});
  return bar;
}

RandomBody random_wall(int number) {
  RandomBody wall;
  wall.name = "bar_" + std::to_string(number);
  wall.kind = Kind::tool;
  wall.shape.dim = 1;
  wall.shape.kind = "wall";
  wall.shape.points = {Eigen::Vector3d::Zero()};
  return wall;
}

/// Ends that are joined move alike at the start, and step alike.
void tie(RandomScene& scene, int left, int right) {
  scene.ties.push_back({{left, right}, {"right", "left"}});
  RandomBody &one = scene.bodies[left], &other = scene.bodies[right];
  other.velocity = one.velocity;
  other.scheme = one.scheme;
  one.law = other.law = "linear_elastic";  // others cannot be tied
}

double crossing_of(const RandomBody& bar) {
  return bar.kind == Kind::tool ? INFINITY : bar.shape.shortest_edge() / bar.wave_speed();
}

void choose_bar_steps(Draw& draw, RandomScene& scene) {
  double crossing = INFINITY, slowest = 0.0;
  for (const RandomBody& bar : scene.bodies) {
    if (bar.kind == Kind::tool) continue;
    crossing = std::min(crossing, crossing_of(bar));
    slowest = std::max(slowest, bar.shape.size() / bar.wave_speed());
  }
  // Explicit bars of a window: their steps are 0.3 to 0.9 of what is stable.
  const double share = draw.uniform(0.3, 0.9);
  const int steps = draw.whole(1, 10);
  scene.window = crossing * share * steps;
  for (RandomBody& bar : scene.bodies) {
    const bool fine = bar.scheme == "central_difference" || !scene.ties.empty();
    bar.step = scene.window / (fine ? steps : draw.whole(1, 10));
  }
  scene.end = slowest * draw.uniform(2.0, 6.0);
}

/// From left to right, with gaps that close after up to so many windows.
void put_in_a_row(Draw& draw, RandomScene& scene, int flight) {
  double place = 0.0;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const bool tied = std::ranges::any_of(
        scene.ties, [k](const RandomTie& tie) { return tie.bodies[1] == static_cast<int>(k); });
    if (k > 0 && !tied)
      place += draw.uniform(0.1, 1.0) * flight * scene.window * scene.speed + 1e-6;
    scene.bodies[k].place = Eigen::Vector3d(place, 0.0, 0.0);
    place += scene.bodies[k].kind == Kind::tool ? 0.0 : scene.bodies[k].shape.size();
  }
}

}  // namespace

RandomScene random_bars(Draw& draw, std::uint64_t seed, double speed) {
  RandomScene scene;
  scene.seed = seed;
  scene.dim = 1;
  scene.speed = speed > 0.0 ? speed : draw.decades(1.0, 100.0);
  const int count = draw.whole(2, 5);
  const bool before = draw.chance(0.2), behind = draw.chance(0.2);
  if (before) scene.bodies.push_back(random_wall(0));
  for (int k = 0; k < count; ++k) {
    scene.bodies.push_back(random_bar(draw, static_cast<int>(scene.bodies.size()), scene.speed));
    // Those behind come faster.
    scene.bodies.back().velocity(0) =
        scene.speed * (draw.uniform(-0.2, 0.2) + 1.0 - 2.0 * k / (count - 1.0));
  }
  if (behind) scene.bodies.push_back(random_wall(static_cast<int>(scene.bodies.size())));
  for (int k = 1; k < static_cast<int>(scene.bodies.size()); ++k)
    if (scene.bodies[k - 1].kind != Kind::tool && scene.bodies[k].kind != Kind::tool &&
        draw.chance(0.25))
      tie(scene, k - 1, k);
  choose_bar_steps(draw, scene);
  const int flight = draw.whole(2, 20);
  put_in_a_row(draw, scene, flight);
  scene.end = scene.window * std::clamp(std::ceil(scene.end / scene.window) + flight, 20.0, 400.0);
  if (draw.chance(0.3)) scene.end -= draw.uniform(0.0, 1.0) * scene.window;
  return scene;
}

}  // namespace abut
