#pragma once

#include <string>
#include <vector>

#include "contract/subdomain.hpp"

namespace abut {

/// A side of an interface, for people.
struct NamedSurface {
  std::string name;  // body.port
  const PortGeometry& geometry;
  // of its body's other ports: what is behind the outer surface of a ring may be in its hole
  std::vector<const PortGeometry*> beside = {};
  const PortGeometry* outside = nullptr;  // closed, that it is a part of; null: not known
  // Its body does not move and shows no cells: it may be a surface alone, and nobody has turned it.
  bool unturned = false;
};

NamedSurface named_surface(const std::string& name, const Description& body, int port);

/// [m] how deep the sides are in each other in the reference, in places
/// (surface/overlap_places.hpp) beyond what facets that stand for round bodies leave them, or over
/// the width of a facet of those that have the contact's rows; 0: by no more than a millionth of
/// one.
double overlap_of(const NamedSurface& finder, const NamedSurface& other);

/// [m] by which facets that stand for round bodies leave them, of both together.
double rise_of(const NamedSurface& one, const NamedSurface& other);
/// [m] The deepest overlap that may be an interference fit: half of a facet.
double deepest_fit(const NamedSurface& one, const NamedSurface& other);

/// Refuses bodies that overlap. Throws InputError with places and depths; `where` is the
/// interface's key. `meant`: interference, up to the deepest of a fit.
void check_apart(const NamedSurface& one, const NamedSurface& other, bool meant,
                 const std::string& where);

/// Refuses what no rows of facets can start from: bodies that are in each other, a facet without
/// area or folded, one that looks the other way than its neighbours, a surface that crosses itself,
/// and, where `averages` are looked at, rows that overlap by more than a millionth of a facet: of
/// nodes of the finder, which finds their contact, but for edges. `meant` as above.
void check_surfaces(const NamedSurface& finder, const NamedSurface& other, bool averages,
                    bool meant, const std::string& where);

/// The same for rows of the finder's single nodes, none of which may lie behind the other side, and
/// which do not see edges of that side.
void check_points(const NamedSurface& finder, const NamedSurface& other, bool meant,
                  const std::string& where);

}  // namespace abut
