#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "contract/substeps.hpp"
#include "coordinator/coupling/convergence.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

// What the conditions at joints have in common.

inline Substeps substeps_of(const Bodies& bodies, const Side& side, const TimeWindow& window) {
  return Substeps::divide(window.begin, window.end, bodies.describe(side.body).step);
}

/// Row of a waveform's field at a stored time (width).
inline std::span<const double> row(const Waveform& wave, const std::vector<double>& field,
                                   std::size_t time) {
  const std::size_t width = index(wave.width);
  ABUT_ASSERT(field.size() == wave.size() * width);
  return std::span(field).subspan(time * width, width);
}
/// The same, kept.
inline void keep_row(const Waveform& wave, const std::vector<double>& field, std::size_t time,
                     std::vector<double>& to) {
  const std::span<const double> from = row(wave, field, time);
  to.assign(from.begin(), from.end());
}

/// One field of a point at a time.
inline double value_at(const Waveform& wave, const std::vector<double>& field, double time) {
  double value;
  wave.interpolate(field, time, {&value, 1});
  return value;
}

/// Begins a waveform anew, with the times of these substeps.
inline void lay_times(const Substeps& steps, int width, Waveform& wave) {
  wave.clear();
  wave.width = width;
  for (int i = 0; i <= steps.count; ++i) wave.time.push_back(steps.time(i));
}

inline double largest(std::span<const double> values) {
  double most = 0.0;
  for (double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// Displacements are known to this many units of round-off of their own size.
constexpr double roundoff_units = 64.0;
inline double roundoff_of(double displacement, double travelled) {
  return roundoff_units * std::numeric_limits<double>::epsilon() *
         std::max(std::abs(displacement), std::abs(travelled));
}

/// Velocity against which mismatch is measured: of the first touch, or what the contact force moves
/// in a step.
inline double reference_velocity(const Joint& joint, double compliance, double step) {
  return std::max(joint.contact.closing_speed, joint.contact.force_scale * compliance / step);
}

/// Velocity and force that go with each other: neither is measured against less than a thousandth
/// of what the other one causes in a step, or the first touch of a window would be asked for digits
/// that it does not have.
inline void balance(ReferenceScales& scale, double compliance) {
  constexpr double share = 1.0e-3;
  scale.velocity = std::max(scale.velocity, share * scale.force * compliance / scale.step);
  scale.force = std::max(scale.force, share * scale.velocity * scale.step / compliance);
}

/// Where the last reply told that a side would go over these substeps without partners; null: it
/// did not tell, or of another window.
inline const Waveform* look_of(const Bodies& bodies, const Side& side, const Substeps& steps) {
  const Waveform& look = port_of(bodies, side).ahead;
  const double rounding = 1.0e-9 * steps.step;  // of a window's end
  const bool fits = !look.empty() && static_cast<int>(look.size()) == steps.count + 1 &&
                    look.time.front() == steps.begin &&
                    std::abs(look.time.back() - steps.end) <= rounding;
  return fits ? &look : nullptr;
}

/// A window that was cut short starts from the iterate of the longer one.
inline bool covers(const Waveform& guess, const Substeps& steps) {
  return !guess.empty() && guess.time.front() == steps.begin && guess.time.back() >= steps.end;
}

}  // namespace abut
