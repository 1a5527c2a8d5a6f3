#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "contract/port.hpp"
#include "contract/waveform.hpp"
#include "coordinator/record/observer.hpp"

namespace abut {

/// A port at one time as a person plots it: mean motion and total force, by axis. Absent fields are
/// zero.
struct PortMeans {
  std::array<double, 3> u{};  // [m]
  std::array<double, 3> v{};  // [m/s]
  std::array<double, 3> f{};  // [N] on this body
};

/// Reads the waveforms of one port. The port must outlive the reader.
class PortReader {
 public:
  explicit PortReader(const Port& port) : port_(&port) {}

  /// At a time, which is clipped to the waveform's. Precondition: the waveform is not empty.
  PortMeans at(const Waveform& trace, double time);
  /// The same at the end of an interval, of which forces that are constant in steps are the mean:
  /// those of two steps may be far apart, and their sum alone is the impulse.
  PortMeans since(const Waveform& trace, double from, double to);
  /// Force along the inward normal at stored time i [N]: positive in compression.
  double compression(const Waveform& trace, std::size_t i) const;
  /// Mean along x of a field of the waveform at stored time i; 0 when the field is absent.
  double along_x(const Waveform& trace, const std::vector<double>& field, std::size_t i) const;
  const Port& port() const { return *port_; }

 private:
  std::array<double, 3> gathered(double scale) const;

  const Port* port_;
  std::vector<double> values_;  // (width)
};

/// Gap of an interface between single points in 1D [m], from the displacements of its two sides.
double gap_of(const InterfaceInfo& interface, const RunStart& start, double u0, double u1);

/// Ending of a name for one axis of a quantity: none in 1D, else _x, _y, _z.
const char* axis_ending(int dim, int axis);
/// First axis about which a body turns: z in two dimensions, x in three; 3 in one: none.
inline int first_rotation_axis(int dim) { return dim == 1 ? 3 : dim == 2 ? 2 : 0; }

}  // namespace abut
