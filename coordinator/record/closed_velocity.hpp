#pragma once

#include <array>
#include <deque>
#include <vector>

#include "base/archive.hpp"
#include "contract/waveform.hpp"
#include "coordinator/record/contact_errors.hpp"
#include "coordinator/record/contact_times.hpp"
#include "coordinator/record/port_reader.hpp"
#include "coordinator/record/square_integral.hpp"

namespace abut {

/// Velocity of the contact point from the events that close an interface to those that open it,
/// however windows lie. Events of a window are told before it or after it, so a window is read when
/// the next one comes.
class ClosedVelocity {
 public:
  /// `together` [s]: see ContactTimes.
  explicit ClosedVelocity(double together) : times_(together) {}

  void join(double time) { times_.join(time); }  // see ContactTimes
  void change(bool closes, double time);
  /// Reads the window before, whose kinematic side is this one's where it was not known; `errors`
  /// may be null. Then takes the velocities of both sides along x, and which of them is kinematic
  /// when `known`.
  void on_window(const std::array<PortReader, 2>& readers,
                 const std::array<const Waveform*, 2>& traces, int kinematic, bool known,
                 ContactErrors* errors);
  /// Reads the last window.
  void finish(ContactErrors* errors) { read(pending_.kinematic, errors); }

  /// [m/s] root mean square; NaN when nothing is known.
  double rms() const;

  void state(Archive& archive);

 private:
  struct Change {
    bool closes = false;
    double time = 0.0;  // [s]
  };
  struct Window {
    struct Side {
      std::vector<double> time, velocity;  // [s] [m/s]
    };
    std::array<Side, 2> sides;
    int kinematic = 0;
    bool known = false;
  };

  void read(int kinematic, ContactErrors* errors);
  void add(int side, std::size_t i, ContactErrors* errors);
  void turn();

  ContactTimes times_;  // as far as windows have been read
  std::deque<Change> changes_;
  Window pending_;
  SquareIntegral closed_;
  SquareIntegral pause_;  // since the last release: part of the contact if it goes on
};

}  // namespace abut
