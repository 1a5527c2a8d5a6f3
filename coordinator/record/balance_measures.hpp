#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "coordinator/exact/closed_form.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/recorded_bodies.hpp"

namespace abut {

/// Energy and momentum of the bodies at every record. What a body holds at first is taken from the
/// first record, since no body is asked before it has advanced.
class BalanceMeasures {
 public:
  /// `exact` may be null; `start` and `exact` must outlive this.
  BalanceMeasures(const RunStart& start, const ClosedForm* exact);

  void on_window(const WindowReport& report);
  void write(Measures& out) const;

  void state(Archive& archive);

 private:
  using Vector = std::array<double, 3>;
  struct Body {
    double first = 0.0;      // [J] energy, dissipated too, minus external work
    double reference = 0.0;  // [J] that the error is relative to
    double peak = 0.0;       // [J] largest kinetic plus stored plus dissipated energy at a record
    double error = 0.0, error_max = 0.0;  // [J]
    Vector momentum{};                    // [kg m/s]
    double momentum_max = 0.0;
    Vector angular{};  // [kg m^2/s] about the origin
    double angular_max = 0.0;
    bool untold = false;     // its angular momentum, at the last record
    int bar = -1;            // of the closed form; -1: not described by it, or a wall
    bool exchanged = false;  // energy, through an interface that was closed
  };

  void begin(const WindowReport& report);
  void follow_exchange(const WindowReport& report);
  void exchange(const int (&body)[2], const int (&port)[2]);
  double total_energy(const WindowReport& report, std::size_t record) const;  // [J]
  void add(const WindowReport& report, std::size_t record);
  void add_angular(const WindowReport& report, std::size_t record);
  void write_energy(const RecordedBody& recorded, const Body& body, Measures& out) const;
  void write_angular(Measures& out) const;

  const RunStart& start_;
  const ClosedForm* exact_;
  std::vector<RecordedBody> recorded_;
  std::vector<Body> bodies_;  // as recorded
  bool begun_ = false;
  bool immovable_ = false;
  bool round_ = false;  // bodies of revolution
  double total_first_ = 0.0;              // [J]
  double total_peak_ = 0.0;               // [J] as of a body
  double drift_ = 0.0, drift_max_ = 0.0;  // [J]
  Vector momentum_first_{};
  double momentum_change_ = 0.0;
  Vector angular_first_{};
  double angular_change_ = 0.0;
};

}  // namespace abut
