#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "base/archive.hpp"
#include "coordinator/record/closed_velocity.hpp"
#include "coordinator/record/contact_errors.hpp"
#include "coordinator/record/contact_times.hpp"
#include "coordinator/record/force_filter.hpp"
#include "coordinator/record/force_ripple.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/port_reader.hpp"
#include "coordinator/record/pushes.hpp"
#include "coordinator/record/taken_back.hpp"

namespace abut {

/// Measures of one interface: when it was closed, and the force and motion of its contact as the
/// kinematic side reports them at every substep. Times are those of the events, forces those of the
/// traces: how windows lie, and in which of them the interface was iterated, makes no difference.
class ContactMeasures {
 public:
  /// `start` must outlive this; `filter` may be null; `steady_after` [s]: from when ripple counts.
  ContactMeasures(const RunStart& start, int interface, std::optional<ContactErrors> errors,
                  std::unique_ptr<ForceFilter> filter, std::optional<double> steady_after);

  void on_window(const WindowReport& report);
  void on_event(const RunEvent& event);
  /// Once, at the end.
  void write(double run_end, Measures& out);

  void state(Archive& archive);

 private:
  void read_gap(const WindowReport& report, const std::array<const Waveform*, 2>& traces);
  const Waveform* force_of(const WindowReport& report, std::size_t kinematic) const;
  void read_force(const Waveform& trace, const PortReader& reader);
  void read_rest(const Waveform& trace);
  void write_force(double closed, Measures& out);
  void write_times(Measures& out) const;
  int count() const;
  std::string name(const char* what) const;

  const RunStart& start_;
  /// In two and three dimensions: they have no gap, and the iteration tells of their force.
  bool joins_surfaces() const { return info_.tied && readers_[0].port().geometry.dim > 1; }

  int index_;
  InterfaceInfo info_;
  double missed_ = 0.0;  // [m] of joined surfaces
  std::array<PortReader, 2> readers_;

  ContactTimes times_;
  Pushes pushes_;
  ClosedVelocity velocity_;
  TakenBack taken_back_;
  double impulse_ = 0.0;     // [N s]
  double peak_ = 0.0;        // [N]
  double dissipated_ = 0.0;  // [J]
  double gap_min_;           // [m]
  std::optional<ContactErrors> errors_;
  std::unique_ptr<ForceFilter> filter_;
  std::optional<ForceRipple> ripple_;
};

}  // namespace abut
