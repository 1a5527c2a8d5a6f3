#pragma once

#include <span>
#include <vector>

#include "coordinator/passive/common_step.hpp"

namespace abut {

/// Puts passive steps into the bodies' responses, so that everybody who reads those of a window
/// finds what they always find: motion and forces of ports, reactions on partners, records.
class PassiveRecord {
 public:
  /// Who is told of forces between two ports: the kinematic side of their joint.
  struct Told {
    Side kinematic, partner;
  };

  PassiveRecord(const TouchingSurfaces& surfaces, Bodies& bodies)
      : surfaces_(surfaces), bodies_(bodies) {}

  /// Before the first step of a window: how it begins.
  void begin(double time, const CommonStep& state, std::vector<Told> told);
  void add(const CommonStep& step, double begin, double end);
  /// The state at the end of the last step is a record.
  void record(const CommonStep& state);
  /// After the last step.
  void finish();

 private:
  /// On the partner, as the kinematic side tells it.
  Waveform& force_of(const Told& pair);
  void append(double time, const CommonStep& state);
  void widen(const CommonStep& state);
  void add_forces(const CommonStep& step, double length);
  void add_ties(const CommonStep& step, double length);

  const TouchingSurfaces& surfaces_;
  Bodies& bodies_;
  std::vector<Told> told_;
  std::vector<std::vector<double>> lower_, upper_;  // [m] (ports of all bodies) since the record
};

}  // namespace abut
