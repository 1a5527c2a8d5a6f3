// Rows are those of the end's geometry, which forces decide: looks at it and forces in turns.

#include <algorithm>
#include <cmath>
#include <limits>

#include "subdomain_solver/contact/surface_contact.hpp"

namespace abut {

namespace {

/// Looks at the geometry of the end of a substep: in a call, where the body is linear and there is
/// one, and in all. Rows that went on changing would keep the body from its balance.
constexpr int looks_of_a_call = 3, most_looks = 6;

/// Of the largest force: rows that change forces by less are settled.
constexpr double settled = 1.0e-12;
}  // namespace

/// A step begins: where the surfaces are without the forces that are looked for, and the forces of
/// the substep before as the first guess.
void SurfaceContact::begin_looks(double time, const Vector& free) {
  time_ = time;
  looks_ = 0;
  row_force_.resize(0);  // guesses are of the state and of nothing before
  rows_of_near_.clear();
  for (Meeting& m : meetings_)
    if (m.obstacle->acts()) m.obstacle->place(time);
  pose(free);
  double place = 0.0;
  for (Own& own : surfaces_) {
    own.travel = own.farthest = travelled(own);
    for (const double at : own.pose) place = std::max(place, std::abs(at));
  }
  rounding_ = 4.0 * std::numeric_limits<double>::epsilon() * place;
  force_.setZero(free.size());
  for (const Meeting& m : meetings_) {
    const Own& own = surfaces_[m.own];
    for (std::size_t v = 0; v < own.at.size(); ++v) force_(own.at[v]) += pressed_[m.pressed + v];
  }
}

/// [m] from where the substep began to the present pose, at most.
double SurfaceContact::travelled(const Own& own) {
  double most = 0.0;
  for (std::size_t v = 0; v < own.pose.size(); ++v)
    most = std::max(most, std::abs(own.pose[v] - own.begin[v]));
  return most;
}

/// The surfaces to where the forces lead them from their free places.
bool SurfaceContact::move(const Vector& free, Compliance& give) {
  moved_ = free;
  if (!add_given_way(give, 1.0, force_, moved_by_, moved_)) return false;
  pose(moved_);
  return true;
}

/// The first rows of a body that contact alone holds are those of where it is: without them it
/// would be anywhere, behind its partners or beyond. From there farther and farther, until some
/// press.
void SurfaceContact::look_from_begin(const Vector& free) {
  for (Own& own : surfaces_) own.travel = 0.0;
  for (bool farther = true; farther;) {
    for (Own& own : surfaces_) own.pose = own.begin;
    make_rows();
    if (find_gaps(free)) return;
    farther = false;
    for (Own& own : surfaces_) {
      if (own.travel >= own.farthest) continue;
      own.travel = std::clamp(2.0 * own.travel, own.surface.geometry->spacing, own.farthest);
      farther = true;
    }
  }
}

bool SurfaceContact::look(const Vector& free, Compliance& give) {
  const bool loose =
      std::ranges::any_of(surfaces_, [](const Own& own) { return own.surface.loose; });
  if (loose && looks_ == 0) {
    look_from_begin(free);
  } else {
    if (!move(free, give)) return false;
    for (Own& own : surfaces_)
      if (loose) own.travel = travelled(own);
    make_rows();
  }
  ++looks_;
  return true;
}

const Vector* SurfaceContact::solve_rows(double time, const Vector& free, Compliance& give) {
  missing_.clear();
  if (looks_ == 0 || time != time_) begin_looks(time, free);
  for (int turn = 0; turn < looks_of_a_call; ++turn) {
    if (looks_ < most_looks && !look(free, give)) return nullptr;
    const bool again = turn + 1 < looks_of_a_call && looks_ < most_looks;
    last_ = force_;
    many_ = false;
    if (!find_gaps(free)) {
      row_force_.setZero(gaps_.size());
    } else if (many(give) && find_many(give, again)) {
      many_ = true;
    } else if (!find_in_one_matrix(give)) {
      return nullptr;
    }
    spread();
    const double change = (force_ - last_).lpNorm<Eigen::Infinity>();
    if (change <= settled * force_.lpNorm<Eigen::Infinity>() || looks_ >= most_looks) break;
  }
  for (std::size_t k = 0; k < meetings_.size(); ++k)
    turned_[k] = meetings_[k].obstacle->turned() ? 1.0 : 0.0;
  return &force_;
}

}  // namespace abut
