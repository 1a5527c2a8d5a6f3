// What forces must do.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "coordinator/conformance/clauses.hpp"
#include "coordinator/conformance/port_work.hpp"

namespace abut {

namespace {

/// Whether a port has facets, or is a point in one dimension: marks alone are not pushed.
bool touchable(const Description& body) {
  return std::ranges::any_of(body.ports, [](const Port& port) {
    return port.geometry.dim == 1 || !port.geometry.facets.empty();
  });
}

/// The last momentum along an axis, and the largest of any axis.
double momentum(const Response& reply, int axis) {
  return reply.records.back().momentum.at(index(axis));
}

/// A force whose impulse is the same, in three unlike parts.
Push in_parts(const Push& push) {
  Push parts = push;
  const std::size_t width = index(push.force.width);
  const double begin = push.force.time.front(), length = push.force.time.back() - begin;
  const std::vector<double> f(push.force.f.begin(),
                              push.force.f.begin() + static_cast<std::ptrdiff_t>(width));
  parts.force.time = {begin, begin + 0.15 * length, begin + 0.55 * length, push.force.time.back()};
  const double shares[] = {0.0, 2.0, 1.75, 0.0};  // 0.15 x 2 + 0.4 x 1.75 = 1
  parts.force.f.clear();
  for (const double share : shares)
    for (const double each : f) parts.force.f.push_back(share * each);
  return parts;
}

/// A port that is pushed along an axis, for so long [s].
struct Pushing {
  int port = 0, axis = 0;
  double length = 0.0, force = 0.0;  // [s], [N] on every point
};

/// Throws where an impulse is not the change of momentum, however it comes.
void hold_impulse(BodyTrial& trial, const Pushing& pushing) {
  constexpr double tolerance = 0.01;
  const auto& [p, axis, length, force] = pushing;
  const Port& port = trial.about().ports[index(p)];
  trial.restore();
  const Response free = trial.window(length);
  trial.restore();
  const Push push = trial.push(p, axis, length, force);
  Push nodal = push, half = push;
  nodal.force.support = ForceSupport::nodal;
  for (double& f : half.force.f) f *= 0.5;
  const double expected = force * length * port.geometry.count();
  const double rounding = 1.0e3 * one_rounding * std::abs(momentum(free, axis));
  const std::pair<const char*, std::vector<Push>> ways[] = {
      {"one force (STEP)", {push}},
      {"the same in unlike parts (STEP)", {in_parts(push)}},
      {"the same over dual cells (NODAL)", {nodal}},
      {"the same by two partners", {half, half}}};
  for (const auto& [what, pushes] : ways) {
    const Response pushed = trial.again(length, pushes);
    const double got = momentum(pushed, axis) - momentum(free, axis);
    if (std::abs(got - expected) > tolerance * std::abs(expected) + rounding)
      throw BrokenClause(
          fmt::format("an impulse of {:.6g} N s on port {} along axis {}, as {}, changes the "
                      "momentum by {:.6g} kg m/s",
                      expected, port.name, axis, what, got),
          "Forces of partners add up; each substep takes the integral of the force over itself, "
          "whatever its support; records tell the momentum of all mass.");
  }
}

/// The same of a force that begins and ends at nothing, at the body's own levels: schemes that
/// weight forces of both ends of a step keep momentum of such alone.
void hold_levels(BodyTrial& trial, const Pushing& pushing) {
  constexpr double tolerance = 0.02;  // of what their memory keeps: 1 % of generalised alpha
  const auto& [p, axis, length, force] = pushing;
  const Port& port = trial.about().ports[index(p)];
  trial.restore();
  const Response free = trial.window(length);
  const std::vector<double>& times = free.ports[index(p)].trace.time;
  trial.restore();
  Push push = trial.push(p, axis, length, force);
  const std::vector<double> f(push.force.f.begin(), push.force.f.begin() + push.force.width);
  push.force.support = ForceSupport::nodal;
  push.force.time = times;
  push.force.f.clear();
  for (std::size_t i = 0; i < times.size(); ++i)
    for (const double each : f)
      push.force.f.push_back(i == 0 || i + 1 == times.size() ? 0.0 : each);
  const double inner = times[times.size() - 1] + times[times.size() - 2] - times[1] - times[0];
  const double expected = 0.5 * inner * force * port.geometry.count();
  const Response pushed = trial.again(length, {push});
  const double got = momentum(pushed, axis) - momentum(free, axis);
  const double rounding = 1.0e3 * one_rounding * std::abs(momentum(free, axis));
  if (std::abs(got - expected) > tolerance * std::abs(expected) + rounding)
    throw BrokenClause(
        fmt::format("an impulse of {:.6g} N s on port {} along axis {}, by a force that begins and "
                    "ends at 0 (NODAL), changes the momentum by {:.6g} kg m/s",
                    expected, port.name, axis, got),
        "Each substep takes the integral of the force; records tell the momentum of all mass.");
}

/// Supports take a part of what comes, and these tell their reactions.
bool tells_reactions(const Description& body) {
  return std::ranges::any_of(body.columns, [](const std::string& column) {
    return column.find("reaction") != std::string::npos;
  });
}

/// Impulse and momentum, in so short a time that no support can answer. Schemes whose forces are
/// those of instants (NODAL) remember them, and tell momentum by their whole steps: of those it is
/// a window of these. Who takes forces by steps takes the impulse over any step, however short.
std::string impulse(BodyTrial& trial) {
  const Description& body = trial.about();
  if (body.quasi_static) return "the body has no inertia";
  if (!body.frequencies.empty() && body.frequencies.front() > 0.0)
    return "the body is held, and moves in modes alone";
  if (const std::string why = why_no_force(trial); !why.empty()) {
    if (why == not_moved && !tells_reactions(body) && touchable(body))
      throw BrokenClause(
          fmt::format("the body has a mass of {:.6g} kg and tells no reaction of a support, but no "
                      "force moves its ports",
                      body.mass),
          "Let forces on ports move the body, or tell an infinite mass, where nothing moves it.");
    return why;
  }
  const double shortest = trial.step() / 64.0;
  trial.save();
  const Response free = trial.window(trial.length());
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p) {
    const bool levels = free.ports[index(p)].trace.support == ForceSupport::nodal;
    const double force = trial.light_force(p);
    for (int axis = 0; axis < body.dim && force > 0.0; ++axis) {
      try {
        hold_impulse(trial, {p, axis, shortest, 64.0 * force});
      } catch (const BrokenClause& broken) {
        if (tells_reactions(body)) return "supports of the body take a part of impulses";
        if (!levels) throw;
        try {
          hold_impulse(trial, {p, axis, trial.length(), force});
        } catch (const BrokenClause&) {
          if (body.conserves) throw broken;
          hold_levels(trial, {p, axis, trial.length(), force});
        }
      }
    }
  }
  return "";
}

/// [N] that pull a port apart along the axes that it has an extent in, and push it a little; along
/// others they push it: slow ways, which steps follow.
std::vector<double> stretching(const PortGeometry& surface, double force) {
  constexpr double little = 0.1;
  const std::size_t dim = index(surface.dim);
  std::vector<double> forces(surface.points.size(), force);
  for (std::size_t axis = 0; axis < dim; ++axis) {
    double low = surface.points[axis], high = low;
    for (std::size_t k = axis; k < forces.size(); k += dim) {
      low = std::min(low, surface.points[k]);
      high = std::max(high, surface.points[k]);
    }
    for (std::size_t k = axis; k < forces.size() && high > low; k += dim)
      forces[k] *= little + (2.0 * surface.points[k] - low - high) / (high - low);
  }
  return forces;
}

std::vector<Push> opposite(std::vector<Push> pushes) {
  for (Push& push : pushes)
    for (double& each : push.force.f) each = -each;
  return pushes;
}

/// All ports at once, for so long that a body which deforms stores a part of what comes.
void hold_long_work(BodyTrial& trial) {
  constexpr int records = 8;  // of a few steps: what is stored comes and goes
  const Description& body = trial.about();
  const double length = records * trial.length();
  trial.window(trial.length());  // after which no force is there
  trial.save();
  const Response free = trial.window(length, {}, records);
  trial.restore();
  std::vector<Push> pushes;
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p)
    if (const double force = trial.light_force(p); force > 0.0)
      pushes.push_back(
          trial.push(p, length, stretching(body.ports[index(p)].geometry, force / records)));
  const Response pushed = trial.window(length, pushes, records);
  trial.restore();
  const Response back = trial.window(length, opposite(pushes), records);
  hold_energy(body, {free, pushed, back, pushes});
}

std::string work(BodyTrial& trial) {
  if (const std::string why = why_no_force(trial); !why.empty()) return why;
  const Description& body = trial.about();
  const Response before = trial.window(trial.length());  // after which no force is there
  trial.save();
  const Response free = trial.window(trial.length());
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p) {
    const double force = trial.light_force(p);
    if (force <= 0.0) continue;
    trial.restore();
    const Push push = trial.push(p, body.dim - 1, trial.length(), force);
    hold_work(body, before, free, trial.window(trial.length(), {push}), push);
  }
  if (body.conserves && !body.quasi_static) hold_long_work(trial);
  return "";
}

/// Patterns that are tried: all points along each axis, and a point in the middle of the list.
std::vector<std::vector<double>> patterns_of(const PortGeometry& surface) {
  const std::size_t dim = index(surface.dim), size = surface.points.size();
  std::vector<std::vector<double>> patterns;
  for (std::size_t axis = 0; axis < dim; ++axis) {
    std::vector<double>& all = patterns.emplace_back(size, 0.0);
    for (std::size_t k = axis; k < size; k += dim) all[k] = 1.0;
    if (surface.count() == 1) continue;
    patterns.emplace_back(size, 0.0)[size / dim / 2 * dim + axis] = 1.0;
  }
  return patterns;
}

/// The pulse that a pattern of a kernel is the answer to, as a force over a window.
Push pulse(int port, const std::vector<double>& pattern, const PortKernel& kernel, double force,
           const std::vector<double>& times) {
  Push push{port, Waveform(static_cast<int>(pattern.size()))};
  push.force.support = kernel.support;
  push.force.time = times;
  push.force.f.assign(times.size() * pattern.size(), 0.0);
  for (std::size_t k = 0; k < pattern.size(); ++k)
    push.force.f[pattern.size() + k] = force * pattern[k];
  return push;
}

/// Motion with a pulse, and without it, against a pattern of a kernel.
void compare(const Waveform& one, const Waveform& other, const PortKernel& kernel,
             std::size_t pattern, double force, double tolerance, const Port& port) {
  const std::size_t width = index(kernel.width);
  // Of the way that loads and velocities carry a port, solvers leave so much: of a body that has
  // flown far it is seen beside the way by a light force.
  constexpr double left_by_solvers = 1.0e-9;
  double most = 0.0, off = 0.0, size = 0.0, carried = 0.0;
  std::size_t worst = 0;
  for (std::size_t i = 1; i < one.size(); ++i)
    for (std::size_t k = 0; k < width; ++k) {
      const double told =
          force * kernel.displacement[(i - 1) * kernel.per_step() + pattern * width + k];
      const double went = one.u[i * width + k] - other.u[i * width + k];
      most = std::max({most, std::abs(told), std::abs(went)});
      size = std::max(size, std::abs(one.u[i * width + k]));
      carried = std::max(carried, std::abs(other.u[i * width + k] - other.u[k]));
      if (std::abs(told - went) > off) worst = i;
      off = std::max(off, std::abs(told - went));
    }
  if (off > tolerance * most + 64.0 * one_rounding * size + left_by_solvers * carried)
    throw BrokenClause(
        fmt::format("port {} moves by a pulse of force otherwise than its kernel says: {:.3g} of "
                    "the way off at the end of substep {}",
                    port.name, off / most, worst),
        "A kernel is the way of the port by a force over the first substep (STEP) or over the dual "
        "cell around its end (NODAL), from rest, at the ends of substeps.");
}

std::string kernel(BodyTrial& trial) {
  const Description& body = trial.about();
  if (!body.can.kernel) return "the body answers no probe";
  if (const std::string why = why_no_force(trial); !why.empty()) return why;
  constexpr double tolerance = 1.0e-5;
  trial.save();
  const Response free = trial.window(trial.length());
  const std::vector<double> times = free.ports.front().trace.time;
  const int count = static_cast<int>(times.size()) - 1;
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p) {
    const double force = trial.light_force(p);
    if (force <= 0.0) continue;
    trial.restore();
    const Port& port = body.ports[index(p)];
    const std::vector<std::vector<double>> patterns = patterns_of(port.geometry);
    Probing asked{p, {}, trial.step(), count};
    for (const std::vector<double>& pattern : patterns)
      asked.patterns.insert(asked.patterns.end(), pattern.begin(), pattern.end());
    const std::uint64_t hash = trial.body().state_hash();
    const PortKernel told = trial.body().probe(asked);
    if (trial.body().state_hash() != hash)
      throw BrokenClause("a probe changes the state", "It leaves the state as it is.");
    if (!body.linear) continue;
    for (std::size_t k = 0; k < patterns.size(); ++k) {
      const Response pushed =
          trial.again(trial.length(), {pulse(p, patterns[k], told, force, times)});
      compare(pushed.ports[index(p)].trace, free.ports[index(p)].trace, told, k, force, tolerance,
              port);
    }
  }
  return body.linear ? "" : "the body is not linear: its kernel is that of its rest alone";
}

constexpr Clause clauses_on_forces[] = {
    {"momentum", "impulses of forces are the change of momentum, for any pair of steps", impulse},
    {"work", "work on a port is force times way, and the energy of the body", work},
};

constexpr Clause clauses_on_kernels[] = {
    {"kernel", "ports give way to forces as kernels say; a probe leaves the state", kernel},
};

}  // namespace

std::span<const Clause> clauses_of_kernels() { return clauses_on_kernels; }
std::span<const Clause> clauses_of_forces() { return clauses_on_forces; }

}  // namespace abut
