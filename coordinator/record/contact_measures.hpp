#pragma once

#include <array>
#include <limits>
#include <string>

#include "coordinator/closed_form.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/port_reader.hpp"

namespace abut {

/// Integral of a square over the part of an interval of time that a run covers, and the largest
/// magnitude there.
class SquareIntegral {
 public:
  SquareIntegral() = default;
  SquareIntegral(double from, double to) : from_(from), to_(to) {}

  /// Adds a stretch of time with the values at its ends, by the trapezoid rule on the square.
  void add(double begin, double end, double at_begin, double at_end);
  /// Root of the mean square over the interval, with `missing` as the value where nothing was
  /// added.
  double rms(double missing) const;
  /// The same over what was added.
  double rms_of_covered() const;
  /// Largest magnitude in the interval, with `missing` as the value where nothing was added.
  double largest(double missing) const;
  double end() const { return to_; }

 private:
  double from_ = -std::numeric_limits<double>::infinity();
  double to_ = std::numeric_limits<double>::infinity();
  double bare() const;
  double sum_ = 0.0, covered_ = 0.0, largest_ = 0.0;
};

/// Measures of one interface: when it was closed, and the force and motion of its contact as the
/// kinematic side reports them at every substep. Time that the interface is closed counts by whole
/// windows; begin and end of contact are those of the events, which are located inside windows.
class ContactMeasures {
 public:
  /// `exact` may be null; `start` and `exact` must outlive this.
  ContactMeasures(const RunStart& start, int interface, const BarImpact* exact);

  void on_window(const WindowReport& report);
  void on_event(const RunEvent& event);
  void write(double run_end, Measures& out) const;

 private:
  struct Sample {
    double time = 0.0, force = 0.0;
    bool known = false;
  };

  void add_closed(const Waveform& trace, int side);
  void add_force(double from, double to, double force_from, double force_to);
  void add_velocity(const Waveform& trace, int side, std::size_t i);
  void follow(double time, double force);  // half-force crossing
  void vanish();                           // the force is gone at the next substep
  void write_plain(Measures& out) const;
  void write_errors(double run_end, Measures& out) const;
  std::string name(const char* what) const;

  const RunStart& start_;
  int index_;
  InterfaceInfo info_;
  const BarImpact* exact_;
  std::array<PortReader, 2> readers_;

  double begin_ = 0.0, end_ = 0.0;  // [s] of the first contact, of the last one
  int count_ = 0;
  bool open_ = true;
  double closed_time_ = 0.0, impulse_ = 0.0, peak_ = 0.0;
  double gap_min_;
  SquareIntegral velocity_, velocity_error_, force_error_, force_error_tail_;
  Sample last_;
  double last_step_ = 0.0;
  double half_force_time_ = 0.0;
  bool half_force_seen_ = false;
};

}  // namespace abut
