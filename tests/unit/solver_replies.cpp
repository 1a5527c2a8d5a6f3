// Goal: a reply is a function of the state and of the request, bit for bit. Whatever a body was
// asked before, over the same window or others, and however often, it answers the same request from
// the same state alike. Oracle: equal bits of a twin that was asked for nothing else; over every
// kind of body and of joint.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "contract/force_means.hpp"
#include "tests/unit/every_body.hpp"

namespace abut::solver_replies_tests {
namespace {

/// Requests between: some over the same window, some not, some again.
constexpr int between = 6;

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  bool coin() { return upto(1) == 1; }
  int upto(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  double value(double size) { return std::uniform_real_distribution<double>(-size, size)(random_); }
  std::vector<double> values(std::size_t count, double size) {
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(value(size));
    return out;
  }

 private:
  std::mt19937 random_;
};

/// A body, and what its ports have met.
struct Player {
  std::unique_ptr<Subdomain> body;
  std::vector<std::vector<PortGeometry>> met;  // by port
  ContactLaw law;
  bool kernels = false;  // it was told how partners and its own surface give way

  explicit Player(std::unique_ptr<Subdomain> made)
      : body(std::move(made)), met(body->describe().ports.size()) {}
  const Description& describe() const { return body->describe(); }
  std::size_t width(std::size_t p) const { return describe().ports[p].geometry.points.size(); }
};

Waveform moves(const PortGeometry& of, double begin, double end, Dice& dice) {
  Waveform motion(static_cast<int>(of.points.size()));
  motion.time = {begin, 0.5 * (begin + end), end};
  for (std::size_t k = 0; k < 3 * of.points.size(); ++k) motion.u.push_back(dice.value(2.0e-3));
  for (std::size_t t = 0; t < 3; ++t) {  // towards the body, which moves the other way
    const double deep = 0.01 + std::abs(dice.value(0.01));
    for (std::size_t k = 0; k < of.points.size(); ++k)
      motion.u[t * of.points.size() + k] += deep * of.normals[k];
  }
  return motion;
}

void obstruct(const Player& p, std::size_t port, const Advance& request, Dice& dice,
              BoundaryData& data) {
  const TimeWindow& window = request.window;
  const Substeps grid = Substeps::divide(window, p.describe().step, request.records);
  const std::size_t points = index(p.describe().ports[port].geometry.count());
  for (const PortGeometry& partner : p.met[port]) {
    Obstacle& obstacle = data.obstacles.emplace_back();
    obstacle.motion = moves(partner, window.begin, window.end, dice);
    if (p.kernels) obstacle.motion.f = dice.values(obstacle.motion.u.size(), 1.0e-3);
    if (!p.law.friction.jumps()) continue;
    for (std::size_t k = 0; k < points * index(std::max(0, grid.count - 1)); ++k)
      if (dice.upto(9) == 0) obstacle.slid.push_back(static_cast<std::int32_t>(k));
  }
  if (!p.describe().can.neighbours || !p.kernels || dice.upto(3) == 0) return;
  data.balanced = Waveform(static_cast<int>(p.width(port)));
  data.balanced.time = levels_of(grid);
  data.balanced.f = dice.values(data.balanced.time.size() * p.width(port), 0.01);
}

void push(std::size_t width, ForceSupport support, const TimeWindow& window, Dice& dice,
          BoundaryData& data) {
  Waveform& force = data.forces.emplace_back(static_cast<int>(width));
  force.support = support;
  force.time = {window.begin, 0.4 * window.begin + 0.6 * window.end, window.end};
  force.f = dice.values(3 * width, 0.01);
}

TimeWindow any_window(double begin, Dice& dice) {
  const double lengths[] = {0.17, 0.33};
  return {1 + dice.upto(1), begin, begin + lengths[dice.upto(1)]};
}

Advance any_request(const Player& p, const TimeWindow& window, Dice& dice) {
  const Description& d = p.describe();
  const double begin = window.begin;
  Advance request = free_request(*p.body, begin, window.end, 1 + dice.upto(1));
  request.window = window;
  request.sampling = dice.upto(3) == 0 ? Sampling::records : Sampling::substeps;
  if (dice.coin()) request.ahead = 0.1;
  for (std::size_t q = 0; q < request.boundary.size(); ++q) {
    BoundaryData& data = request.boundary[q];
    const bool closed = dice.upto(4) > 0;
    if (!p.met[q].empty()) {
      if (closed) obstruct(p, q, request, dice, data);
    } else if (d.can.motion && closed) {
      data.motion.time = {begin, request.window.end};
      data.motion.u = dice.values(2 * p.width(q), 0.01);
      data.motion.v = data.motion.a = dice.values(2 * p.width(q), 0.1);
    } else if (d.can.force && closed) {
      push(p.width(q), d.dim > 1 ? ForceSupport::linear : ForceSupport::nodal, request.window, dice,
           data);
    }
    if (d.can.impulse && dice.coin()) data.impulse = dice.values(p.width(q), 1.0e-3);
  }
  return request;
}

/// All that a reply tells, but for the time that it took.
std::vector<double> numbers_of(const Outcome& outcome, const Response& r, std::uint64_t hash) {
  std::vector<double> all = {static_cast<double>(hash >> 32),
                             static_cast<double>(hash & 0xffffffff)};
  if (const Failed* failed = std::get_if<Failed>(&outcome)) {
    all.push_back(failed->time);
    return all;
  }
  const auto add = [&all](const auto& values) {
    all.push_back(static_cast<double>(values.size()));
    all.insert(all.end(), values.begin(), values.end());
  };
  const auto add_wave = [&add](const Waveform& w) {
    for (const std::vector<double>* field : {&w.time, &w.u, &w.v, &w.a, &w.f}) add(*field);
    add(w.points);
  };
  for (const PortResponse& port : r.ports) {
    add_wave(port.trace);
    add_wave(port.ahead);
    for (const Reaction& reaction : port.reactions) {
      add_wave(reaction.force);
      add(reaction.slid);
      all.push_back(reaction.dissipated);
    }
    for (const std::vector<double>* box : {&port.lower, &port.upper, &port.slowest, &port.fastest})
      add(*box);
    all.insert(all.end(), {port.speed_bound, port.acceleration_bound, port.work});
    if (port.recoil) all.insert(all.end(), {port.recoil->velocity, port.recoil->mobility});
  }
  for (const BodyRecord& record : r.records) {
    const Energy& e = record.energy;
    all.insert(all.end(), {record.time, e.kinetic, e.stored, e.dissipated, e.external_work});
    for (const auto* values : {&record.momentum, &record.angular_momentum, &record.columns})
      add(*values);
  }
  add(r.unbalanced);
  all.push_back(r.steps);
  return all;
}

std::vector<double> answer(Player& p, const Advance& request) {
  Response response;
  const Outcome outcome = p.body->advance(request, response);
  return numbers_of(outcome, response,
                    std::holds_alternative<Failed>(outcome) ? 0 : p.body->state_hash());
}

using MakePlayer = std::function<Player()>;

/// How many numbers of its replies were compared. The body that is asked much and a twin that is
/// asked for this alone are brought to a state, and save it.
std::size_t compare(const MakePlayer& make, unsigned seed) {
  Player asked_much = make(), twin = make();
  Dice dice(seed);
  const Advance start = any_request(asked_much, any_window(0.0, dice), dice);
  if (answer(asked_much, start) != answer(twin, start)) ADD_FAILURE() << "two of a kind differ";
  const double now = start.window.end;
  asked_much.body->save();
  twin.body->save();
  const Advance request = any_request(twin, any_window(now, dice), dice);
  for (int k = 0; k < between; ++k) {
    const TimeWindow window = k % 3 == 0 ? any_window(now, dice) : request.window;
    const Advance other = any_request(asked_much, window, dice);
    answer(asked_much, k == 3 ? request : other);
    asked_much.body->restore();
  }
  const std::vector<double> expected = answer(twin, request), told = answer(asked_much, request);
  EXPECT_EQ(told, expected);
  twin.body->restore();
  EXPECT_EQ(answer(twin, request), expected) << "once more";
  return expected.size();
}

/// Over all that are not refused; `seeds` of each. Tells how many combinations there were. A
/// request may have no answer, as random forces wedge surfaces between random obstacles; that is
/// compared as well, but does not count.
int compare_all(const std::vector<std::pair<std::string, MakePlayer>>& players, unsigned seeds) {
  int compared = 0;
  for (const auto& [name, make] : players) {
    unsigned answered = 0;
    for (unsigned seed = 1; seed <= 3 * seeds && answered < seeds; ++seed) {
      SCOPED_TRACE(fmt::format("{}, seed {}", name, seed));
      if (compare(make, seed) > 10) ++answered;
    }
    EXPECT_EQ(answered, seeds) << name;
    ++compared;
  }
  return compared;
}

void meet_points(Player& p) {
  const Description& d = p.describe();
  for (std::size_t q = 0; d.can.obstacle && q < d.ports.size(); ++q) {
    if (d.ports[q].geometry.count() != 1) continue;
    PortGeometry point = d.ports[q].geometry;
    point.normals[0] *= -1.0;
    meet_point(*p.body, q, d.ports[q].tied);
    p.met[q].push_back(point);
  }
}

std::vector<std::pair<std::string, MakePlayer>> players_of(const std::vector<Maker>& makers,
                                                           bool met) {
  std::vector<std::pair<std::string, MakePlayer>> all;
  for (const Maker& maker : makers) {
    const std::unique_ptr<Subdomain> body = maker.make();
    if (!body || (met && !body->describe().can.obstacle)) continue;
    all.push_back({maker.name + (met ? ", met" : ""), [maker, met] {
                     Player player(maker.make());
                     if (met) meet_points(player);
                     return player;
                   }});
  }
  return all;
}

TEST(Replies, OfBarsPairsAndWallsDependOnStateAndRequestAlone) {
  EXPECT_GE(compare_all(players_of(bars(), false), 2), 50);
  EXPECT_GE(compare_all(players_of(bars(), true), 2), 20);
}

TEST(Replies, OfSolidsRigidAndModalBodiesDependOnStateAndRequestAlone) {
  EXPECT_GE(compare_all(players_of(solids(), false), 1), 150);
}

/// A block on the floor; its face is touched by a plate, or two, and its side is tied or not.
struct Touched {
  int dim = 2;
  std::string law, scheme;
  bool tied = false, kernels = false;
  ContactLaw contact = {};

  std::string name() const {
    return fmt::format("{}D {} {}{}{} friction {} {}", dim, law, scheme, tied ? " tied" : "",
                       kernels ? " kernels" : "", contact.friction.static_friction,
                       contact.friction.kinetic_friction);
  }

  std::unique_ptr<Subdomain> make() const {
    const std::string mesh = dim == 2 ? "rectangle: {lengths: [1.0, 1.0], elements: [3, 3]}"
                                      : "box: {lengths: [1.0, 1.0, 1.0], elements: [2, 2, 2]}";
    const auto block = [&](const std::string& called, const std::string& port) {
      return fmt::format(
          "{}: {{model: {{fe: {{dimension: {}, mesh: {{{}}}}}}}, material: {{{}: "
          "{{youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}}}}, integrator: {{{}: "
          "{{step: 0.05}}}}, ports: {{face: {{side: {}}}{}}}, "
          "constraints: {{floor: {{on: {}, fixed: true}}}}}}",
          called, dim, mesh, law, scheme, dim == 2 ? "top" : "front", port,
          dim == 2 ? "bottom" : "back");
    };
    const std::string text =
        fmt::format("bodies: {{{}}}\n", block("it", tied ? ", root: {side: left}" : ""));
    BodyContext context;
    context.ports.push_back({.port = "face", .touches = true, .partners = {}});
    if (tied) context.ports.push_back({.port = "root", .tied = true, .partners = {}});
    return make_body(Document::from_text("test", text), "bodies.it", context);
  }

  PortGeometry plate() const {
    PortGeometry surface;
    surface.dim = dim;
    if (dim == 2) {
      surface.points = {-0.3, 1.0, 1.4, 1.0};
      surface.normals = {0.0, -1.0, 0.0, -1.0};
      surface.facets = {0, 1};
      surface.offsets = {0, 2};
    } else {
      surface.points = {-0.3, -0.2, 1.0, -0.2, 1.4, 1.0, 1.3, 1.2, 1.0, 1.2, -0.3, 1.0};
      surface.normals = {0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1};
      surface.facets = {0, 1, 2, 3};
      surface.offsets = {0, 4};
    }
    surface.spacing = 1.5;
    return surface;
  }

  /// A kernel of a surface, diagonal at first as contact has answers then; whose it is does not
  /// matter here.
  static PortKernel kernel_of(std::size_t width) {
    PortKernel kernel;
    kernel.step = 0.05;
    kernel.patterns = kernel.width = static_cast<int>(width);
    const std::size_t each = width * width;
    for (std::size_t k = 0; k < 10 * each; ++k)
      kernel.displacement.push_back(k % each % (width + 1) == 0 ? 0.1
                                    : k < each                  ? 0.0
                                               : 0.01 * std::sin(static_cast<double>(k)));
    kernel.begin = kernel.displacement;
    return kernel;
  }

  Player player() const {
    Player p(make());
    p.law = contact;
    p.kernels = kernels;
    const PortGeometry surface = plate();
    for (const int partner : {0, 1}) {
      const PortKernel gives = kernel_of(surface.points.size());
      p.body->meet({0, partner, &surface, contact, kernels ? &gives : nullptr});
      p.met[0].push_back(surface);
    }
    const PortKernel own = kernel_of(p.width(0));
    if (kernels && p.describe().can.neighbours) p.body->meet({0, own_surface, nullptr, {}, &own});
    return p;
  }
};

std::vector<Touched> touched() {
  std::vector<Touched> all;
  for (const int dim : {2, 3})
    for (const char* law : {"linear_elastic", "neo_hookean"})
      for (const char* scheme : {"central_difference", "newmark", "generalized_alpha"})
        for (const bool tied : {false, true})
          for (const bool kernels : {false, true})
            for (const auto& [sticks, slides] : {std::pair(0.0, 0.0), {0.3, 0.3}, {0.4, 0.1}})
              if (dim == 2 || (kernels && sticks != slides) || (tied && kernels && sticks == 0.0))
                all.push_back({dim, law, scheme, tied, kernels, {.friction = {sticks, slides}}});
  return all;
}

TEST(Replies, OfBodiesThatTouchDependOnStateAndRequestAlone) {
  std::vector<std::pair<std::string, MakePlayer>> players;
  for (const Touched& t : touched()) players.push_back({t.name(), [t] { return t.player(); }});
  EXPECT_GE(compare_all(players, 2), 80);
}

/// What the fields are for: without them the reply is another one.
TEST(Replies, DependOnTheForceThatIsBalancedAndOnWhatSlid) {
  Touched t{2, "linear_elastic", "newmark", true, true, {.friction = {0.4, 0.1}}};
  ASSERT_TRUE(t.make()->describe().can.neighbours);
  Player p = t.player();
  Dice dice(3);
  Advance request = free_request(*p.body, 0.0, 0.33, 1);
  obstruct(p, 0, request, dice, request.boundary[0]);
  BoundaryData& data = request.boundary[0];
  data.obstacles[0].slid.clear();
  data.obstacles[1].slid.clear();
  data.balanced.clear();
  p.body->save();
  Response plain, response;
  step(*p.body, request, plain);
  EXPECT_LT(plain.ports[0].trace.f.back(), 0.0) << "it is pressed";
  data.balanced = plain.ports[0].trace;
  p.body->restore();
  step(*p.body, request, response);
  EXPECT_NE(plain.ports[0].trace.f, response.ports[0].trace.f);
  data.balanced.clear();
  for (std::int32_t k = 0; k < 4 * response.steps - 4; ++k) data.obstacles[0].slid.push_back(k);
  p.body->restore();
  step(*p.body, request, response);
  EXPECT_EQ(response.ports[0].reactions[0].slid, data.obstacles[0].slid) << "never fewer";
  data.obstacles[0].slid.push_back(4 * response.steps);
  p.body->restore();
  EXPECT_THROW(step(*p.body, request, response), RunError) << "of another window";
}

}  // namespace
}  // namespace abut::solver_replies_tests
