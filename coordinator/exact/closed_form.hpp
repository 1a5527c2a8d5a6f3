#pragma once

#include <array>
#include <string>
#include <vector>

#include "coordinator/exact/bar_row.hpp"

namespace abut {

/// The exact solution that a scene names, and what its parts are called in the run.
struct ClosedForm {
  std::string name;                     // as scenes name it
  BarRow row;                           // of all bodies (bars), or of two (bar_impact)
  std::vector<std::string> interfaces;  // of the row, in its order
  std::vector<std::string> bodies;      // the row's bars, as tables name them

  /// Index into the row's contacts; -1: not described.
  int interface_index(const std::string& interface) const;
  /// Index into the row's bars; -1: not described.
  int bar_index(const std::string& body) const;
  double contact_time() const;  // [s] during which some interface is pressed
};

/// Two free bars that hit head-on, or one on a rigid wall, for the impacts in which contact is one
/// interval of constant force: at least until its end, also where the run ends before. Throws
/// InputError when the bodies or the impact are of another kind.
BarRow bar_impact(const std::array<RowBar, 2>& bodies, const std::array<BarEnd, 2>& ends,
                  double begin, double end);

}  // namespace abut
