#include "subdomain_solver/contact/surface_contact.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Looks at the geometry of the end of a substep: in a call, where the body is linear and there is
/// one, and in all. Rows that went on changing would keep the body from its balance.
constexpr int looks_of_a_call = 3, most_looks = 6;

/// Of the largest force: rows that change forces by less are settled.
constexpr double settled = 1.0e-12;

}  // namespace

SurfaceContact::SurfaceContact(std::vector<Surface> surfaces, const std::string& body)
    : body_(body) {
  for (Surface& surface : surfaces) {
    const int dim = surface.geometry->dim;
    for (const std::int32_t node : surface.nodes)
      for (int i = 0; i < dim; ++i) dofs_.push_back(node * dim + i);
    surfaces_.push_back({std::move(surface), {}, {}, {}, 0.0});
  }
  std::ranges::sort(dofs_);
  dofs_.erase(std::unique(dofs_.begin(), dofs_.end()), dofs_.end());
  for (Own& own : surfaces_) {
    const int dim = own.surface.geometry->dim;
    for (const std::int32_t node : own.surface.nodes) {
      const auto at = std::ranges::lower_bound(dofs_, node * dim) - dofs_.begin();
      for (int i = 0; i < dim; ++i) own.at.push_back(static_cast<int>(at) + i);
    }
    own.pose = own.surface.geometry->points;
  }
}

void SurfaceContact::state(Archive& archive) {
  archive.field("pressed", pressed_);
  archive.field("reactions", reactions_);
  archive.field("turned", turned_);
}

std::span<double> SurfaceContact::pressed(const Meeting& m) {
  return std::span(pressed_).subspan(m.pressed, surfaces_[m.own].at.size());
}

std::span<double> SurfaceContact::reacted(const Meeting& m) {
  return std::span(reactions_).subspan(m.reacted, m.obstacle->width());
}

/// Whom the ports may meet is known when the first window begins.
void SurfaceContact::meet(const Window& window) {
  std::size_t pressed = 0, reacted = 0;
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const Surface& own = surfaces_[s].surface;
    for (std::size_t k = 0; k < window.partners[own.port].size(); ++k) {
      const Partner& met = window.partners[own.port][k];
      if (met.law.tied) {
        throw RunError("is tied: surfaces of bodies of this kind touch, and do not join yet",
                       fmt::format("a partner of body '{}'", body_), "Give contact: {}.");
      }
      Meeting m;
      m.obstacle = std::make_unique<SurfaceObstacle>(own.port, k, *own.geometry, met, body_);
      m.own = s;
      m.pressed = pressed;
      m.reacted = reacted;
      pressed += surfaces_[s].at.size();
      reacted += m.obstacle->width();
      meetings_.push_back(std::move(m));
    }
  }
}

/// States of before the first window hold no forces yet; resumed ones do.
void SurfaceContact::begin_forces() {
  if (meetings_.empty()) return;
  const Meeting& last = meetings_.back();
  const std::size_t pressed = last.pressed + surfaces_[last.own].at.size();
  const std::size_t reacted = last.reacted + last.obstacle->width();
  if (pressed_.size() != pressed) pressed_.assign(pressed, 0.0);
  if (reactions_.size() != reacted) reactions_.assign(reacted, 0.0);
  if (turned_.size() != meetings_.size()) turned_.assign(meetings_.size(), 0.0);
}

void SurfaceContact::impose(const Window& window) {
  if (meetings_.empty()) meet(window);
  begin_forces();
  for (Meeting& m : meetings_) {
    const std::size_t port = m.obstacle->port();
    m.obstacle->impose(window.request.boundary[port], window.partners[port][m.obstacle->partner()],
                       window.grid, surfaces_[m.own].pose, reacted(m));
    if (m.obstacle->acts()) continue;
    std::ranges::fill(pressed(m), 0.0);
    std::ranges::fill(reacted(m), 0.0);
  }
}

bool SurfaceContact::acts() const {
  return std::ranges::any_of(meetings_, [](const Meeting& m) { return m.obstacle->acts(); });
}

bool SurfaceContact::acts(std::size_t port) const {
  return std::ranges::any_of(meetings_, [port](const Meeting& m) {
    return m.obstacle->port() == port && m.obstacle->acts();
  });
}

bool SurfaceContact::has(std::size_t port) const {
  return std::ranges::any_of(surfaces_, [port](const Own& o) { return o.surface.port == port; });
}

void SurfaceContact::hold(const std::vector<double>&, std::vector<double>& now) const {
  add_to(now);
}

void SurfaceContact::add_to(std::vector<double>& forces) const {
  for (const Meeting& m : meetings_) {
    const Own& own = surfaces_[m.own];
    for (std::size_t v = 0; v < own.at.size(); ++v)
      forces[own.surface.first + v] += pressed_[m.pressed + v];
  }
}

void SurfaceContact::react(std::size_t port, std::size_t partner, const std::vector<double>&,
                           std::vector<double>& out) const {
  for (const Meeting& m : meetings_) {
    if (m.obstacle->port() != port || m.obstacle->partner() != partner) continue;
    for (const std::size_t value : m.obstacle->near().values())
      out.push_back(reactions_[m.reacted + value]);
  }
}

const std::vector<std::int32_t>* SurfaceContact::reacting(std::size_t port,
                                                          std::size_t partner) const {
  for (const Meeting& m : meetings_)
    if (m.obstacle->port() == port && m.obstacle->partner() == partner)
      return &m.obstacle->near().listed();
  return nullptr;
}

bool SurfaceContact::takes(std::size_t port, const PortKernel& kernel) const {
  return has(port) && kernel.support == ForceSupport::nodal;
}

void SurfaceContact::see_gaps(std::size_t port,
                              const std::function<void(std::size_t, double)>& see) const {
  for (const Meeting& m : meetings_) {
    if (m.obstacle->port() != port || !m.obstacle->acts()) continue;
    const SurfaceRows& rows = m.obstacle->rows();
    for (int r = 0; r < rows.count(); ++r) {
      const std::int32_t first = rows.k.offsets[index(r)], last = rows.k.offsets[index(r) + 1];
      const auto begin = rows.k.values.begin();
      const auto most = std::max_element(begin + first, begin + last);
      see(index(rows.k.columns[index(most - begin)]), rows.gaps[index(r)]);
    }
  }
}

void SurfaceContact::aim(int i, const std::vector<double>&, const std::vector<double>& places) {
  looks_ = 0;
  for (Own& own : surfaces_) {
    own.begin = own.surface.geometry->points;
    for (std::size_t v = 0; v < own.begin.size(); ++v)
      own.begin[v] += places[own.surface.first + v];
  }
  for (std::size_t k = 0; k < meetings_.size(); ++k) {
    Meeting& m = meetings_[k];
    if (m.obstacle->acts()) m.obstacle->aim(i, reacted(m), turned_[k] != 0.0);
  }
}

/// Where the surfaces are when the coordinates are q.
void SurfaceContact::pose(const Vector& q) {
  for (Own& own : surfaces_) {
    const PortGeometry& geometry = *own.surface.geometry;
    const std::size_t dim = index(geometry.dim);
    for (std::size_t a = 0; a < own.surface.nodes.size(); ++a) {
      const Matrix3* axes = own.surface.frames[a];
      for (std::size_t i = 0; i < dim; ++i) {
        double u = axes == nullptr ? q(own.at[a * dim + i]) : 0.0;
        for (std::size_t k = 0; axes != nullptr && k < dim; ++k)
          u += (*axes)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) *
               q(own.at[a * dim + k]);
        own.pose[a * dim + i] = geometry.points[a * dim + i] + u;
      }
    }
  }
}

/// One row's terms: n . T over coordinates.
void SurfaceContact::find_terms(const Own& own, const SurfaceRows& rows, int row) {
  const std::size_t dim = index(rows.dim);
  const double* normal = rows.normals.data() + index(row) * dim;
  for (std::int32_t e = rows.k.offsets[index(row)]; e < rows.k.offsets[index(row) + 1]; ++e) {
    const std::size_t point = index(rows.k.columns[index(e)]);
    const Matrix3* axes = own.surface.frames[point];
    for (std::size_t i = 0; i < dim; ++i) {
      double along = axes == nullptr ? normal[i] : 0.0;
      for (std::size_t k = 0; axes != nullptr && k < dim; ++k)
        along += (*axes)(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) * normal[k];
      terms_.push_back({own.at[point * dim + i], rows.k.values[index(e)] * along});
    }
  }
  first_term_.push_back(terms_.size());
}

/// The rows of all meetings, for the present poses.
void SurfaceContact::make_rows() {
  terms_.clear();
  first_term_.assign(1, 0);
  Eigen::Index count = 0;
  for (Meeting& m : meetings_) {
    m.row = count;
    m.rows = 0;
    if (!m.obstacle->acts()) continue;
    m.obstacle->join(surfaces_[m.own].pose, surfaces_[m.own].travel, reacted(m));
    m.rows = m.obstacle->rows().count();
    count += m.rows;
    for (int r = 0; r < m.rows; ++r) find_terms(surfaces_[m.own], m.obstacle->rows(), r);
  }
}

/// Gaps of the free pose, and the compliance among the rows.
bool SurfaceContact::find_problem(const Vector& free, Compliance& give) {
  const Eigen::Index count = static_cast<Eigen::Index>(first_term_.size()) - 1;
  compliance_.setZero(count, count);
  gaps_.resize(count);
  pose(free);
  for (Meeting& m : meetings_) {
    if (m.rows == 0) continue;
    gaps(m.obstacle->rows(), surfaces_[m.own].pose, m.obstacle->free(),
         {gaps_.data() + m.row, index(m.rows)});
    m.obstacle->add_compliance(m.row, compliance_);
  }
  for (Eigen::Index r = 0; r < count; ++r) {
    for (std::size_t t = first_term_[index(r)]; t < first_term_[index(r) + 1]; ++t) {
      const Vector* column = give.column(terms_[t].coordinate);
      if (column == nullptr) return false;
      for (Eigen::Index s = 0; s < count; ++s) {
        double sum = 0.0;
        for (std::size_t k = first_term_[index(s)]; k < first_term_[index(s) + 1]; ++k)
          sum += terms_[k].factor * (*column)(terms_[k].coordinate);
        compliance_(s, r) += terms_[t].factor * sum;
      }
    }
  }
  return true;
}

/// From the rows' forces to those of coordinates, ports and partners.
void SurfaceContact::spread() {
  force_.setZero();
  for (std::size_t r = 0; r + 1 < first_term_.size(); ++r) {
    const double force = row_force_(static_cast<Eigen::Index>(r));
    for (std::size_t t = first_term_[r]; t < first_term_[r + 1]; ++t)
      force_(terms_[t].coordinate) += terms_[t].factor * force;
  }
  for (Meeting& m : meetings_) {
    if (!m.obstacle->acts()) continue;
    const std::span<double> on_partner = reacted(m);
    const NearSurface& near = m.obstacle->near();
    std::ranges::fill(pressed(m), 0.0);
    for (const std::size_t value : near.values()) on_partner[value] = 0.0;
    const SurfaceRows& rows = m.obstacle->rows();
    const std::size_t dim = index(surfaces_[m.own].surface.geometry->dim);
    for (int r = 0; r < m.rows; ++r) {
      const double force = row_force_(m.row + r);
      const auto add = [&](const SparseRows& of, double factor, const auto& to) {
        for (std::int32_t e = of.offsets[index(r)]; e < of.offsets[index(r) + 1]; ++e)
          for (std::size_t d = 0; d < dim; ++d)
            to(of.columns[index(e)])[d] +=
                factor * force * of.values[index(e)] * rows.normals[index(r) * dim + d];
      };
      add(rows.k, 1.0, [&](std::int32_t point) { return &pressed(m)[index(point) * dim]; });
      add(rows.n, -1.0,
          [&](std::int32_t point) { return &on_partner[index(near.in_whole(point)) * dim]; });
    }
  }
}

/// The surfaces to where the forces lead them from their free places.
bool SurfaceContact::move(const Vector& free, Compliance& give) {
  moved_ = free;
  for (int k = 0; k < static_cast<int>(force_.size()); ++k) {
    if (force_(k) == 0.0) continue;
    const Vector* column = give.column(k);
    if (column == nullptr) return false;
    moved_.noalias() += force_(k) * *column;
  }
  pose(moved_);
  return true;
}

const Vector* SurfaceContact::solve(double time, const Vector& free, Compliance& give) {
  if (looks_ == 0 || time != time_) {
    time_ = time;
    looks_ = 0;
    row_force_.resize(0);  // guesses are of the state and of nothing before
    for (Meeting& m : meetings_)
      if (m.obstacle->acts()) m.obstacle->place(time);
    pose(free);
    for (Own& own : surfaces_) {
      own.travel = 0.0;
      for (std::size_t v = 0; v < own.pose.size(); ++v)
        own.travel = std::max(own.travel, std::abs(own.pose[v] - own.begin[v]));
    }
    force_.setZero(free.size());  // those of the substep before are the first guess
    for (const Meeting& m : meetings_) {
      const Own& own = surfaces_[m.own];
      for (std::size_t v = 0; v < own.at.size(); ++v) force_(own.at[v]) += pressed_[m.pressed + v];
    }
  }
  for (int look = 0; look < looks_of_a_call; ++look) {
    if (looks_ < most_looks) {
      if (!move(free, give)) return nullptr;
      make_rows();
      ++looks_;
    }
    last_ = force_;
    if (!find_problem(free, give)) return nullptr;
    if (!unilateral_forces(compliance_, gaps_, row_force_, buffers_)) return nullptr;
    spread();
    const double change = (force_ - last_).lpNorm<Eigen::Infinity>();
    if (change <= settled * force_.lpNorm<Eigen::Infinity>() || looks_ >= most_looks) break;
  }
  for (std::size_t k = 0; k < meetings_.size(); ++k)
    turned_[k] = meetings_[k].obstacle->turned() ? 1.0 : 0.0;
  return &force_;
}

}  // namespace abut
