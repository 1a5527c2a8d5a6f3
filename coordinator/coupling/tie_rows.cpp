#include "coordinator/coupling/tie_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "contract/whole_facets.hpp"
#include "coordinator/coupling/twin_nodes.hpp"
#include "surface/mortar.hpp"
#include "surface/whole_rows.hpp"

namespace abut {

namespace {

/// Of the coarser facets: farther apart they do not belong together.
constexpr double row_reach = 1.0;

SparseRows one_point() { return {{0, 1}, {0}, {1.0}}; }

TieRows of_points(const PortGeometry& one, const PortGeometry& other) {
  TieRows rows;
  rows.of = {one_point(), one_point()};
  rows.area = {1.0};
  rows.apart = std::abs(one.points[0] - other.points[0]);
  rows.place = {one.points[0]};
  return rows;
}

/// One row per node and its twin: what the dual rows of flat faces are where nodes meet, and what
/// keeps folded faces of any shape whole.
void of_twins(const std::vector<std::int32_t>& twins, SparseRows& k, SparseRows& n) {
  k.offsets = n.offsets = {0};
  for (std::size_t node = 0; node < twins.size(); ++node) {
    k.columns.push_back(static_cast<std::int32_t>(node));
    n.columns.push_back(twins[node]);
    for (SparseRows* rows : {&k, &n}) {
      rows->values.push_back(1.0);
      rows->end_row();
    }
  }
}

/// Where gaps are largest.
void see_gaps(const SurfaceRows& found, const PosedSurface& k, TieRows& rows) {
  std::size_t most = 0;
  for (std::size_t r = 0; r < found.gaps.size(); ++r)
    if (std::abs(found.gaps[r]) > std::abs(found.gaps[most])) most = r;
  rows.apart = std::abs(found.gaps[most]);
  const Eigen::Vector3d at = k.point(found.nodes[most]);
  rows.place.assign(at.data(), at.data() + rows.dim);
}

std::vector<FacetPair> near_pairs(const PosedSurface& k, const PosedSurface& n, double far) {
  BoxTree of_k, of_n;
  build(of_k, k, far);
  build(of_n, n, far);
  std::vector<FacetPair> pairs;
  overlapping_pairs(of_k, of_n, pairs);
  return pairs;
}

/// Rows of K's side first.
TieRows of_rows(SurfaceRows&& found, const PosedSurface& k) {
  TieRows rows;
  rows.dim = k.dim;
  if (found.count() == 0) return rows;
  see_gaps(found, k, rows);
  rows.of = {std::move(found.k), std::move(found.n)};
  rows.area = std::move(found.weights);
  return rows;
}

TieRows of_surfaces(const PosedSurface& k, const PosedSurface& n, double far) {
  MortarOptions options;
  options.reach = far;
  MortarBuffers buffers;
  SurfaceRows found;
  mortar_rows(k, n, near_pairs(k, n, far), options, buffers, found);
  return of_rows(std::move(found), k);
}

/// A port's facets as its elements have them.
class Whole {
 public:
  explicit Whole(const PortGeometry& port) : port_(port), facets_(whole_facets(port)) {}
  WholeSurface surface() const {
    return {posed(port_), facets_.nodes, facets_.offsets, facets_.of};
  }

 private:
  const PortGeometry& port_;
  WholeFacets facets_;
};

/// Whether nodes that meet are of facets that are the same ones, those of second order too.
bool wholes_meet(const PortGeometry& one, const PortGeometry& other,
                 const std::vector<std::int32_t>& twins) {
  if (one.parts.empty() && other.parts.empty()) return true;
  const Whole k(one), n(other);
  const CornerFacets of_k(k.surface()), of_n(n.surface());
  return facets_meet(of_k.surface(posed(one)), of_n.surface(posed(other)), twins);
}

/// Facets of second order on either side.
TieRows of_whole(const PortGeometry& own, const PortGeometry& partner, double far) {
  const Whole k(own), n(partner);
  MortarOptions options;
  options.reach = far;
  SurfaceRows found;
  const WholeSurface on = k.surface(), with = n.surface();
  whole_rows(on, with, near_pairs(on.straight, with.straight, far), options, found);
  return of_rows(std::move(found), on.straight);
}

/// A port without what is inside its body, or that alone; nodes are those of the whole port.
PortGeometry part_of(const PortGeometry& port, bool inside) {
  PortGeometry part = port;
  part.facets.clear();
  part.offsets = {0};
  for (std::size_t f = 1; f < port.offsets.size(); ++f) {
    const auto begin = port.facets.begin() + port.offsets[f - 1];
    if ((*begin >= port.count() - port.embedded) != inside) continue;
    part.facets.insert(part.facets.end(), begin, port.facets.begin() + port.offsets[f]);
    part.offsets.push_back(static_cast<std::int32_t>(part.facets.size()));
  }
  return part;
}

/// Where the points without facets begin, which are the last ones.
std::int32_t first_lone(const PortGeometry& port) {
  return port.facets.empty() ? 0 : *std::ranges::max_element(port.facets) + 1;
}

/// Points of both bodies in the same places, one by one.
void add_lone_points(const PortGeometry& one, const PortGeometry& other, TieRows& rows) {
  const std::int32_t first[] = {first_lone(one), first_lone(other)};
  for (std::int32_t k = 0; k < one.count() - first[0]; ++k) {
    for (const std::size_t s : {0u, 1u}) {
      rows.of[s].columns.push_back(first[s] + k);
      rows.of[s].values.push_back(1.0);
      rows.of[s].end_row();
    }
    rows.area.push_back(0.0);  // no part of a surface
  }
}

TieRows compared(const PortGeometry& one, const PortGeometry& other, int side) {
  if (one.dim == 1) return of_points(one, other);
  const bool first = side == 0;  // has the rows
  const PortGeometry &own = first ? one : other, &partner = first ? other : one;
  const PosedSurface k = posed(own), n = posed(partner);
  TieRows rows;
  rows.dim = one.dim;
  const std::vector<std::int32_t> twins = twin_nodes(k, n);
  if (!twins.empty() && wholes_meet(own, partner, twins)) {
    of_twins(twins, rows.of[first ? 0 : 1], rows.of[first ? 1 : 0]);
    tributary_weights(k, rows.area);
    rows.place.assign(one.points.begin(), one.points.begin() + one.dim);
    return rows;
  }
  const double far = row_reach * std::max(one.spacing, other.spacing);
  const bool first_order = own.parts.empty() && partner.parts.empty();
  // What does not deform is met by every node: nothing moves between them.
  const bool straight = first_order || partner.transit == 0.0;
  rows = straight ? of_surfaces(k, n, far) : of_whole(own, partner, far);
  if (!first) std::swap(rows.of[0], rows.of[1]);
  return rows;
}

}  // namespace

TieRows make_tie_rows(const PortGeometry& one, const PortGeometry& other, int side) {
  TieRows rows = compared(one, other, side);
  rows.force = rows.of;
  return rows;
}

TieRows make_overlap_rows(const PortGeometry& one, const PortGeometry& other) {
  const double far = row_reach * std::max(one.spacing, other.spacing);
  const PortGeometry cut = part_of(one, false), in_other = part_of(other, true);
  TieRows rows = of_surfaces(posed(cut), posed(in_other), far);
  const PortGeometry its_cut = part_of(other, false), in_one = part_of(one, true);
  TieRows more = of_surfaces(posed(its_cut), posed(in_one), far);
  const bool paired = one.count() - first_lone(one) == other.count() - first_lone(other);
  if (rows.count() == 0 || more.count() == 0 || !paired) return {};
  append(more.of[1], rows.of[0]);
  append(more.of[0], rows.of[1]);
  rows.area.insert(rows.area.end(), more.area.begin(), more.area.end());
  add_lone_points(one, other, rows);
  rows.force = rows.of;
  if (more.apart > rows.apart) {
    rows.apart = more.apart;
    rows.place = more.place;
  }
  return rows;
}

}  // namespace abut
