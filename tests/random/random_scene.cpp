// What a seed makes: which bodies, where, how fast, in which steps.

#include "tests/random/random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "tests/random/kinds.hpp"
#include "tests/random/sweep.hpp"

namespace abut {

namespace {

using Kind = RandomBody::Kind;

Eigen::Matrix3d random_turn(Draw& draw, int dim) {
  const double angle = draw.uniform(0.0, 2.0 * std::numbers::pi);
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  if (dim == 3) {
    axis =
        Eigen::Vector3d{draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)};
    axis.normalize();
  }
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Eigen::Vector3d random_direction(Draw& draw, int dim, bool down) {
  Eigen::Vector3d d{draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)};
  if (dim == 2) d(2) = 0.0;
  if (down) d = Eigen::Vector3d{0.5 * d(0), -1.0, 0.5 * d(2)};
  if (d.norm() < 0.1) d = -Eigen::Vector3d::UnitY();
  return d.normalized();
}

/// A law, and how fast waves are: speeds are 0.5 to 20 % of that.
void choose_material(Draw& draw, RandomBody& body, double speed) {
  body.law = draw.of<std::string>(
      {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean", "neo_hookean", "j2_plasticity"});
  body.density = 1000.0 * draw.decades(0.1, 10.0);
  body.ratio = draw.uniform(0.0, 0.45);
  const double wave = speed / draw.decades(0.005, 0.2);
  body.modulus = body.density * wave * wave;
  body.yield = body.modulus * draw.decades(1e-3, 3e-2);
}

void choose_scheme(Draw& draw, RandomBody& body) {
  body.scheme = body.kind == Kind::rigid ? "rigid_motion"
                : body.kind == Kind::tool
                    ? ""
                    : draw.of<std::string>({"central_difference", "central_difference", "newmark",
                                            "hht_alpha", "generalized_alpha"});
}

RandomBody random_body(Draw& draw, int dim, int number, double speed) {
  RandomBody body;
  body.name = "body_" + std::to_string(number);
  const bool floor = number == 0 && draw.chance(0.5);
  const double kind = draw.uniform(0.0, 1.0);
  if (floor) {
    body.kind = kind < 0.4 ? Kind::tool : kind < 0.8 ? Kind::held : Kind::deformable;
    body.shape = random_floor(draw, dim, 4.0);
  } else {
    body.kind = kind < 0.78 ? Kind::deformable : kind < 0.9 ? Kind::rigid : Kind::tool;
    if (number > 0 && body.kind == Kind::tool) body.kind = Kind::deformable;
    body.shape = random_shape(draw, dim, draw.decades(0.4, 1.0));
    body.turn = draw.chance(0.2) ? Eigen::Matrix3d::Identity() : random_turn(draw, dim);
    if (number == 0 && body.kind == Kind::deformable && draw.chance(0.3) && body.shape.has_bottom())
      body.kind = Kind::held;
  }
  body.port = body.shape.generator.empty() ? "skin" : "boundary";
  if (floor && body.kind == Kind::tool && draw.chance(0.5)) body.port = "top";
  choose_material(draw, body, speed);
  choose_scheme(draw, body);
  return body;
}

Outside outside_of(const RandomBody& body) {
  return {body.shape.dim, body.points(), body.shape.outside()};
}

/// Puts a body on its way to one of those before it, `gap` from the first that it meets.
bool throw_at(Draw& draw, std::vector<RandomBody>& bodies, RandomBody& body, double gap,
              double speed) {
  const bool floor = bodies[0].shape.kind == "floor";
  for (int trial = 0; trial < 50; ++trial) {
    const RandomBody& target = draw.of(bodies);
    const Eigen::Vector3d d = random_direction(draw, body.shape.dim, floor);
    Eigen::Vector3d aside = random_direction(draw, body.shape.dim, false);
    aside = 0.3 * (aside - aside.dot(d) * d);
    constexpr double far = 20.0;  // beyond all of the scene
    body.place = target.place + aside - far * d;
    double way = std::numeric_limits<double>::infinity();
    for (const RandomBody& other : bodies)
      way = std::min(way, way_to(outside_of(body), outside_of(other), d));
    if (!std::isfinite(way) || way < gap) continue;
    body.place += (way - gap) * d;
    body.velocity = speed * d;
    return true;
  }
  return false;
}

/// Steps of the bodies and windows that hold whole numbers of them, one to ten.
void choose_steps(Draw& draw, RandomScene& scene) {
  double crossing = std::numeric_limits<double>::infinity(), slowest = 0.0;
  for (const RandomBody& body : scene.bodies) {
    if (body.scheme.empty() || body.scheme == "rigid_motion") continue;
    crossing = std::min(crossing, body.shape.shortest_edge() / body.wave_speed());
    slowest = std::max(slowest, body.shape.size() / body.wave_speed());
  }
  if (!std::isfinite(crossing)) {
    crossing = 0.01 / scene.speed;
    slowest = 0.5 / scene.speed;
  }
  scene.window = crossing * draw.decades(0.4, 4.0);
  const int base = draw.chance(0.5) ? 1 : draw.whole(1, 4);
  for (RandomBody& body : scene.bodies)
    body.step = scene.window / (draw.chance(0.4) ? base : draw.whole(1, 10));
  scene.end = slowest * draw.uniform(1.0, 5.0);  // waves through the bodies
}

}  // namespace

double RandomBody::wave_speed() const { return std::sqrt(modulus / density); }

std::vector<Eigen::Vector3d> RandomBody::points() const {
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector3d& x : shape.points) out.push_back(turn * x + place);
  return out;
}

bool RandomScene::free() const {
  return gravity.isZero() && std::ranges::all_of(bodies, &RandomBody::moves_by_itself);
}

bool RandomScene::conserves() const {
  return std::ranges::none_of(bodies, [](const RandomBody& body) {
    return body.scheme == "hht_alpha" || body.scheme == "generalized_alpha";
  });
}

bool RandomScene::turns() const {
  return dim > 1 && std::ranges::all_of(bodies, [](const RandomBody& body) {
           return body.kind == Kind::rigid || body.law == "neo_hookean" ||
                  body.law == "saint_venant_kirchhoff";
         });
}

RandomScene random_scene(std::uint64_t seed, double speed) {
  Draw draw(seed);
  // Beside the draws of other scenes, which stay as they are.
  const bool all_kinds = seed >= first_of_all_kinds;
  Draw more(~seed);
  if (all_kinds && more.chance(0.15)) return random_bars(more, seed, speed);
  RandomScene scene;
  scene.seed = seed;
  scene.dim = draw.chance(0.65) ? 2 : 3;
  scene.speed = draw.decades(1.0, 100.0);
  if (speed > 0.0) scene.speed = speed;
  scene.friction = draw.chance(0.3) ? 0.0 : draw.uniform(0.0, 1.0);
  scene.everything = draw.chance(0.4);
  const int count = draw.whole(2, scene.dim == 2 ? 4 : 3);
  scene.bodies.push_back(random_body(draw, scene.dim, 0, scene.speed));
  for (int k = 1; k < count; ++k)
    scene.bodies.push_back(random_body(draw, scene.dim, k, scene.speed));
  if (all_kinds) choose_what_is_cut(more, scene);
  choose_steps(draw, scene);
  const int flight = draw.whole(2, 20);  // windows to the first touch
  std::vector<RandomBody> placed = {scene.bodies[0]};
  for (int k = 1; k < count; ++k) {
    RandomBody body = scene.bodies[k];
    const double gap = std::max(1e-3, draw.uniform(0.5, 1.5) * flight * scene.window * scene.speed);
    if (!throw_at(draw, placed, body, gap, scene.speed)) continue;
    placed.push_back(body);
  }
  scene.bodies = placed;
  if (scene.bodies[0].kind == Kind::tool && scene.bodies[0].shape.kind != "floor" &&
      draw.chance(0.7) && placed.size() > 1)
    scene.bodies[0].velocity = -0.5 * placed[1].velocity;
  if (draw.chance(0.3))
    scene.gravity = draw.chance(0.5) ? Eigen::Vector3d{0.0, -9.81, 0.0}
                                     : Eigen::Vector3d{0.0, -0.2 * scene.speed / scene.end, 0.0};
  // No more windows than a second or so pays for, the first touch among them.
  scene.end =
      scene.window * std::clamp(std::ceil(scene.end / scene.window) + flight, 20.0, flight + 120.0);
  if (all_kinds) {
    choose_turns(more, scene);
    cut_wholes(more, scene);
    if (more.chance(0.3)) scene.end -= more.uniform(0.0, 1.0) * scene.window;
  }
  return scene;
}

}  // namespace abut
