#pragma once

#include <array>
#include <string>

#include "base/archive.hpp"
#include "coordinator/exact/bar_row.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/square_integral.hpp"

namespace abut {

/// What a run has shown of one interface, to be held against the exact solution.
struct SeenContact {
  double begin = 0.0, end = 0.0;  // [s] of the first contact, of the last one
  int count = 0;
  bool open = true;       // at the end of the run
  double impulse = 0.0;   // [N s]
  double together = 0.0;  // [s] that its contacts were counted with
};

/// Errors of one interface against the exact solution: docs/OUTPUT.md says what each one means.
/// Forces and velocities are compared on every stretch of constant exact force, without its ends.
class ContactErrors {
 public:
  /// The row must outlive this; `sides` are the interface's ends in the row.
  ContactErrors(const BarRow& row, const RowContact& exact);

  /// A stretch of time with the contact forces at its ends [s] [N].
  void add_force(double from, double to, double force_from, double force_to);
  /// The same with the velocities of the kinematic side, 0 or 1, along x [m/s].
  void add_velocity(int side, double from, double to, double v_from, double v_to);
  /// The contact force at one time; times come in their order, and one that came before is left
  /// out: windows tell the state at their begin again.
  void follow(double time, double force);
  /// `interface`: name in the run.
  void write(const std::string& interface, const SeenContact& seen, double run_end,
             Measures& out) const;

  void state(Archive& archive);

 private:
  struct Sample {
    double time = 0.0, force = 0.0;
    bool known = false;
  };

  void write_times(const std::string& prefix, const SeenContact& seen, Measures& out) const;

  const RowContact& exact_;
  std::array<double, 2> velocity_jump_;  // [m/s] of each side that the largest force makes
  StepError force_, force_tail_, velocity_;
  Sample last_;
  double step_ = 0.0;  // [s] between the last two samples
  double half_force_time_ = 0.0;
  bool half_force_seen_ = false;
};

}  // namespace abut
