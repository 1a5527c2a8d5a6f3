#pragma once

#include <array>
#include <string>

namespace abut {

/// What the exact solution needs to know of one side of a head-on impact: a free uniform elastic
/// bar, or a rigid immovable wall (then only name and normal count).
struct BarData {
  std::string name;             // of the body, for messages
  bool wall = false;            // rigid and immovable
  double youngs_modulus = 0.0;  // [Pa]
  double density = 0.0;         // [kg/m^3]
  double area = 0.0;            // [m^2]
  double length = 0.0;          // [m]
  double velocity = 0.0;        // [m/s] initial and uniform, along +x
  double normal = 1.0;          // outward normal at the contact: +1 or -1 along x
  bool free = true;             // no fixed end
  double body_force = 0.0;      // [N/kg] or any measure of it: the solution wants zero
};

/// Exact solution of two free uniform bars that hit head-on, or of one bar on a rigid wall, by
/// d'Alembert's waves and their reflections, for the impacts in which contact is one interval of
/// constant force (docs/METHOD.md). Times are those of the run. At a jump the value is the one that
/// holds afterwards.
class BarImpact {
 public:
  /// `gap` [m] is open at time `begin` [s]. Throws InputError when this solution does not exist.
  BarImpact(const std::array<BarData, 2>& sides, double gap, double begin);

  double run_begin() const { return run_begin_; }
  double begin() const { return begin_; }            // [s] impact
  double end() const { return begin_ + duration_; }  // [s] release
  double duration() const { return duration_; }      // [s] shorter wave transit 2 L / c
  double force() const { return force_; }            // [N] during contact, compression positive
  double closing_speed() const { return closing_speed_; }  // [m/s] before the impact
  bool closed(double time) const { return time >= begin() && time < end(); }
  double force_at(double time) const { return closed(time) ? force_ : 0.0; }
  double gap(double time) const;  // [m] >= 0

  // By side (0 or 1). A wall is at rest and holds nothing.
  bool is_wall(int side) const { return bars_[side].wall; }
  double displacement(int side, double time) const;   // [m] of the contact point, since run_begin
  double velocity(int side, double time) const;       // [m/s] of the contact point
  double port_force(int side, double time) const;     // [N] on this body through the port, along +x
  double momentum(int side, double time) const;       // [kg m/s]
  double mean_velocity(int side, double time) const;  // [m/s] momentum / mass
  double kinetic(int side, double time) const;        // [J]
  double stored(int side, double time) const;         // [J]
  double total(int side, double time) const;          // [J]
  double velocity_jump(int side) const;  // [m/s] of the contact point at the impact, >= 0

 private:
  struct Bar {
    bool wall = false;
    double normal = 1.0;
    double velocity = 0.0;
    double density = 0.0, area = 0.0, length = 0.0;
    double speed = 0.0;      // [m/s] of waves
    double impedance = 0.0;  // [kg/s]
    double transit = 0.0;    // [s] to the far end and back

    double mass() const { return density * area * length; }
  };
  /// Lengths of bar [m] that the outgoing wave, the incoming wave and both of them cover.
  struct Cover {
    double outgoing = 0.0, incoming = 0.0, both = 0.0;
  };

  static Bar make_bar(const BarData& data);
  void require_single_interval(const std::array<BarData, 2>& sides) const;
  double impulse_until(double since) const;           // [N s] of the contact force
  double echoed(const Bar& bar, double since) const;  // [N s] impulse plus twice its echoes
  Cover cover(const Bar& bar, double since) const;

  std::array<Bar, 2> bars_;
  double run_begin_ = 0.0, begin_ = 0.0, duration_ = 0.0;
  double force_ = 0.0, closing_speed_ = 0.0;
};

/// A closed form that a scene names, and the interface that it describes.
struct ClosedForm {
  std::string interface;
  BarImpact impact;
  std::array<std::string, 2> bodies{};  // of the sides, as tables name them
};

}  // namespace abut
