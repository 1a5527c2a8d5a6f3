// What motion must be: ways over times, of the points that forces act on.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.hpp"
#include "coordinator/conformance/clauses.hpp"

namespace abut {

namespace {

constexpr double shortest = 1.0 / 64.0;  // of a step: what swings fastest is slow in it

/// Numbers from -1 to 1 of which no two neighbours are alike, and other ones for every `kind`:
/// multiples of an irrational number, which fill the interval evenly.
std::vector<double> unlike(std::size_t count, int kind) {
  const double turn = kind % 2 == 0 ? 0.6180339887498949 : 0.7548776662466927;
  std::vector<double> all(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double turned = turn * static_cast<double>(k + 1);
    all[k] = 2.0 * (turned - std::floor(turned)) - 1.0;
  }
  return all;
}

/// Forces on all points of all ports along all axes, each another one. `times`: of light forces.
std::vector<Push> unlike_pushes(BodyTrial& trial, double length, double times, int kind) {
  std::vector<Push> pushes;
  for (int p = 0; p < static_cast<int>(trial.about().ports.size()); ++p) {
    const double force = times * trial.light_force(p);
    if (force <= 0.0) continue;
    std::vector<double> forces =
        unlike(trial.about().ports[index(p)].geometry.points.size(), kind + p);
    for (double& each : forces) each *= force;
    pushes.push_back(trial.push(p, length, forces));
  }
  return pushes;
}

double norm(const std::vector<double>& all) {
  double sum = 0.0;
  for (const double each : all) sum += each * each;
  return std::sqrt(sum);
}

/// Ways of the port's points over a window, and what counts for nothing in their size.
struct Way {
  std::vector<double> gone;  // [m]
  double rounded = 0.0;      // [m]
};

/// [m/s] a hundredth of what light forces bring about: what is left over where nothing moves.
double slow_of(const BodyTrial& trial, const Port& port) {
  return 0.01 * light_way * size_of_port(port.geometry) / trial.length();
}

Way way_of(const Waveform& trace, double slow) {
  Way way{std::vector<double>(index(trace.width)), 0.0};
  const std::size_t last = trace.u.size() - way.gone.size();
  double size = 0.0;
  for (std::size_t k = 0; k < way.gone.size(); ++k) {
    way.gone[k] = trace.u[last + k] - trace.u[k];
    size = std::hypot(size, trace.u[k]);
  }
  const double length = trace.time.back() - trace.time.front();
  way.rounded = slow * length + 1.0e3 * one_rounding * size;
  return way;
}

/// Throws where points go elsewhere than their velocities say; whether they go at all.
bool hold_way(const Waveform& trace, const Port& port, double slow) {
  // Velocities are those of instants, of half steps before, or means of steps, and what swings so
  // fast that three steps hold a period turns by a third of its speed in the longest window here.
  // Surfaces without mass jump after what is behind them: of these, no more than the side.
  const double tolerance = trace.support == ForceSupport::nodal ? 0.9 : 0.35;
  const Way way = way_of(trace, slow);
  const std::size_t width = way.gone.size(), last = trace.v.size() - width;
  const double length = trace.time.back() - trace.time.front();
  double least = std::numeric_limits<double>::infinity(), size = norm(way.gone);
  for (const double share : {0.0, 0.5, 1.0}) {  // of the velocity at the end
    std::vector<double> off(width), told(width);
    for (std::size_t k = 0; k < width; ++k) {
      told[k] = length * ((1.0 - share) * trace.v[k] + share * trace.v[last + k]);
      off[k] = way.gone[k] - told[k];
    }
    least = std::min(least, norm(off));
    size = std::max(size, norm(told));
  }
  if (least > tolerance * size + way.rounded)
    throw BrokenClause(
        fmt::format(
            "the points of port {} go {:.3g} m in a window of {:.3g} s, and {:.3g} m beside "
            "where their velocities lead",
            port.name, norm(way.gone), length, least),
        "v of a trace is the velocity of the points that u is of, in their order; a step is as "
        "long "
        "as it is asked to be.");
  return size > way.rounded;
}

/// A body that moves: its ways over windows that are parts of a step.
std::string motion(BodyTrial& trial) {
  const Description& body = trial.about();
  if (body.quasi_static) return "the body has no inertia";
  trial.window(trial.length(), unlike_pushes(trial, trial.length(), 1.0, 0));
  trial.window(trial.length());  // after which no force is there
  trial.save();
  const Response brief = trial.again(shortest * trial.step());
  const Response third = trial.again(trial.step() / 3.0);
  bool moved = false;
  for (std::size_t p = 0; p < body.ports.size(); ++p) {
    const Port& port = body.ports[p];
    const double slow = slow_of(trial, port);
    const Way one = way_of(brief.ports[p].trace, slow), other = way_of(third.ports[p].trace, slow);
    std::vector<double> off(one.gone.size());
    for (std::size_t k = 0; k < off.size(); ++k) off[k] = other.gone[k] - one.gone[k];
    // Steps of the body's own length end at the same place to the bit: nothing else that moves
    // does.
    constexpr double tolerance = 1.0e-3;
    if (norm(one.gone) > one.rounded && norm(off) <= tolerance * norm(one.gone))
      throw BrokenClause(
          fmt::format("the points of port {} go as far in a 64th of a step as in a third of it",
                      port.name),
          "A step is as long as it is asked to be: windows can be shorter than one.");
    for (const Response* reply : {&brief, &third})
      moved = hold_way(reply->ports[p].trace, port, slow) || moved;
  }
  return moved ? "" : "nothing moves without a force";
}

/// A trial by a push: what was pushed, and what came of it.
struct Answer {
  std::vector<double> forces, ways;  // [N] [m] of all ports, against a free window
  double rounded = 0.0;              // [m]
};

Answer answer(const std::vector<Push>& pushes, const Response& pushed, const Response& free) {
  Answer all;
  for (const Push& push : pushes) {
    const Waveform& one = pushed.ports[index(push.port)].trace;
    const Waveform& other = free.ports[index(push.port)].trace;
    const std::size_t width = index(one.width);
    for (std::size_t k = 0; k < width; ++k) {
      const double end = one.u[one.u.size() - width + k];
      all.forces.push_back(push.force.f[k]);
      all.ways.push_back(end - other.u[other.u.size() - width + k]);
      all.rounded = std::max(all.rounded, 64.0 * one_rounding * std::abs(end));
    }
  }
  return all;
}

/// Forces of one times ways of the other [J], the sum of the parts' sizes, and what is rounded.
struct Product {
  double sum = 0.0, size = 0.0, rounded = 0.0;
};

Product product(const Answer& one, const Answer& other) {
  Product all;
  for (std::size_t k = 0; k < one.forces.size(); ++k) {
    all.sum += one.forces[k] * other.ways[k];
    all.size += std::abs(one.forces[k] * other.ways[k]);
    all.rounded += std::abs(one.forces[k]) * other.rounded;
  }
  return all;
}

constexpr const char* same_points =
    "Forces act on the points of the description, and motion is told of the same, in the same "
    "order.";

/// Throws where points do not yield to what presses them.
void hold_yielding(const Answer& one, const std::string& what) {
  // Of what a point yields no less than this part is along the force, be there 100,000 points.
  constexpr double tolerance = 1.0e-7;
  double most = 0.0, forces = 0.0;
  for (const double way : one.ways) most = std::max(most, std::abs(way));
  for (const double force : one.forces) forces += std::abs(force);
  const double sum = product(one, one).sum;
  if (most > 1.0e3 * one.rounded && sum <= tolerance * most * forces)
    throw BrokenClause(fmt::format("{}, and what moves does not move along the forces: they do "
                                   "{:.3g} J",
                                   what, sum),
                       same_points);
}

/// Throws where a force on one point moves another one otherwise than the other way round.
void hold_symmetry(const Answer& one, const Answer& other, double tolerance) {
  const Product there = product(one, other), back = product(other, one);
  if (std::abs(there.sum - back.sum) >
      tolerance * std::max(there.size, back.size) + there.rounded + back.rounded)
    throw BrokenClause(
        fmt::format("two sets of forces do {:.6g} J and {:.6g} J, each along the ways that the "
                    "other one brings about: that is one number",
                    there.sum, back.sum),
        same_points);
}

/// All points are pressed by two sets of unlike forces, and some by one: in a 64th of a step, in
/// which mass alone answers, whatever else the body does; of bodies that take forces of instants in
/// a window of whole steps, where they conserve.
std::string points(BodyTrial& trial) {
  if (const std::string why = why_no_force(trial); !why.empty()) return why;
  const Description& body = trial.about();
  const Response before = trial.window(trial.length());  // after which no force is there
  const bool levels = before.ports.front().trace.support == ForceSupport::nodal;
  if (levels && !body.conserves) return "its forces are of instants, and it does not conserve";
  const double length = levels ? trial.length() : shortest * trial.step();
  const double times = levels ? 1.0 : 1.0 / shortest;
  trial.save();
  const Response free = trial.window(length);
  const auto press = [&](const std::vector<Push>& pushes, const std::string& what) {
    const Answer all = answer(pushes, trial.again(length, pushes), free);
    hold_yielding(all, what);
    return all;
  };
  std::vector<Answer> answers;
  for (const int kind : {0, 1}) {
    trial.restore();
    answers.push_back(press(unlike_pushes(trial, length, times, kind), "all points are pressed"));
  }
  // Iterations of solvers leave less; and light forces leave a body that is not linear nearly so.
  const double tolerance = body.linear ? 1.0e-4 : 0.02;
  hold_symmetry(answers[0], answers[1], tolerance);
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p) {
    const double force = times * trial.light_force(p);
    const Port& port = body.ports[index(p)];
    for (const int point : {0, port.geometry.count() / 2}) {
      if (force <= 0.0) continue;
      std::vector<double> forces(port.geometry.points.size(), 0.0);
      forces[index((point + 1) * body.dim - 1)] = force;
      trial.restore();
      press({trial.push(p, length, forces)},
            fmt::format("point {} of port {} is pressed", point, port.name));
    }
  }
  return "";
}

constexpr Clause clauses_on_motion[] = {
    {"motion", "velocities are ways over times, in windows of any length", motion},
    {"points", "forces act on the points whose motion is told", points},
};

}  // namespace

std::span<const Clause> clauses_of_motion() { return clauses_on_motion; }

}  // namespace abut
