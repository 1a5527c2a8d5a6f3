// Contact of many rows: near rows are solved for one after the other, and what their forces open
// is found by the whole compliance, in turns  [M.153].

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/index.hpp"
#include "contract/kernel.hpp"
#include "subdomain_solver/contact/surface_contact.hpp"

namespace abut {

namespace {

/// Rows: the matrix of more of them on each other costs more than they do one after the other; and
/// those that a matrix can hold where that finds no answer.
constexpr std::size_t few = 60, most_of_one_matrix = 500;
/// Of the largest force: a pass that changes forces by less is rounding.
constexpr double settled_pass = 1.0e-13;
/// Of what the first pass of a round changes: the next round is as good.
constexpr double next_round = 0.03;
/// Components of unit vectors.
constexpr double same_direction = 1.0e-3;
/// Of what the first round of a look changes: rows of the next look are not settled either.
constexpr double next_look = 1.0e-3;
constexpr int most_passes = 20, most_rounds = 100;

}  // namespace

/// All ports' points and facets, each point once, by the numbers of contact's coordinates.
void SurfaceContact::number_points() {
  std::vector<std::int32_t> facets, offsets(1, 0);
  int dim = 3;
  for (const Own& own : surfaces_) {
    const PortGeometry& geometry = *own.surface.geometry;
    dim = geometry.dim;
    for (std::size_t f = 0; f + 1 < geometry.offsets.size(); ++f) {
      for (std::int32_t k = geometry.offsets[f]; k < geometry.offsets[f + 1]; ++k)
        facets.push_back(own.at[index(geometry.facets[index(k)] * dim)] / dim);
      offsets.push_back(static_cast<std::int32_t>(facets.size()));
    }
  }
  near_give_.set_points(static_cast<int>(dofs_.size()) / dim, dim, facets, offsets);
}

/// Whether forces are found row by row: of many rows, on bodies that give way near forces alone.
bool SurfaceContact::many(Compliance& give) {
  if (rows_.size() <= few) return false;
  if (!near_give_.has_points()) number_points();
  return near_give_.find(give);
}

/// Few rows, and those that are not found one after the other though a matrix would hold them.
bool SurfaceContact::find_in_one_matrix(Compliance& give) {
  if (rows_.size() > most_of_one_matrix && many(give)) return false;
  missing_.clear();
  if (!row_force_.allFinite()) row_force_.resize(0);
  if (!find_compliance(give)) return false;
  if (find_forces()) return true;
  tell_missing();
  return false;
}

/// What the rows press on: this body, and the partners that give way.
void SurfaceContact::find_sides() {
  const int dim = surfaces_.front().surface.geometry->dim;
  sides_.clear();
  PressedSide& own = sides_.emplace_back();
  own.near = &near_give_.kernel();
  own.moved = near_give_.kernel().displacement;
  own.dim = dim;
  own.points = dofs_.size() / index(dim);
  own.begins = first_term_;
  for (const Term& term : terms_) own.terms.push_back({term.coordinate, term.factor});
  for (const Meeting& m : meetings_) {
    if (m.rows == 0 || !m.obstacle->yields()) continue;
    PressedSide& side = sides_.emplace_back();
    side.near = &m.obstacle->kernel();
    side.moved = m.obstacle->give();
    side.dim = dim;
    side.points = index(m.obstacle->kernel().width) / index(dim);
    side.first = m.first;
    side.begins.assign(1, 0);
    const std::span<const double> along = directions(m);
    for (std::size_t c = 0; c * index(dim) < along.size(); ++c) {
      m.obstacle->find_terms(along, c, [&side](std::size_t value, double factor) {
        side.terms.push_back({static_cast<std::int32_t>(value), factor});
      });
      side.begins.push_back(side.terms.size());
    }
  }
}

/// Gaps and slips under the rows' forces, by all that gives way.
bool SurfaceContact::find_opened(Compliance& give) {
  opened_ = gaps_;
  std::vector<double> on, by;
  for (const PressedSide& side : sides_) {
    on.resize(side.points * index(side.dim));
    side.press(row_force_, on);
    if (&side == &sides_.front()) {
      pressing_ = Eigen::Map<const Vector>(on.data(), static_cast<Eigen::Index>(on.size()));
      if (!give.apply(pressing_, moved_by_)) return false;
      side.open({moved_by_.data(), on.size()}, opened_);
    } else {
      by.assign(on.size(), 0.0);
      add_moved(*side.near, side.moved, 1.0, on, by);
      side.open(by, opened_);
    }
  }
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (int p = 1; p < rows_[r].parts; ++p)
      opened_(rows_[r].first + p) += near_rows_.soft[r] * row_force_(rows_[r].first + p);
  return true;
}

/// Whether near rows are those of the look before at the same time: of the same points, and where
/// they do not rub along the same normal. Then what is new is left to the rounds.
bool SurfaceContact::turn_near_rows() {
  std::vector<std::int32_t> points;
  for (const Meeting& m : meetings_) {
    points.push_back(m.rows);
    if (m.rows > 0)
      points.insert(points.end(), m.obstacle->rows().nodes.begin(), m.obstacle->rows().nodes.end());
  }
  bool same = points == rows_of_near_ && directions_.size() == directions_of_near_.size() &&
              row_force_.size() == gaps_.size();
  const int dim = surfaces_.front().surface.geometry->dim;
  for (std::size_t r = 0; same && r < rows_.size(); ++r)
    for (int d = 0; d < dim; ++d) {
      const std::size_t at = index(rows_[r].first) * index(dim) + index(d);
      same = same && std::abs(directions_[at] - directions_of_near_[at]) <= same_direction;
    }
  if (same && rubs_) turn(near_rows_, rows_, dim, directions_of_near_, directions_, row_force_);
  rows_of_near_ = std::move(points);
  directions_of_near_ = directions_;
  return same;
}

/// True: forces were found, those that fit or, where rows are looked at again, nearly these.
bool SurfaceContact::find_many(Compliance& give, bool again) {
  find_sides();
  if (!turn_near_rows()) {
    near_rows_ = near_rows(rows_, sides_);
    guess_forces();
  }
  double change_of_look = 0.0;
  std::array<double, most_rounds> changes;
  for (int round = 0; round < most_rounds; ++round) {
    if (!find_opened(give)) return false;
    double first = 0.0;
    for (int pass = 0; pass < most_passes; ++pass) {
      const double change = relax(near_rows_, rows_, opened_, row_force_);
      if (!row_force_.allFinite()) return false;
      if (pass == 0) first = change;
      if (change <= next_round * first) break;
    }
    if (round == 0) change_of_look = first;
    if (again && first <= next_look * change_of_look) return true;
    if (first <= settled_pass * row_force_.lpNorm<Eigen::Infinity>()) return true;
    changes[index(round)] = first;
    if (rows_.size() <= most_of_one_matrix && too_slow(std::span(changes).first(index(round) + 1)))
      return false;
  }
  missing_ = fmt::format(
      "no contact forces were found that fit all of {} rows in {} rounds; take a smaller step",
      rows_.size(), most_rounds);
  return false;
}

}  // namespace abut
