#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// A surface alone, of segments in the plane and of triangles in space. Points of no facet are
/// allowed.
struct SurfaceFacets {
  int dim = 3;                                      // of space
  std::vector<double> points;                       // [m] (nodes, dim)
  std::vector<std::array<std::int32_t, 3>> facets;  // in the plane the third is -1
  std::vector<std::string> names;                   // (facets) of each in its file, for messages
  std::map<std::string, std::vector<std::int32_t>, std::less<>> groups;  // of facets

  /// A facet of an element's, of first or second order, in straight parts.
  void add(std::span<const std::int32_t> nodes, const std::string& name,
           std::span<const std::string> in_groups);
};

/// The shape of a body of which nothing but the surface counts: behind each facet a thin cell with
/// a node of its own. Groups are its sides, and `boundary` is all of it. Facets that hang together
/// look to one side: where they enclose something outwards, and where they do not as their first
/// one does. Throws InputError with the facet where that cannot be: an edge of more than two, a
/// surface with one side (Moebius); `where` is the file.
Mesh surface_shape(SurfaceFacets surface, const std::string& where);

/// Whether a mesh is such a shape.
bool is_surface_shape(const Mesh& mesh);

}  // namespace abut
