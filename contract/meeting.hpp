#pragma once

#include <vector>

#include "contract/boundary_data.hpp"
#include "contract/port.hpp"

namespace abut {

/// In place of a partner: the port's own surface.
constexpr int own_surface = -1;

/// Who a port may meet, and how that surface gives way. What is null stays as it was: a partner
/// comes with its surface, and again whenever its kernel changes. The pointers are valid during the
/// call.
struct Meeting {
  int port = 0;
  // Partners of a port count from 0, in the order in which their surfaces come. `own_surface`: how
  // bodies that are tied to this one, at other ports, move the port's own surface [M.121].
  int partner = 0;
  const PortGeometry* surface = nullptr;  // in the reference configuration
  ContactLaw law = {};                    // counts where the surface comes
  // For unit forces on the surface's points, one pattern per component.
  const PortKernel* kernel = nullptr;
};

/// Which responses are wanted of a body at rest, all other loads absent.
struct Probing {
  int port = 0;                  // that is pressed
  std::vector<double> patterns;  // [N] (patterns, points x dim)
  double step = 0.0;             // [s]
  int count = 0;                 // of substeps
  // Ports whose displacements are told, one after the other: what a force on one port does at the
  // others. Empty: those of `port`, with all that a kernel has. Bodies that tell of their own ports
  // alone are asked for nothing else, or for `port`.
  std::vector<int> seen = {};
};

}  // namespace abut
