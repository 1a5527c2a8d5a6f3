#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/fields.hpp"
#include "coordinator/checkpoint_spec.hpp"
#include "coordinator/force_filter_spec.hpp"

namespace abut {

struct FieldOutputSpec {
  int every = 1;  // windows
  void fields(Fields& f);
};

/// Measures of bodies over time.
struct MeasuresOutputSpec {
  std::vector<std::string> of;  // body.NAME.MEASURE
  int every = 1;                // windows
  void fields(Fields& f);
};

struct OutputSpec {
  int records_per_window = 1;                   // rows of history.csv per controller window
  std::optional<FieldOutputSpec> field_output;  // key fields; absent: no body is asked
  std::optional<MeasuresOutputSpec> measures;   // absent: bodies tell theirs at the end alone
  std::optional<ForceFilterSpec> force_filter;  // absent: no measure of filtered forces
  std::optional<double> steady_after;           // [s] absent: no measure of ripple
  std::optional<CheckpointSpec> checkpoint;     // absent: one alone, where a signal ends the run
  /// Number of windows between the places where bodies that fly free stop, so that fields and
  /// measures find them at each of theirs: the greatest common divisor of both; 0: none is asked.
  int looked_at_every() const;
  void fields(Fields& f);
};

}  // namespace abut
