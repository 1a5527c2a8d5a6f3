#pragma once

#include <array>

#include "base/archive.hpp"
#include "contract/port.hpp"
#include "contract/waveform.hpp"

namespace abut {

/// Tells pushes of contact from what restitution takes back of them. Rigid bodies that meet within
/// a passive step are pushed as their gap asks for, and pulled in the next one to what restitution
/// says of how they part; the impulse of both steps pushes [M.161].
class TakenBack {
 public:
  /// -1: the force of step i, of all points together, takes back a part of the push so far; else
  /// 1, as wherever one of both sides deforms.
  double sign(const Waveform& force, const PortGeometry& own, const PortGeometry& partner,
              std::size_t i);
  void state(Archive& archive);

 private:
  std::array<double, 3> pushed_{};  // [N s] since nothing pressed
};

}  // namespace abut
