#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "coordinator/exact/step_function.hpp"

namespace abut {

/// What the exact solution needs to know of one body of a row: a uniform elastic bar in uniform
/// motion, or a rigid immovable wall (then only name and position count).
struct RowBar {
  std::string name;                            // of the body, for messages
  bool wall = false;                           // rigid and immovable
  double youngs_modulus = 0.0;                 // [Pa]
  double density = 0.0;                        // [kg/m^3]
  double area = 0.0;                           // [m^2]
  double length = 0.0;                         // [m]
  double position = 0.0;                       // [m] of the left end, or of the wall's face
  double velocity = 0.0;                       // [m/s] initial and uniform, along +x
  std::array<bool, 2> fixed = {false, false};  // left, right end clamped
  double body_force = 0.0;                     // [m/s^2]: the solution wants zero
};

/// One end of a bar of a row: where waves leave it, or meet a partner.
struct BarEnd {
  int bar = 0;   // index into the row
  int side = 0;  // 0 left, 1 right

  double normal() const { return side == 0 ? -1.0 : 1.0; }  // outward, along x
};

/// What one interface of a row goes through, from the row's begin to its end. Touching without
/// force is not contact.
struct RowContact {
  /// Contact under a constant force and with a constant velocity of both ends.
  struct Stretch {
    double begin = 0.0, end = 0.0;  // [s]
    double force = 0.0;             // [N] > 0: compression
    double velocity = 0.0;          // [m/s] of the contact point, along +x
  };

  std::array<BarEnd, 2> ends;
  double initial_gap = 0.0;        // [m]
  std::vector<Stretch> stretches;  // ascending; those of one contact follow without a break
  bool pressed_at_end = false;     // the last stretch is cut by the row's end

  bool ever() const { return !stretches.empty(); }
  int count() const;                                        // contacts
  double begin() const { return stretches.front().begin; }  // [s] of the first contact
  double end() const { return stretches.back().end; }       // [s] of the last contact
  double duration() const { return end() - begin(); }       // [s] first begin to last end
  double force_peak() const;                                // [N]
  double impulse() const;                                   // [N s]
  double force_mean() const;                                // [N] while pressed
  double force_at(double time) const;                       // [N]
  bool closed(double time) const { return force_at(time) > 0.0; }
};

/// Exact solution of linear elastic uniform bars in a row that collide, part and collide again, by
/// d'Alembert's waves and their reflections (docs/METHOD.md, [M.17], [M.18]). Every wave is
/// piecewise constant, so the solution goes from event to event: an arrival of a jump at an end, or
/// ends that meet. Exact to round-off; times are those of the run. At a jump the value is the one
/// that holds afterwards.
class BarRow {
 public:
  /// `interfaces` join a right end with a left end, each end at most once. Throws InputError when
  /// the solution does not exist, or does not fit into `max_events` events until `end` [s].
  BarRow(std::vector<RowBar> bars, const std::vector<std::array<BarEnd, 2>>& interfaces,
         double begin, double end);

  static constexpr int max_events = 200'000;

  double begin() const { return begin_; }
  double end() const { return end_; }
  int bars() const { return static_cast<int>(bars_.size()); }
  const RowBar& bar(int b) const { return bars_[b].data; }
  const std::vector<RowContact>& contacts() const { return contacts_; }  // as `interfaces`
  double velocity_spread() const;  // [m/s] largest difference of the bodies' velocities at begin
  double gap(int interface, double time) const;  // [m] >= 0

  // By bar. A wall is at rest and holds nothing.
  double mass(int bar) const;       // [kg]
  double impedance(int bar) const;  // [kg/s] Z = rho c A
  struct State {
    double momentum = 0.0;               // [kg m/s]
    double kinetic = 0.0, stored = 0.0;  // [J]
    double total() const { return kinetic + stored; }
  };
  State state(int bar, double time) const;           // all at once: it walks the waves in the bar
  double mean_velocity(int bar, double time) const;  // [m/s] momentum / mass
  double momentum(int bar, double time) const { return state(bar, time).momentum; }  // [kg m/s]
  double kinetic(int bar, double time) const { return state(bar, time).kinetic; }    // [J]
  double stored(int bar, double time) const { return state(bar, time).stored; }      // [J]
  double total(int bar, double time) const { return state(bar, time).total(); }      // [J]
  double total_peak(int bar) const;  // [J] largest from begin to end

  // By end.
  double displacement(const BarEnd& end, double time) const;  // [m] since the begin
  double velocity(const BarEnd& end, double time) const;      // [m/s]
  double force(const BarEnd& end, double time) const;         // [N] through an interface, along +x
  double mobility(const BarEnd& end) const;                   // [s/kg] 1 / Z, 0 of a wall

 private:
  struct Bar {
    RowBar data;
    double speed = 0.0;                  // [m/s] of waves
    double impedance = 0.0;              // [kg/s]
    double transit = 0.0;                // [s] from end to end
    std::vector<StepFunction> outgoing;  // [m/s] (2) the invariant that leaves each end [M.17]
    std::vector<StepFunction> velocity;  // [m/s] (2) of each end
  };
  /// Part of a bar with constant invariants.
  struct Piece {
    double length = 0.0;                     // [m]
    double rightward = 0.0, leftward = 0.0;  // [m/s]
  };
  class Events;  // builds the histories

  static Bar make_bar(RowBar data, double begin);
  void add_interface(const std::array<BarEnd, 2>& ends);
  std::vector<Piece> pieces(const Bar& bar, double time) const;
  Bar& at(int bar) { return bars_[bar]; }
  const Bar& at(int bar) const { return bars_[bar]; }

  double begin_ = 0.0, end_ = 0.0;  // [s]
  std::vector<Bar> bars_;
  std::vector<RowContact> contacts_;
};

}  // namespace abut
