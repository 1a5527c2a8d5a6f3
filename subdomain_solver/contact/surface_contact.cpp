#include "subdomain_solver/contact/surface_contact.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"
#include "contract/kernel_misfit.hpp"
#include "surface/tangents.hpp"

namespace abut {

namespace {

/// Of a facet: surfaces that overlap by less are drawn as touching.
constexpr double drawn_together = 1.0e-6;

}  // namespace

SurfaceContact::SurfaceContact(std::vector<Surface> surfaces, const std::string& body,
                               std::optional<Interference> interference)
    : body_(body), interference_(std::move(interference)) {
  for (Surface& surface : surfaces) {
    const int dim = surface.geometry->dim;
    for (const std::int32_t node : surface.nodes)
      for (int i = 0; i < dim; ++i) dofs_.push_back(node * dim + i);
    surfaces_.push_back({std::move(surface), {}, {}, {}, 0.0, 0.0, 0, {}});
  }
  keep_one_each(dofs_);
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
  archive.field("slid", slid_);
  archive.field("shears", shears_);
  archive.field("anchors", anchors_);
  archive.field("anchored", anchored_);
  archive.field("dissipated", dissipated_);
  if (interference_) interference_->state(archive);
  if (archive.writing()) kept_gaps_ = seen_gaps();
  kept_gaps_.state(archive);
  restored_ = restored_ || !archive.writing();
}

void SurfaceContact::let_go() {
  for (std::vector<double>* list : {&pressed_, &reactions_, &turned_, &slid_, &shears_, &anchored_})
    std::ranges::fill(*list, 0.0);
  kept_gaps_ = {};
  restored_ = true;  // what is seen is nothing, until rows are made again
  if (interference_) interference_->end();
}

std::span<double> SurfaceContact::pressed(const Meeting& m) {
  return std::span(pressed_).subspan(m.pressed, surfaces_[m.own].at.size());
}

std::span<double> SurfaceContact::reacted(const Meeting& m) {
  return std::span(reactions_).subspan(m.reacted, m.obstacle->width());
}

std::span<double> SurfaceContact::anchor(const Meeting& m) {
  return std::span(anchors_).subspan(m.anchor, m.law.friction.rubs() ? m.obstacle->width() : 0);
}

/// Partners that the ports have not met yet: any window may bring some.
void SurfaceContact::meet(const Window& window) {
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const Surface& own = surfaces_[s].surface;
    for (std::size_t& k = surfaces_[s].met; k < window.partners[own.port].size(); ++k) {
      const Partner& met = window.partners[own.port][k];
      if (met.law.tied) {
        throw RunError("is tied: surfaces of bodies of this kind touch, and do not join yet",
                       fmt::format("a partner of body '{}'", body_), "Give contact: {}.");
      }
      Meeting m;
      m.obstacle = std::make_unique<SurfaceObstacle>(own.port, k, *own.geometry, met, body_);
      m.own = s;
      m.law = met.law;
      m.pressed = sizes_.pressed;
      m.reacted = sizes_.reacted;
      m.slid = sizes_.slid;
      m.anchor = sizes_.anchor;
      if (met.law.friction.rubs()) {
        m.parts = own.geometry->dim;
        sizes_.slid += own.nodes.size();
        sizes_.shears += surfaces_[s].at.size();
        sizes_.anchor += m.obstacle->width();
      }
      sizes_.pressed += surfaces_[s].at.size();
      sizes_.reacted += m.obstacle->width();
      if (interference_) interference_->meet(*own.geometry, met.surface, met.law.points);
      meetings_.push_back(std::move(m));
    }
  }
}

/// States of before a partner was met hold no forces of it yet.
void SurfaceContact::begin_forces() {
  pressed_.resize(sizes_.pressed, 0.0);
  reactions_.resize(sizes_.reacted, 0.0);
  turned_.resize(meetings_.size(), 0.0);
  slid_.resize(sizes_.slid, 0.0);
  shears_.resize(sizes_.shears, 0.0);
  anchors_.resize(sizes_.anchor, 0.0);
  anchored_.resize(meetings_.size(), 0.0);
  dissipated_.resize(meetings_.size(), 0.0);
}

void SurfaceContact::impose(const Window& window) {
  restored_ = false;
  meet(window);
  begin_forces();
  if (interference_) interference_->begin(window.grid.begin);
  for (std::size_t k = 0; k < meetings_.size(); ++k) {
    Meeting& m = meetings_[k];
    const std::size_t port = m.obstacle->port();
    begin_slid(m, window.request.boundary[port], window.grid);
    m.obstacle->impose(window.request.boundary[port], window.partners[port][m.obstacle->partner()],
                       window.grid, surfaces_[m.own].pose, reacted(m));
    if (m.obstacle->acts()) continue;
    anchored_[k] = 0.0;
    if (m.law.friction.rubs()) forget_shears(m);
    std::ranges::fill(pressed(m), 0.0);
    std::ranges::fill(reacted(m), 0.0);
  }
  begin_neighbours(window);
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
  for (const Meeting& m : meetings_) {
    const Own& own = surfaces_[m.own];
    for (std::size_t v = 0; v < own.at.size(); ++v)
      now[own.surface.first + v] += pressed_[m.pressed + v];
  }
}

void SurfaceContact::settle(std::vector<double>& forces) {
  hold(forces, forces);
  for (Own& own : surfaces_)
    if (own.neighbours.act()) own.neighbours.settle(pressing(own));
  for (std::size_t k = 0; k < meetings_.size(); ++k)
    if (meetings_[k].law.friction.rubs() && meetings_[k].obstacle->acts()) settle_friction(k);
  for (std::size_t k = 0; interference_ && k < meetings_.size(); ++k) settle_interference(k);
}

/// What is left of an overlap shrinks, and with it the gaps of rows that press. By how much they
/// do, the rows' own weights say: those of the step before have gone a little another way where
/// round surfaces are facets, 1/cos^2 of half the angle between these. A row's force counts by
/// that.
void SurfaceContact::settle_interference(std::size_t meeting) {
  const Meeting& m = meetings_[meeting];
  double force = 0.0;
  if (m.obstacle->acts() && m.rows > 0) {
    std::vector<double> places, row_gaps(index(m.rows));
    m.obstacle->find_begin(places);
    gaps(m.obstacle->rows(), surfaces_[m.own].begin, places, row_gaps);
    const double before = left_of(m, m.obstacle->begin()), shrunk = before - left_of(m, time_);
    for (int r = 0; r < m.rows; ++r) {
      const double missed =
          row_gaps[index(r)] + before;  // none where it pressed with these weights
      const double share = missed < 0.0 && -missed < shrunk ? 1.0 - missed / shrunk : 1.0;
      force += share * row_force_(m.first + static_cast<Eigen::Index>(r) * m.parts);
    }
  }
  interference_->settle(meeting, time_, force);
}

double SurfaceContact::taken_at_once() const {
  double work = 0.0;
  std::vector<double> places, row_gaps;
  for (const Meeting& m : meetings_) {
    if (!m.obstacle->acts() || m.rows == 0) continue;
    m.obstacle->find_begin(places);
    row_gaps.resize(index(m.rows));
    gaps(m.obstacle->rows(), surfaces_[m.own].begin, places, row_gaps);
    const double left = left_of(m, m.obstacle->begin());
    double taken = 0.0, deepest = 0.0;
    for (int r = 0; r < m.rows; ++r) {
      const double overlap = -(row_gaps[index(r)] + left);
      deepest = std::max(deepest, overlap);
      taken += 0.5 * overlap * row_force_(m.first + static_cast<Eigen::Index>(r) * m.parts);
    }
    if (deepest > drawn_together * surfaces_[m.own].surface.geometry->spacing) work += taken;
  }
  return work;
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

std::string SurfaceContact::misfit(std::size_t port, const PortKernel& kernel) const {
  if (!has(port)) return "this port takes no obstacles";
  return misfit_of(kernel, 0.0, ForceSupport::nodal, 0);
}

void SurfaceContact::aim(int i, const std::vector<double>&, const std::vector<double>& places) {
  looks_ = 0;
  substep_ = i;
  missing_.clear();
  for (Own& own : surfaces_) {
    own.begin = own.surface.geometry->points;
    for (std::size_t v = 0; v < own.begin.size(); ++v)
      own.begin[v] += places[own.surface.first + v];
    own.neighbours.aim(i);
  }
  for (std::size_t k = 0; k < meetings_.size(); ++k) {
    Meeting& m = meetings_[k];
    if (!m.obstacle->acts()) continue;
    m.obstacle->aim(i, reacted(m), turned_[k] != 0.0);
    if (m.law.friction.rubs())
      m.obstacle->begin_slip(i, anchored_[k] != 0.0 ? anchor(m) : std::span<double>());
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

/// One component's terms: direction . T over coordinates.
void SurfaceContact::find_terms(const Own& own, const SurfaceRows& rows, int row,
                                const double* direction) {
  const std::size_t dim = index(rows.dim);
  for (std::int32_t e = rows.k.offsets[row]; e < rows.k.offsets[index(row) + 1]; ++e) {
    const std::size_t point = index(rows.k.columns[e]);
    const Matrix3* axes = own.surface.frames[point];
    for (std::size_t i = 0; i < dim; ++i) {
      double along = axes == nullptr ? direction[i] : 0.0;
      for (std::size_t k = 0; axes != nullptr && k < dim; ++k)
        along += (*axes)(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) * direction[k];
      terms_.push_back({own.at[point * dim + i], rows.k.values[e] * along});
    }
  }
  first_term_.push_back(terms_.size());
}

/// The normals of a meeting's rows and, where it rubs, their tangents; and with what they rub.
void SurfaceContact::add_components(Meeting& m) {
  const SurfaceRows& rows = m.obstacle->rows();
  const std::size_t dim = index(rows.dim);
  m.rows = rows.count();
  for (int r = 0; r < m.rows; ++r) {
    const std::size_t at = directions_.size();
    const double* normal = rows.normals.data() + index(r) * dim;
    directions_.insert(directions_.end(), normal, normal + dim);
    if (m.parts > 1) {
      directions_.resize(at + index(m.parts) * dim);
      tangents(rows.dim, normal, std::span(directions_).subspan(at + dim));
    }
    const FrictionLaw& law = m.law.friction;
    rows_.push_back({static_cast<Eigen::Index>(at / dim), m.parts,
                     law.rubs() ? law.coefficient(slid_[m.slid + index(rows.nodes[r])]) : 0.0});
    for (int p = 0; p < m.parts; ++p)
      find_terms(surfaces_[m.own], rows, r, directions_.data() + at + index(p) * dim);
  }
}

/// The rows of all meetings, for the present poses.
void SurfaceContact::make_rows() {
  terms_.clear();
  first_term_.assign(1, 0);
  directions_.clear();
  rows_.clear();
  complies_ = false;
  rubs_ = false;
  for (Meeting& m : meetings_) {
    m.first = static_cast<Eigen::Index>(first_term_.size()) - 1;
    m.first_row = static_cast<int>(rows_.size());
    m.rows = 0;
    if (!m.obstacle->acts()) continue;
    const Own& own = surfaces_[m.own];
    m.obstacle->join(own.pose, own.begin, own.travel, reacted(m));
    add_components(m);
    rubs_ = rubs_ || (m.parts > 1 && m.rows > 0);
  }
}

std::span<const double> SurfaceContact::directions(const Meeting& m) const {
  const std::size_t dim = index(surfaces_[m.own].surface.geometry->dim);
  return std::span(directions_).subspan(index(m.first) * dim, index(m.rows) * index(m.parts) * dim);
}

/// Gaps of the free pose, and slips to it. False: nothing would press.
bool SurfaceContact::find_gaps(const Vector& free) {
  gaps_.resize(static_cast<Eigen::Index>(first_term_.size()) - 1);
  bool press = false;
  pose(free);
  for (Meeting& m : meetings_) {
    if (m.rows == 0) continue;
    row_gaps_.resize(index(m.rows));
    gaps(m.obstacle->rows(), surfaces_[m.own].pose, m.obstacle->free(), row_gaps_);
    const double left = left_of(m, time_);
    for (int r = 0; r < m.rows; ++r) {
      gaps_(m.first + r * m.parts) = row_gaps_[r] + left;
      press = press || !(row_gaps_[r] + left >= 0.0);
    }
    if (m.parts > 1) find_slips(m);
  }
  return press;
}

/// Which coordinates the components have terms of, each numbered once.
void SurfaceContact::number_touched() {
  number_.assign(dofs_.size(), -1);
  touched_.clear();
  for (const Term& term : terms_) {
    if (number_[index(term.coordinate)] >= 0) continue;
    number_[index(term.coordinate)] = static_cast<int>(touched_.size());
    touched_.push_back(term.coordinate);
  }
}

/// Compliance among the components: each one's column over the coordinates that are touched comes
/// first, as a pair of components would meet as many pairs of terms otherwise.
bool SurfaceContact::find_compliance(Compliance& give) {
  if (complies_ && version_ == give.version()) return true;
  const Eigen::Index count = gaps_.size();
  compliance_.setZero(count, count);
  for (const Meeting& m : meetings_)
    if (m.rows > 0) m.obstacle->add_compliance(m.first, directions(m), compliance_);
  number_touched();
  for (Eigen::Index r = 0; r < count; ++r) {
    along_.setZero(static_cast<Eigen::Index>(touched_.size()));
    for (std::size_t t = first_term_[r]; t < first_term_[index(r) + 1]; ++t) {
      const Vector* column = give.column(terms_[t].coordinate);
      if (column == nullptr) return false;
      for (std::size_t i = 0; i < touched_.size(); ++i)
        along_(static_cast<Eigen::Index>(i)) += terms_[t].factor * (*column)(touched_[i]);
    }
    for (Eigen::Index s = 0; s < count; ++s)
      for (std::size_t t = first_term_[s]; t < first_term_[index(s) + 1]; ++t)
        compliance_(s, r) += terms_[t].factor * along_(number_[index(terms_[t].coordinate)]);
  }
  soften_unmoved(rows_, compliance_);
  if (rubs_) soften_held(rows_, compliance_);
  complies_ = true;
  version_ = give.version();
  return true;
}

/// From the components' forces to those of coordinates, ports and partners.
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
    const std::span<const double> along = directions(m);
    for (std::size_t c = 0; c * dim < along.size(); ++c) {
      const double force = row_force_(m.first + static_cast<Eigen::Index>(c));
      const std::size_t r = c / index(m.parts);
      const auto add = [&](const SparseRows& of, double factor, const auto& to) {
        for (std::int32_t e = of.offsets[r]; e < of.offsets[r + 1]; ++e)
          for (std::size_t d = 0; d < dim; ++d)
            to(of.columns[e])[d] += factor * force * of.values[e] * along[c * dim + d];
      };
      add(rows.k, 1.0, [&](std::int32_t point) { return &pressed(m)[index(point) * dim]; });
      add(rows.n, -1.0,
          [&](std::int32_t point) { return &on_partner[index(near.in_whole(point)) * dim]; });
    }
  }
}

}  // namespace abut
