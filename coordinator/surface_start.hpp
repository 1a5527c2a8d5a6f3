#pragma once

#include <string>

#include "contract/port.hpp"

namespace abut {

/// A side of an interface, for people.
struct NamedSurface {
  std::string name;  // body.port
  const PortGeometry& geometry;
};

/// Refuses what no contact can start from: a facet without area or folded, one that
/// looks the other way than its neighbours, a surface that crosses itself, and surfaces that
/// overlap in the reference by more than a millionth of a facet, in nodes or over the facets of the
/// side whose nodes have the rows: the finder's, which finds their contact, but for edges. Throws
/// InputError with the facet, or the place and how much; `where` is the interface's key.
void check_surfaces(const NamedSurface& finder, const NamedSurface& other,
                    const std::string& where);

/// The same for rows of the finder's single nodes, none of which may lie behind the other side, and
/// which do not see edges of that side.
void check_points(const NamedSurface& finder, const NamedSurface& other, const std::string& where);

}  // namespace abut
