// What rubs: slips of rows, the forces of rows with friction, and what a substep leaves behind.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/contact/surface_contact.hpp"

namespace abut {

void SurfaceContact::forget_shears(const Meeting& m) {
  const std::size_t dim = index(surfaces_[m.own].surface.geometry->dim);
  const std::size_t points = surfaces_[m.own].surface.nodes.size();
  std::ranges::fill(std::span(shears_).subspan(m.slid * dim, points * dim), 0.0);
  std::ranges::fill(std::span(slid_).subspan(m.slid, points), 0.0);
}

/// What pressed along the surface at a point in the substep before acts on through one row of the
/// point: where several are of one point (edges, rows of the partner's nodes), in the shares in
/// which these press now, and where none does on the nearest one.
void SurfaceContact::share_shears(const Meeting& m) {
  const auto& nodes = m.obstacle->rows().nodes;
  const auto normal = [&](std::size_t r) { return rows_[index(m.first_row) + r].first; };
  of_points_.assign(surfaces_[m.own].surface.nodes.size(), {});
  for (std::size_t r = 0; r < index(m.rows); ++r) {
    OfPoint& point = of_points_[index(nodes[r])];
    if (point.rows++ == 0 || opened_(normal(r)) < opened_(normal(point.nearest))) point.nearest = r;
    point.pressed += row_force_(normal(r));
  }
  shares_.assign(index(m.rows), 1.0);
  for (std::size_t r = 0; r < index(m.rows); ++r) {
    const OfPoint& point = of_points_[index(nodes[r])];
    if (point.rows == 1) continue;
    shares_[r] = point.pressed > 0.0 ? row_force_(normal(r)) / point.pressed
                                     : (r == point.nearest ? 1.0 : 0.0);
  }
}

SeenGaps SurfaceContact::seen_gaps() const {
  if (restored_) return kept_gaps_;
  SeenGaps seen;
  for (const Meeting& m : meetings_) {
    if (!m.obstacle->acts()) continue;
    const SurfaceRows& rows = m.obstacle->rows();
    const double left = left_of(m, time_);
    for (int r = 0; r < rows.count(); ++r) {
      const std::int32_t first = rows.k.offsets[r], last = rows.k.offsets[index(r) + 1];
      const auto begin = rows.k.values.begin();
      const auto most = std::max_element(begin + first, begin + last);
      const bool sticks =
          r < m.rows && row_state(rows_[m.first_row + r], row_force_) == RowState::sticks;
      seen.add(m.obstacle->port(), index(rows.k.columns[most - begin]), rows.gaps[r] + left,
               sticks);
    }
  }
  return seen;
}

/// What friction took in the substep: by the mean of the forces at its ends, as the schemes work
/// with them. Which points slid, and where the partner was.
void SurfaceContact::settle_friction(std::size_t meeting) {
  Meeting& m = meetings_[meeting];
  if (!many_) {
    opened_ = gaps_;
    // where nothing presses the compliance is not even known
    if (!row_force_.isZero(0.0)) opened_.noalias() += compliance_ * row_force_;
  }
  const std::size_t dim = index(surfaces_[m.own].surface.geometry->dim);
  const std::size_t points = surfaces_[m.own].surface.nodes.size();
  const std::span<double> slid = std::span(slid_).subspan(m.slid, points);
  const std::span<double> shears = std::span(shears_).subspan(m.slid * dim, points * dim);
  std::ranges::fill(slid, 0.0);
  shears_before_.assign(shears.begin(), shears.end());
  std::ranges::fill(shears, 0.0);
  share_shears(m);
  const std::span<const double> along = directions(m);
  for (int r = 0; r < m.rows; ++r) {
    const FrictionRow& row = rows_[m.first_row + r];
    const std::size_t point = index(m.obstacle->rows().nodes[r]);
    const bool slips = row_state(row, row_force_) == RowState::slips;
    slid[point] = std::max(slid[point], m.law.friction.remember(slips));
    for (int p = 1; p < row.parts; ++p) {
      const double* tangent = along.data() + index(row.first - m.first + p) * dim;
      const double now = row_force_(row.first + p);
      double before = 0.0;
      for (std::size_t i = 0; i < dim; ++i) {
        before += tangent[i] * shears_before_[point * dim + i];
        shears[point * dim + i] += tangent[i] * now;
      }
      before *= shares_[index(r)];
      dissipated_[meeting] -= 0.5 * (before + now) * opened_(row.first + p);
    }
  }
  m.obstacle->end_slip(reacted(m), anchor(m));
  anchored_[meeting] = 1.0;
  if (m.law.friction.jumps()) settle_slid(m);
}

void SurfaceContact::begin_slid(Meeting& m, const BoundaryData& boundary, const Substeps& grid) {
  m.slid_now.clear();
  m.told_slid.clear();
  grid_ = grid;
  const std::size_t partner = m.obstacle->partner();
  if (partner >= boundary.obstacles.size()) return;
  m.told_slid = boundary.obstacles[partner].slid;
  const std::size_t points = surfaces_[m.own].surface.nodes.size();
  if (!m.told_slid.empty() && index(m.told_slid.back()) >= points * index(grid.count))
    throw RunError(fmt::format("is told that entry {} slid, of {} points and {} substeps",
                               m.told_slid.back(), points, grid.count),
                   fmt::format("body '{}'", body_), "Give entries of this window alone.");
}

/// Whether a point slides may depend on what a sweep leaves open, and its coefficient in the next
/// substep depends on that. So points that slid in earlier sweeps count as sliding, but not at the
/// window's end: what is handed on is what happened [M.126].
void SurfaceContact::settle_slid(Meeting& m) {
  if (substep_ < 1 || substep_ >= grid_.count) return;
  const std::size_t points = surfaces_[m.own].surface.nodes.size();
  const std::span<double> slid = std::span(slid_).subspan(m.slid, points);
  const auto first = static_cast<std::int32_t>(index(substep_ - 1) * points);
  const auto last = first + static_cast<std::int32_t>(points);
  for (auto told = std::ranges::lower_bound(m.told_slid, first);
       told != m.told_slid.end() && *told < last; ++told)
    slid[index(*told - first)] = 1.0;
  for (std::size_t p = 0; p < points; ++p)
    if (slid[p] != 0.0) m.slid_now.push_back(first + static_cast<std::int32_t>(p));
}

void SurfaceContact::finish(std::size_t port, std::size_t partner, Reaction& reply) const {
  for (std::size_t k = 0; k < meetings_.size() && k < dissipated_.size(); ++k) {
    const SurfaceObstacle& obstacle = *meetings_[k].obstacle;
    if (obstacle.port() != port || obstacle.partner() != partner) continue;
    reply.dissipated = dissipated_[k];
    reply.slid = meetings_[k].slid_now;
  }
}

double SurfaceContact::dissipated() const {
  return std::accumulate(dissipated_.begin(), dissipated_.end(), 0.0);
}

/// Slips of a meeting's rows from the substep's begin to the free pose, in this pose's rows.
void SurfaceContact::find_slips(const Meeting& m) {
  const Own& own = surfaces_[m.own];
  const SurfaceRows& rows = m.obstacle->rows();
  const NearSurface& near = m.obstacle->near();
  const std::vector<double>& partner = m.obstacle->free();
  const std::vector<double>& begin = m.obstacle->slip_begin();
  const std::size_t dim = index(rows.dim);
  const std::span<const double> along = directions(m);
  for (std::size_t r = 0; r < index(m.rows); ++r) {
    std::array<double, 3> slip{};
    for (std::int32_t e = rows.k.offsets[r]; e < rows.k.offsets[r + 1]; ++e) {
      const std::size_t v = index(rows.k.columns[e]) * dim;
      for (std::size_t i = 0; i < dim; ++i)
        slip[i] += rows.k.values[e] * (own.pose[v + i] - own.begin[v + i]);
    }
    for (std::int32_t e = rows.n.offsets[r]; e < rows.n.offsets[r + 1]; ++e) {
      const std::size_t v = index(rows.n.columns[e]) * dim;
      for (std::size_t i = 0; i < dim; ++i) {
        const double moved = partner[v + i] - near.points[v + i] - begin[near.values()[v + i]];
        slip[i] -= rows.n.values[e] * moved;
      }
    }
    for (std::size_t p = 1; p < index(m.parts); ++p) {
      const double* tangent = along.data() + (r * index(m.parts) + p) * dim;
      double sum = 0.0;
      for (std::size_t i = 0; i < dim; ++i) sum += tangent[i] * slip[i];
      gaps_(m.first + static_cast<Eigen::Index>(r * index(m.parts) + p)) = sum;
    }
  }
}

/// What pressed on the rows' nodes last: in the state, or in the look before.
void SurfaceContact::guess_forces() {
  row_force_.setZero(gaps_.size());
  for (const Meeting& m : meetings_) {
    const std::size_t dim = index(surfaces_[m.own].surface.geometry->dim);
    const std::span<const double> along = directions(m);
    for (std::size_t c = 0; c * dim < along.size(); ++c) {
      const std::size_t row = c / index(m.parts);
      const std::size_t point = index(m.obstacle->rows().nodes[row]);
      double& force = row_force_(m.first + static_cast<Eigen::Index>(c));
      for (std::size_t i = 0; i < dim; ++i)
        force += along[c * dim + i] * pressed_[m.pressed + point * dim + i];
      if (c % index(m.parts) == 0) force = std::max(0.0, force);
    }
  }
}

bool SurfaceContact::find_forces() {
  if (!rubs_) return unilateral_forces(compliance_, gaps_, row_force_, buffers_);
  if (row_force_.size() != gaps_.size()) guess_forces();
  return friction_forces(compliance_, gaps_, rows_, row_force_, friction_buffers_);
}

/// Where the forces that were found last are farthest from what contact asks for, and how far.
void SurfaceContact::tell_missing() {
  constexpr double no_number = 1.0e3;  // of the largest: forces that grew without end miss by any
  if (!gaps_.allFinite() || !compliance_.allFinite()) {
    missing_ =
        "it strains so far in a step that its surface is nowhere any more; take a smaller step";
    return;
  }
  double most = -1.0;
  for (const Meeting& m : meetings_) {
    const SurfaceRows& rows = m.obstacle->rows();
    const std::vector<double>& pose = surfaces_[m.own].pose;
    for (int r = 0; r < m.rows; ++r) {
      const std::span row(&rows_[m.first_row + r], 1);
      const double miss = friction_residual(compliance_, gaps_, row, row_force_);
      if (std::isfinite(miss) && miss <= most) continue;
      most = miss;
      const std::size_t dim = index(rows.dim), at = index(rows.nodes[r]) * dim;
      missing_ = fmt::format(
          "no contact forces were found that fit all of {} rows against {} partners: at ({:.4g}) "
          "they {}; take a smaller step, or materials that are less stiff",
          rows_.size(), meetings_.size(), fmt::join(std::span(pose).subspan(at, dim), ", "),
          miss < no_number ? fmt::format("miss by {:.2g} of the largest", miss)
                           : "grow without end");
    }
  }
}

}  // namespace abut
