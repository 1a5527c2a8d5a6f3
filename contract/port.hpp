#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "contract/waveform.hpp"

namespace abut {

/// The surface of a port, in the reference configuration. All arrays are flat and row-major.
struct PortGeometry {
  int dim = 1;         // 1, 2 or 3
  bool round = false;  // in 2D: of rings about the axis x = 0, each as a whole
  // so many points, the last ones, are inside the body: where a body that overlaps it has its own
  // surface. Their facets are the last ones too, and look as that surface's do from the other side.
  std::int32_t embedded = 0;
  std::vector<double> points = {};    // [m] (n, dim), reference configuration
  std::vector<double> normals = {};   // (n, dim), unit, out of the body
  std::vector<std::int32_t> facets = {};   // facet connectivity; empty in 1D
  std::vector<std::int32_t> offsets = {};  // of the facets; empty in 1D
  // So many facets, one after the other, show one facet of an element: 1, or of second order those
  // that straight_parts tells of. Empty: 1 each.
  std::vector<std::int32_t> parts = {};
  // [m] typical distance of mesh nodes behind the port; 0: rigid
  double spacing = 0.0;
  // [s] time in which the fastest wave crosses `spacing`; 0: rigid or unknown
  double transit = 0.0;

  int count() const { return dim > 0 ? static_cast<int>(points.size()) / dim : 0; }
};

struct Port {
  std::string name;
  PortGeometry geometry;
  bool tied = false;  // for tied interfaces only: contact would make its node unstable
};

/// Which points of a kernel answer a force on one of them: lists, by the point that is pressed.
struct KernelBand {
  int dim = 0;                        // components of a point
  std::vector<std::int32_t> offsets;  // (points pressed + 1) where each one's list begins
  std::vector<std::int32_t> reached;  // numbers among the kernel's points, ascending in a list

  bool empty() const { return offsets.empty(); }
  std::size_t points() const { return offsets.empty() ? 0 : offsets.size() - 1; }
  std::span<const std::int32_t> of(std::size_t point) const {
    return std::span(reached).subspan(index(offsets[point]),
                                      index(offsets[point + 1] - offsets[point]));
  }
};

/// Responses of a port to patterns of force on its points, from rest and with all other loads
/// absent: the building block of the interface Jacobian (docs/METHOD.md, port kernel). The kernel
/// of a one-point port has one pattern, a unit force along its outward normal.
struct PortKernel {
  double step = 0.0;  // [s] the substep it was computed for
  ForceSupport support = ForceSupport::nodal;
  int patterns = 1;
  int width = 1;  // points x dimension: values of a pattern and of a response
  // [m/N] (patterns, width) quasi-static part: follows the force of the same instant; empty: none
  std::vector<double> compliance;
  // [m/N] (n, patterns, width) at the ends of substeps 1..n, force in substep 1
  std::vector<double> displacement;
  // [m/N] (n, patterns, width) the same, force at the window's begin only (nodal support)
  std::vector<double> begin;
  // of the port, ascending, that patterns and responses are of; empty: all. Others do not give way.
  std::vector<std::int32_t> points;

  // Banded: not every point answers a force on another one. The arrays above are then (n, reached,
  // dim, dim): for each entry of the band how much the point that is reached moves, component by
  // component, by a unit of each component on the point that is pressed. Empty: all answer.
  KernelBand band;

  // Of bodies with loose motions (Description::loose): (motions, width) displacements by a unit of
  // each, and [N/m] (motions, motions) what it leaves over along all.
  std::vector<double> carried, left;

  std::size_t per_step() const {
    if (!band.empty()) return band.reached.size() * index(band.dim * band.dim);
    return index(patterns) * index(width);
  }
  int count() const {
    return displacement.empty() ? 0 : static_cast<int>(displacement.size() / per_step());
  }
};

}  // namespace abut
