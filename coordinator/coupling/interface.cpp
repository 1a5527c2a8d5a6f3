#include "coordinator/coupling/interface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

void Interface::state(Archive& archive) {
  archive.field("closed", closed);
  archive.field("pressed", pressed);
  archive.field("touching", touching);
  archive.field("opened_at", opened_at);
  archive.field("touched_at", touched_at);
  archive.field("touch_speed", touch_speed);
  archive.field("closing_speed", closing_speed);
  archive.field("force_scale", force_scale);
  archive.field("debt", debt);
  archive.field("rebound_impulse", rebound_impulse);
  archive.field("impulse", impulse);
}

Interface make_interface(std::string name, std::array<Side, 2> sides, const Bodies& bodies) {
  Interface interface;
  interface.name = std::move(name);
  interface.sides = sides;
  std::array<double, 2> place = {0.0, 0.0};
  double spacing = 0.0;
  for (std::size_t s : {0u, 1u}) {
    const Port& port = bodies.describe(sides[s].body).ports[index(sides[s].port)];
    interface.normal[s] = port.geometry.normals[0];
    place[s] = port.geometry.points[0];
    spacing = std::max(spacing, port.geometry.spacing);
  }
  const std::string where = "interfaces." + interface.name;
  if (interface.normal[0] + interface.normal[1] != 0.0) {
    throw InputError("its two ports look the same way and cannot touch", where,
                     "Join a right end with a left end.");
  }
  interface.reference_gap = interface.normal[0] * (place[1] - place[0]);
  const double rounding = std::max(
      place_rounding * std::max(std::abs(place[0]), std::abs(place[1])), place_tolerance * spacing);
  if (interface.reference_gap < -rounding) {
    throw InputError(
        fmt::format("its sides overlap by {:g} m at the start", -interface.reference_gap), where,
        "Move a body with initial.position until the gap is zero or more.");
  }
  interface.reference_gap = std::max(0.0, interface.reference_gap);
  return interface;
}

}  // namespace abut
