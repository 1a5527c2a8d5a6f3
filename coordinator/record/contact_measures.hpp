#pragma once

#include <array>
#include <optional>
#include <string>

#include "coordinator/record/contact_errors.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/port_reader.hpp"
#include "coordinator/record/square_integral.hpp"

namespace abut {

/// Measures of one interface: when it was closed, and the force and motion of its contact as the
/// kinematic side reports them at every substep. Time that the interface is closed counts by whole
/// windows; begin and end of contact are those of the events, which are located inside windows.
class ContactMeasures {
 public:
  /// `start` must outlive this.
  ContactMeasures(const RunStart& start, int interface, std::optional<ContactErrors> errors);

  void on_window(const WindowReport& report);
  void on_event(const RunEvent& event);
  void write(double run_end, Measures& out) const;

 private:
  void add_closed(const Waveform& trace, int side);
  void add_force(double from, double to, double force_from, double force_to);
  void add_velocity(const Waveform& trace, int side, std::size_t i);
  void write_plain(double run_end, Measures& out) const;
  std::string name(const char* what) const;

  const RunStart& start_;
  int index_;
  InterfaceInfo info_;
  std::array<PortReader, 2> readers_;

  SeenContact seen_;
  // [s] between contact's begins and ends (touching without force is no contact), and in all
  // windows: ties have no events
  double closed_time_ = 0.0;
  double joined_time_ = 0.0;
  double closed_since_ = 0.0;
  double peak_ = 0.0;
  double gap_min_;
  SquareIntegral velocity_;
  double last_step_ = 0.0;
  std::optional<ContactErrors> errors_;
};

}  // namespace abut
