#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "coordinator/record/observer.hpp"

namespace abut {

/// Of an interface that a closed form describes.
inline constexpr const char* contact_errors[] = {
    "begin_error",        "release_error",   "release_error_half_force",
    "force_max_error",    "force_rms_error", "force_rms_error_tail",
    "velocity_rms_error", "count_error",     "impulse_error"};

/// The parts of a scene that give measures their names; known before a run as well as after it.
struct MeasureScope {
  int dim = 1;
  std::vector<std::string> bodies;
  std::vector<std::string> ports;  // "body.port" of those that interfaces join
  std::vector<std::string> interfaces;
  bool filtered = false;           // the scene names a filter of contact forces
  bool steady = false;             // and a time after which they should not change
  std::vector<std::string> exact;  // the interfaces that a closed form describes
  std::vector<std::string> told;   // "body.<name>.<measure>" of Description::measures
};

/// Name of a number that a body tells of itself.
std::string body_measure(const std::string& body, const std::string& measure);

/// All that bodies tell of themselves.
std::vector<std::string> told_measures(std::span<const Description* const> bodies);

/// The scope of a run; `exact` are the interfaces that a closed form describes.
MeasureScope measure_scope(const RunStart& start, std::vector<std::string> exact);

/// Every measure that a run of this scope reports, sorted.
std::vector<std::string> known_measures(const MeasureScope& scope);

/// "The nearest are: a, b, c." of measures that there are.
std::string nearest_measures(const std::string& measure, std::vector<std::string> known);

/// Throws InputError naming the nearest known measures when there is none of this name.
void require_measure(const std::string& measure, const MeasureScope& scope);

/// Numbers that say what a run has done, by name. A measure without a value is NaN here and has a
/// note.
struct Measures {
  MeasureScope scope;
  std::map<std::string, double> values;
  std::map<std::string, std::string> notes;  // by measure: why there is no value
  // [J] that errors of the energy are relative to: by body where there is an oracle, and in all
  std::map<std::string, double> energy_scales;
  double total_energy_scale = 0.0;

  void set(const std::string& name, double value) { values[name] = value; }
  void none(const std::string& name, const std::string& why);
};

}  // namespace abut
