#include "coordinator/record/measure_names.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/key.hpp"
#include "base/one_each.hpp"
#include "coordinator/record/port_reader.hpp"
#include "coordinator/record/recorded_bodies.hpp"

namespace abut {
namespace {

bool contains(const std::vector<std::string>& sorted, const std::string& name) {
  return std::binary_search(sorted.begin(), sorted.end(), name);
}

bool needs_filter(const std::string& measure, MeasureScope scope) {
  scope.filtered = true;
  return contains(known_measures(scope), measure);
}

bool needs_time(const std::string& measure, MeasureScope scope) {
  scope.steady = true;
  return contains(known_measures(scope), measure);
}

bool needs_closed_form(const std::string& measure, MeasureScope scope) {
  scope.exact = scope.interfaces;
  return contains(known_measures(scope), measure);
}

}  // namespace

std::string body_measure(const std::string& body, const std::string& measure) {
  return fmt::format("body.{}.{}", body, measure);
}

std::vector<std::string> told_measures(std::span<const Description* const> bodies) {
  std::vector<std::string> names;
  for (const Description* body : bodies) {
    for (const std::string& measure : body->measures)
      names.push_back(body_measure(body->name, measure));
  }
  return names;
}

MeasureScope measure_scope(const RunStart& start, std::vector<std::string> exact) {
  MeasureScope scope;
  scope.exact = std::move(exact);
  for (const RecordedBody& body : recorded_bodies(start.bodies)) {
    scope.dim = std::max(scope.dim, body.dim);
    scope.bodies.push_back(body.name);
  }
  scope.told = told_measures(start.bodies);
  for (const InterfaceInfo& interface : start.interfaces) {
    scope.interfaces.push_back(interface.name);
    if (interface.many) continue;
    for (const int side : {0, 1}) {
      const Description& body = *start.bodies[interface.body[side]];
      scope.ports.push_back(body.name + "." + body.ports[interface.port[side]].name);
    }
  }
  return scope;
}

std::vector<std::string> known_measures(const MeasureScope& scope) {
  std::vector<std::string> names = {"energy.total.begin",
                                    "energy.total.relative_drift_max",
                                    "energy.total.relative_drift_end",
                                    "momentum.total",
                                    "schwarz.iterations_mean",
                                    "schwarz.iterations_max",
                                    "exchanges",
                                    "windows",
                                    "contact_windows"};
  if (scope.dim > 1) names.push_back("angular_momentum.total");
  for (const std::string& interface : scope.interfaces) {
    for (const char* what :
         {"begin", "end", "duration", "count", "closings", "impulse", "force_mean", "force_peak",
          "velocity_rms", "gap_min", "dissipated", "jump_max"})
      names.push_back(fmt::format("contact.{}.{}", interface, what));
    if (scope.filtered) names.push_back(fmt::format("contact.{}.force_peak_filtered", interface));
    if (scope.steady) names.push_back(fmt::format("contact.{}.force_ripple", interface));
  }
  for (const std::string& interface : scope.exact)
    for (const char* what : contact_errors)
      names.push_back(fmt::format("contact.{}.{}", interface, what));
  for (const std::string& body : scope.bodies) {
    names.push_back(fmt::format("energy.{}.relative_error_max", body));
    names.push_back(fmt::format("energy.{}.relative_error_end", body));
    for (int axis = 0; axis < scope.dim; ++axis) {
      names.push_back(fmt::format("momentum.{}.end{}", body, axis_ending(scope.dim, axis)));
      names.push_back(fmt::format("mean_velocity.{}.end{}", body, axis_ending(scope.dim, axis)));
    }
    for (int axis = first_rotation_axis(scope.dim); axis < 3; ++axis)
      names.push_back(fmt::format("angular_momentum.{}.end{}", body, axis_ending(3, axis)));
  }
  for (const std::string& port : scope.ports)
    for (int axis = 0; axis < scope.dim; ++axis)
      names.push_back(fmt::format("position.{}.max{}", port, axis_ending(scope.dim, axis)));
  names.insert(names.end(), scope.told.begin(), scope.told.end());
  keep_one_each(names);
  return names;
}

std::string nearest_measures(const std::string& measure, std::vector<std::string> known) {
  std::ranges::stable_sort(
      known, {}, [&measure](const std::string& name) { return edit_distance(measure, name); });
  known.resize(std::min<std::size_t>(known.size(), 3));
  return fmt::format("The nearest are: {}.", fmt::join(known, ", "));
}

void require_measure(const std::string& measure, const MeasureScope& scope) {
  const std::vector<std::string> known = known_measures(scope);
  if (contains(known, measure)) return;
  if (needs_closed_form(measure, scope))
    throw InputError(
        fmt::format("measure '{}' compares with a closed form, which is not named", measure),
        "meta.expect", "Name meta.closed_form for this interface, or leave the expectation out.");
  if (needs_filter(measure, scope))
    throw InputError(
        fmt::format("measure '{}' is of filtered forces, and no filter is named", measure),
        "meta.expect",
        "Name output.force_filter, for example {cfc: {class: 600}}, or leave the expectation out.");
  if (needs_time(measure, scope))
    throw InputError(
        fmt::format("measure '{}' is of forces that should not change, and no time is named",
                    measure),
        "meta.expect",
        "Name output.steady_after, the time from which they count, or leave the expectation out.");
  throw InputError(fmt::format("there is no measure '{}'", measure), "meta.expect",
                   nearest_measures(measure, known));
}

void Measures::none(const std::string& name, const std::string& why) {
  values[name] = std::numeric_limits<double>::quiet_NaN();
  notes[name] = why;
}

}  // namespace abut
