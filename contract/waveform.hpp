#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace abut {

/// How a force that is known once per substep is spread over time.
enum class ForceSupport {
  // f(t_i) acts over the dual cell around t_i (trapezoid rule): massless layers, implicit bodies
  nodal,
  step,    // f_i is constant over the substep that ends at t_i: contact kicks
  linear,  // f is linear between its times: contact of surfaces
};

/// Motion and force on a port as functions of time over a window.
///
/// Structure of arrays, so that a window costs no allocation once its buffers have grown: times are
/// strictly increasing, the first is the window's begin and the last its end. `width` is points x
/// dimension; u [m], v [m/s], a [m/s^2] and f [N] are (times, width), row-major, and each may be
/// empty. Only what is near another body travels: `points` lists the points that are meant. u is
/// the displacement from the reference configuration: positions would lose small motions to
/// round-off. f is the force that acts on this body through the port.
class Waveform {
 public:
  Waveform() = default;
  explicit Waveform(int values_per_time) : width(values_per_time) {}

  int width = 1;
  ForceSupport support = ForceSupport::nodal;
  std::vector<std::int32_t> points;  // of the port, ascending; empty: all of them
  std::vector<double> time;          // [s] (m)
  std::vector<double> u, v, a, f;    // (m, width) or empty

  std::size_t size() const { return time.size(); }
  bool empty() const { return time.empty(); }
  /// Forgets the values and keeps the memory.
  void clear();

  /// Values of one field at a time inside the window, linear between the stored times and exact at
  /// them; writes `width` numbers, as many as `out` must hold. Precondition: the waveform is not
  /// empty and the field is (times, width).
  void interpolate(const std::vector<double>& field, double at, std::span<double> out) const;
  /// The same of the values that are listed alone, as many as `out` must hold.
  void interpolate(const std::vector<double>& field, double at, std::span<const std::size_t> values,
                   std::span<double> out) const;

  /// Force that acts at a time: linear between stored times (nodal, linear) or that of the substep
  /// (step).
  void force_at(double at, std::span<double> out) const;

  /// Impulse [N s] of f over [from, to], clipped to the window: exact for the waveform's support,
  /// so the impulses of adjoining intervals add up to that of their union. Writes `width` numbers.
  void impulse(double from, double to, std::span<double> out) const;

 private:
  void linear_impulse(double from, double to, std::span<double> out) const;
};

}  // namespace abut
