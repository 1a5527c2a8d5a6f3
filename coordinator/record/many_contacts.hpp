#pragma once

#include <array>
#include <map>
#include <vector>

#include "base/archive.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/port_reader.hpp"
#include "coordinator/record/taken_back.hpp"

namespace abut {

/// Measures of an interface of any two surfaces: sums over its pairs, and the largest of any.
class ManyContacts {
 public:
  /// `interface`: index into the run's; it is one of many.
  ManyContacts(const RunStart& start, int interface);

  void on_window(const WindowReport& report);
  void on_event(const RunEvent& event);
  void write(Measures& out) const;

  void state(Archive& archive);

 private:
  void read_force(const Waveform& force, const PortReader& reader, const PortGeometry& partner,
                  TakenBack& taken);

  const RunStart& start_;
  int index_;
  std::map<std::array<int, 4>, double> dissipated_;     // [J] so far, by bodies and ports
  std::map<std::array<int, 4>, TakenBack> taken_back_;  // the same
  int closings_ = 0, open_ = 0;                         // open_: pairs that press now
  double begin_ = 0.0, end_ = 0.0;                      // [s] first touch, last release
  double impulse_ = 0.0, peak_ = 0.0;                   // [N s], [N]
};

}  // namespace abut
