#pragma once

#include <span>
#include <string>
#include <vector>

#include "contract/field.hpp"
#include "contract/port.hpp"
#include "subdomain_solver/contact/surface_contact.hpp"

namespace abut {

/// A port that is a surface, as pictures and measures see its contact.
struct TouchedSurface : PortSurface {
  std::string name;
  double thickness = 1.0;  // [m] across the plane
};

/// What is told of every such port: contact.pressure_max [Pa], contact.area [m^2] where it is
/// pressed, by the weights of its nodes; contact.stick_area [m^2] of these, where friction holds it
/// (of the side that finds contact; else 0); contact.spread [m], the root of the mean square
/// distance of the pressure from its centre.
std::vector<std::string> touch_measure_names(const std::vector<TouchedSurface>& surfaces);
/// Their values, of forces [N] and displacements [m] of the ports (port values). `contact`: of a
/// body that finds contact; else null.
void touch_measures(const std::vector<TouchedSurface>& surfaces, const SurfaceContact* contact,
                    std::span<const double> forces, std::span<const double> places,
                    std::vector<double>& out);

/// At the nodes of the mesh: contact_pressure [Pa], contact_status (0 nothing near, 1 near, 2
/// pressed, 3 pressed and held by friction, told of the side that finds contact), and of a body
/// that `finds` contact contact_gap [m] (0 where it finds nothing near).
std::vector<FieldInfo> touch_fields(bool finds);
std::vector<FieldValues> touch_field_values(const std::vector<TouchedSurface>& surfaces,
                                            const SurfaceContact* contact, std::size_t nodes,
                                            std::span<const double> forces,
                                            std::span<const double> places);

}  // namespace abut
