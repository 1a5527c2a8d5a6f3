// The rows of single points that hold corners and edges apart.

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "surface/closest_point.hpp"
#include "surface/meeting_corners.hpp"

namespace abut {
namespace {

// Of a facet's size: a foot may lie `beside` its facet or edge by as much; what is farther apart
// than `far` has no row yet.
constexpr double beside = 0.02, far_corner = 0.1;

/// Cosines: between facets of one plane, or edges across each other; between normals of one row,
/// as edges have that are straight but for what a first touch bends.
const double same_normal = std::cos(10.0 * std::acos(-1.0) / 180.0);
const double one_row = std::cos(0.01 * std::acos(-1.0) / 180.0);

/// Of a row: a node that has it alone.
constexpr double alone = 0.999;

void copy(const SparseRows& from, std::size_t row, SparseRows& to) {
  for (std::int32_t e = from.offsets[row]; e < from.offsets[row + 1]; ++e) {
    to.columns.push_back(from.columns[e]);
    to.values.push_back(from.values[e]);
  }
  to.end_row();
}

}  // namespace

double MeetingCorners::reach() const { return 2.0 * options_.way + far_corner * size_; }

Eigen::Vector3d MeetingCorners::place(const PosedSurface& surface, const Side& side) {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < index(side.count); ++i)
    x += side.shares[i] * surface.point(side.nodes[i]);
  return x;
}

double MeetingCorners::gap(const Row& row) const {
  return row.normal.dot(place(k_.now, row.k) - place(n_.now, row.n));
}

/// The edge's nodes before facets of the other wedge that lie along the plane.
void MeetingCorners::add_nodes(const Plane& best, const Wedge& of_nodes, const Wedge& of_facets) {
  const bool k_finds = best.kind == Kind::n_plane;
  const PosedSurface &one = k_finds ? k_.now : n_.now, &two = k_finds ? n_.now : k_.now;
  const Eigen::Vector3d out = k_finds ? best.normal : Eigen::Vector3d(-best.normal);
  const Eigen::Vector3d normal = (normal_now(best) + shared_).normalized();
  for (const std::int32_t node : of_nodes.ends) {
    const Eigen::Vector3d x = one.point(node);
    double least = options_.way + beside * size_;
    Row row{best.kind, {1, {node}, {1.0}}, {}, normal, best.apart};
    for (const std::int32_t f : of_facets.planes) {
      const Corners facet = corners(two, f);
      const Eigen::Vector3d n = mean_normal(facet);
      if (n.dot(out) < same_normal) continue;
      const ClosestPoint foot = closest_point(facet, x);
      const Eigen::Vector3d to = x - foot.point;
      const double off = foot.feature == FacetFeature::inside ? 0.0 : (to - to.dot(n) * n).norm();
      if (!(off < least)) continue;
      least = off;
      row.n.count = facet.count;
      std::ranges::copy(two.nodes(f), row.n.nodes.begin());
      std::copy_n(foot.shape.data(), facet.count, row.n.shares.begin());
    }
    if (row.n.count == 0) continue;
    if (!k_finds) std::swap(row.k, row.n);
    add(row);
  }
}

/// The edges where they cross, seen along the plane's normal. True: they do, near enough.
bool MeetingCorners::add_crossing(const Plane& best, const Wedge& a, const Wedge& b) {
  const Eigen::Vector3d from = k_.now.point(a.ends[0]), to = n_.now.point(b.ends[0]), d = to - from;
  const Eigen::Vector3d u = k_.now.point(a.ends[1]) - from, v = n_.now.point(b.ends[1]) - to;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const Eigen::Vector3d across = u.cross(v);
  const double square = across.squaredNorm();
  // Other edges of corners have rows of their own.
  if (!(std::abs(across.dot(best.normal)) >= same_normal * std::sqrt(square)) || !(square > 0.0))
    return false;
  const double on_k = (d.dot(u) * vv - d.dot(v) * uv) / square;
  const double on_n = (d.dot(u) * uv - d.dot(v) * uu) / square;
  const auto is_on = [this](double part, double length) {
    const double beyond = beside + options_.way / length;
    return part >= -beyond && part <= 1.0 + beyond;
  };
  if (!is_on(on_k, std::sqrt(uu)) || !is_on(on_n, std::sqrt(vv))) return false;
  const double s = std::clamp(on_k, 0.0, 1.0), t = std::clamp(on_n, 0.0, 1.0);
  return add({best.kind,
              {2, {a.ends[0], a.ends[1]}, {1.0 - s, s}},
              {2, {b.ends[0], b.ends[1]}, {1.0 - t, t}},
              (normal_now(best) + shared_).normalized(),
              best.apart});
}

/// A node has one row of a kind. Edges that cross at a node are several there, with one row but in
/// a notch, where an edge rests on both sides of it.
bool MeetingCorners::is_again(const Row& known, const Row& row) const {
  if (known.kind != row.kind) return false;
  if (row.kind == Kind::n_plane) return known.k.nodes[0] == row.k.nodes[0];
  if (row.kind == Kind::k_plane) return known.n.nodes[0] == row.n.nodes[0];
  const Eigen::Vector3d x = place(k_.now, row.k), y = place(n_.now, row.n);
  const double near = options_.way + beside * size_;
  if ((place(k_.now, known.k) - x).norm() > near || (place(n_.now, known.n) - y).norm() > near)
    return false;
  if (known.normal.dot(row.normal) >= one_row) return true;
  for (std::size_t i = 0; i < 2; ++i)
    if (known.normal.dot(k_.now.point(row.k.nodes[i]) - x) < -beside * near ||
        known.normal.dot(n_.now.point(row.n.nodes[i]) - y) > beside * near)
      return false;
  return true;
}

/// Of rows of one node the one stays whose plane separates best. False: it is far.
bool MeetingCorners::add(const Row& row) {
  if (!(gap(row) <= reach())) return false;
  for (Row& known : rows_) {
    if (!is_again(known, row)) continue;
    if (row.apart > known.apart) known = row;
    return true;
  }
  rows_.push_back(row);
  return true;
}

/// A row of averages that is a node's alone.
bool MeetingCorners::has_row(const SparseRows& of, std::size_t r, Kind kind) const {
  for (std::int32_t e = of.offsets[r]; e < of.offsets[r + 1]; ++e)
    for (const Row& row : rows_)
      if (of.values[e] >= alone && row.kind == kind &&
          (kind == Kind::n_plane ? row.k : row.n).nodes[0] == of.columns[e])
        return true;
  return false;
}

void MeetingCorners::append(Side side, SparseRows& to) {
  const std::size_t begin = to.columns.size();
  for (std::size_t i = 0; i < index(side.count); ++i) {
    std::size_t at = to.columns.size();
    while (at > begin && to.columns[at - 1] > side.nodes[i]) --at;
    to.columns.insert(to.columns.begin() + static_cast<std::ptrdiff_t>(at), side.nodes[i]);
    to.values.insert(to.values.begin() + static_cast<std::ptrdiff_t>(at), side.shares[i]);
  }
  to.end_row();
}

void MeetingCorners::join(SurfaceRows& rows) {
  const std::size_t dim = index(rows.dim);
  others_.clear();
  others_.dim = rows.dim;
  for (std::size_t r = 0; r < index(rows.count()); ++r) {
    if (has_row(rows.k, r, Kind::n_plane) || has_row(rows.n, r, Kind::k_plane)) continue;
    others_.nodes.push_back(rows.nodes[r]);
    others_.weights.push_back(rows.weights[r]);
    others_.gaps.push_back(rows.gaps[r]);
    const auto normal = rows.normals.begin() + static_cast<std::ptrdiff_t>(r * dim);
    others_.normals.insert(others_.normals.end(), normal, normal + rows.dim);
    copy(rows.k, r, others_.k);
    copy(rows.n, r, others_.n);
  }
  for (const Row& row : rows_) {
    const auto most = std::max_element(row.k.shares.begin(), row.k.shares.begin() + row.k.count);
    others_.nodes.push_back(row.k.nodes[most - row.k.shares.begin()]);
    others_.weights.push_back(0.0);
    others_.gaps.push_back(gap(row));
    const double* normal = row.normal.data();
    others_.normals.insert(others_.normals.end(), normal, normal + rows.dim);
    append(row.k, others_.k);
    append(row.n, others_.n);
  }
  std::swap(rows, others_);
}

}  // namespace abut
