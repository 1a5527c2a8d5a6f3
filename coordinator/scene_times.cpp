#include "coordinator/scene_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/count.hpp"
#include "base/input_errors.hpp"

namespace abut {

namespace {

/// Of a step in contact: port kernels and the iteration keep a value per step of a window.
constexpr double most_contact_steps = 1.0e6;
/// Multiples of a step that are tried for a proposal, up and down.
constexpr int most_trials = 2000;

/// Whether `whole` holds a whole number of `part`s, up to the round-off of decimal input.
bool divides(double part, double whole) {
  const double count = whole / part;
  const double nearest = std::round(count);
  return nearest >= 1.0 && std::abs(count - nearest) <= 1.0e-9 * nearest;
}

/// Shortest time that the rounding of times up to `largest` leaves whole: to a millionth, as far as
/// substeps are told apart.
double shortest_time(const TimeSpec& time) {
  const double largest = std::max(std::abs(time.begin), std::abs(time.end));
  return 1.0e6 * std::numeric_limits<double>::epsilon() * largest;
}

double largest_time(const TimeSpec& time) {
  return std::max(std::abs(time.begin), std::abs(time.end));
}

/// As a proposal is printed, and as it will be read again.
std::string printed(double seconds) { return fmt::format("{:.12g}", seconds); }
double read_again(double seconds) { return std::strtod(printed(seconds).c_str(), nullptr); }

struct Rules {
  const Scene& scene;
  std::span<const Description* const> bodies;

  bool coupled(std::size_t body) const {
    const std::string prefix = scene.bodies[body].first + ".";
    for (const auto& [name, interface] : scene.interfaces) {
      if (is_inside(interface.transmission)) continue;
      for (const std::string& side : interface.sides)
        if (side.starts_with(prefix)) return true;
    }
    return false;
  }
  double most_steps(std::size_t body) const {
    return coupled(body) ? most_contact_steps : most_substeps;
  }
  double part() const { return 1.0 / scene.output.records_per_window; }
  /// [s]; 0 where any step fits, or a body has not told yet what it is.
  double step(std::size_t body) const { return bodies[body] != nullptr ? bodies[body]->step : 0.0; }
  bool window_holds(double step, double window) const {
    return divides(step, window) && (part() == 1.0 || divides(step, window * part()));
  }
  /// With another window, and for one body with another step.
  bool all_hold(double window, std::size_t changed, double its_step) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const double one = i == changed ? its_step : step(i);
      if (one <= 0.0) continue;
      if (!window_holds(one, window) || window / one > most_steps(i)) return false;
    }
    return true;
  }
  bool all_hold(double window) const { return all_hold(window, bodies.size(), 0.0); }

  /// Windows below and above the present one that every rule accepts, nearest first.
  std::vector<std::string> windows() const {
    double longest = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) longest = std::max(longest, step(i));
    const double unit = longest * scene.output.records_per_window;
    const double present = scene.time.window;
    const double run = scene.time.end - scene.time.begin;
    std::vector<std::string> found;
    for (const double direction : {-1.0, 1.0}) {
      double count = std::floor(present / unit) + (direction > 0.0 ? 1.0 : 0.0);
      for (int trial = 0; trial < most_trials && count >= 1.0; ++trial, count += direction) {
        const double window = read_again(count * unit);
        if (window > run) break;
        if (!all_hold(window)) continue;
        found.push_back(printed(window) + " s");
        break;
      }
    }
    return found;
  }
  /// Steps of one body below and above its present one, the longer only where it stays stable.
  std::vector<std::string> steps(std::size_t body) const {
    const Description& one = *bodies[body];
    const double window = scene.time.window;
    const double unit = window * part();
    std::vector<std::string> found;
    const double below = std::floor(unit / one.step);
    for (const double count : {below + 1.0, below}) {
      if (count < 1.0) continue;
      const double step = read_again(unit / count);
      if (step > one.step && !(step <= one.stable_step)) continue;
      if (all_hold(window, body, step)) found.push_back(printed(step) + " s");
    }
    return found;
  }
  std::string proposal(std::size_t body) const {
    const std::vector<std::string> windows_found = windows(), steps_found = steps(body);
    std::string text;
    if (!windows_found.empty())
      text = fmt::format("a window of {}", fmt::join(windows_found, " or "));
    if (!steps_found.empty())
      text += fmt::format("{}the body a step of {}", text.empty() ? "" : ", or ",
                          fmt::join(steps_found, " or "));
    if (text.empty()) text = "all bodies steps that divide one window";
    return fmt::format("Give {}.", text);
  }
};

void check_count(const Rules& rules, std::size_t i, const Document& document) {
  const TimeSpec& time = rules.scene.time;
  const double step = rules.bodies[i]->step;
  const std::string& name = rules.scene.bodies[i].first;
  if (step < shortest_time(time)) {
    throw InputError(fmt::format("takes steps of {:g} s, which the rounding of times up to {:g} s "
                                 "does not leave whole",
                                 step, largest_time(time)),
                     document.where("bodies." + name + ".integrator"),
                     fmt::format("Give a step of at least {:.3g} s, or times nearer to zero.",
                                 shortest_time(time)));
  }
  if (time.window / step > rules.most_steps(i)) {
    throw InputError(
        fmt::format("holds {:.3g} steps of body {}, more than {:g}{}", time.window / step, name,
                    rules.most_steps(i), rules.coupled(i) ? " for bodies that meet others" : ""),
        document.where("time.window"),
        fmt::format("Give a window of at most {:.6g} s, or the body a longer step.",
                    rules.most_steps(i) * step));
  }
}

void check_division(const Rules& rules, std::size_t i, const Document& document) {
  const double step = rules.bodies[i]->step, window = rules.scene.time.window;
  const std::string& name = rules.scene.bodies[i].first;
  if (!divides(step, window)) {
    throw InputError(
        fmt::format("must hold a whole number of steps of body {}, but {:.9g} s is {:.6g} steps "
                    "of {:.9g} s",
                    name, window, window / step, step),
        document.where("time.window"), rules.proposal(i));
  }
  if (!rules.window_holds(step, window)) {
    throw InputError(
        fmt::format("must cut a window into whole steps of body {}, but a window holds {:.0f}",
                    name, window / step),
        document.where("output.records_per_window"),
        "Give a divisor of every body's number of steps per window");
  }
}

}  // namespace

void check_times(const TimeSpec& time, const Document& document) {
  const double run = time.end - time.begin;
  if (time.window > run * (1.0 + 1.0e-9)) {
    throw InputError(fmt::format("is longer than the run of {:.9g} s", run),
                     document.where("time.window"),
                     fmt::format("Give a window of at most {:.12g} s.", run));
  }
  if (time.window >= shortest_time(time)) return;
  throw InputError(fmt::format("is lost in the rounding of times up to {:g} s", largest_time(time)),
                   document.where("time.window"),
                   fmt::format("Give a window of at least {:.3g} s, or times nearer to zero.",
                               shortest_time(time)));
}

void check_until(const Scene& scene, const Document& document) {
  if (!scene.time.until) return;
  const auto& [key, name] = std::visit(
      [](const auto& event) {
        return std::pair(fmt::format("time.until.{}", event.name), event.interface);
      },
      *scene.time.until);
  if (name == everything_name && scene.everything() != nullptr) return;
  std::vector<std::string> names;
  for (const auto& [known, interface] : scene.interfaces) {
    if (interface.tied) continue;
    if (known == name) return;
    names.push_back(known);
  }
  if (scene.everything() != nullptr) names.emplace_back(everything_name);
  throw InputError(fmt::format("is {}, but the scene has no contact of that name", name),
                   document.where(key),
                   names.empty() ? "Leave until out: nothing of the scene comes into contact."
                                 : fmt::format("Choose one of: {}.", fmt::join(names, ", ")));
}

void check_steps(const Scene& scene, std::span<const Description* const> bodies,
                 const Document& document) {
  const Rules rules{scene, bodies};
  InputErrors errors;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (rules.step(i) > 0.0) errors.gather([&] { check_count(rules, i, document); });
  // One window cures them all: the first body that it does not fit tells of it.
  for (std::size_t i = 0; i < bodies.size() && errors.count() == 0; ++i)
    if (rules.step(i) > 0.0) errors.gather([&] { check_division(rules, i, document); });
  errors.raise();
}

}  // namespace abut
