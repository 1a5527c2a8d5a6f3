#include "coordinator/coupling/internal_contact.hpp"

#include <algorithm>

namespace abut {

namespace {

struct Traces {
  const Waveform& t0;
  const Waveform& t1;
  const Joint& joint;

  double force(std::size_t i) const { return -joint.normal_of(0) * t0.f[i]; }
  double gap(std::size_t i) const { return joint.gap(t0.u[i], t1.u[i]); }
  double approach(std::size_t i) const { return joint.normal_of(0) * (t0.v[i] - t1.v[i]); }

  /// The force is there at i and was not before. The motion before it is not yet braked and tells
  /// when the gap closes.
  InternalContact::Change closing(std::size_t i) const {
    if (i == 0) return {true, t0.time[0], approach(0)};
    const double speed = approach(i - 1);
    const double latest = t0.time[i] + (t0.time[i] - t0.time[i - 1]);
    const double crossing = speed > 0.0 ? t0.time[i - 1] + gap(i - 1) / speed : t0.time[i];
    return {true, std::clamp(crossing, t0.time[i - 1], latest), speed};
  }
  /// The force is gone at i.
  InternalContact::Change opening(std::size_t i) const {
    double crossing = t0.time[i - 1];
    if (i >= 2 && force(i - 2) > force(i - 1)) {
      const double slope = (force(i - 2) - force(i - 1)) / (t0.time[i - 1] - t0.time[i - 2]);
      crossing = std::min(t0.time[i], crossing + force(i - 1) / slope);
    }
    return {false, crossing, 0.0};
  }
};

}  // namespace

InternalContact watch_internal_contact(Joint& joint, const Bodies& bodies) {
  const Traces traces{trace_of(bodies, joint.sides[0]), trace_of(bodies, joint.sides[1]),
                      joint};
  InternalContact seen;
  for (std::size_t i = 0; i < traces.t0.size(); ++i) {
    const bool pressed = traces.force(i) > 0.0;
    seen.pressed = seen.pressed || pressed;
    if (pressed == joint.pressing()) continue;
    seen.changes.push_back(pressed ? traces.closing(i) : traces.opening(i));
    joint.contact = pressed ? Joint::State::pressing : Joint::State::apart;
  }
  return seen;
}

}  // namespace abut
